;; Drawing from scenes and the command line; and that nothing of it is loaded where nothing is drawn.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp primitives) (timewarp recorders) (ice-9 ftw))

(test-begin "drawing")

(write-file "ball.scm"
            "(use-modules (timewarp))"
            "(scene #:title \"Ball\" #:duration 0.5)"
            "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
            "(define ball (add-body! #:name \"ball\" #:shape (sphere 0.1) #:position #(0 0 0.5)))"
            "(camera #:eye #(2 -3 1) #:target #(0 0 0.4) #:follow ball)"
            "(light #:direction #(1 1 -2) #:color #(1 1 0.9))"
            "(sky #:zenith #(0.2 0.4 0.8) #:fog 0.01)")

;; what the program has mapped after a run with these options
(define (libraries-after . options)
  (run-output
   (shell (string-append
           "echo '(begin (use-modules (ice-9 textual-ports)) (display (call-with-input-file \"/proc/self/maps\" get-string-all)))' | "
           timewarp " -q -i ball.scm --quiet " (string-join options " ")))))

(test-assert "a run without drawing maps neither OSMesa nor LLVM"
  (not (string-match "libOSMesa|libEGL|libLLVM" (libraries-after "--poses=p.csv" "--hash"))))

;; wrong looks are errors, drawn or not
(in-world ()
  (test-message "camera" "eye is 5; expected a vector" (camera #:eye 5))
  (test-message "field of view" "fov is 4; expected an angle" (camera #:fov 4))
  (test-message "whom to follow" "follow is \"ball\"; expected a body" (camera #:follow "ball"))
  (test-message "turning" "turn is \"left\"; expected a rate" (camera #:turn "left"))
  (test-message "light" "direction is .*; expected a vector" (light #:direction #(0 1)))
  (test-message "light from nowhere" "direction is .*; expected a vector that is not zero"
    (light #:direction #(0 0 0)))
  (test-message "a camera that has no up" "up is .*; expected a vector that is not zero"
    (camera #:up '(0 0 0)))
  (test-message "grain" "grain is 2; expected a number from 0 to 1" (sky #:grain 2))
  (test-message "sky" "unknown keyword #:colour; expected one of #:zenith" (sky #:colour #(1 1 1))))

(define (png? name)
  (and (file-exists? (in-folder name))
       (string-prefix? "\x89PNG" (call-with-input-file (in-folder name)
                                   (lambda (port) (list->string (map (lambda (_) (read-char port)) (iota 8))))
                                   #:encoding "ISO-8859-1"))))

;; the last chunk of a PNG file
(define (whole-png? name)
  (and (png? name) (string-suffix? "IEND\xae\x42\x60\x82" (bytes name))))

(define (list-files name)
  (scandir (in-folder name) (lambda (file) (not (string-prefix? "." file)))))

(define (hash-of . options)
  (last (lines-of (run-output (apply run "ball.scm" "--quiet" "--hash" options)))))

(define (box-frames folder . options)
  (apply run "box.scm" "--quiet" "--hash" "--until=0.5" "--fps=2" "--size=320x180" "--quality=draft"
         (string-append "--frames=" folder) options))

(define (bytes name)
  (call-with-input-file (in-folder name) get-string-all #:encoding "ISO-8859-1"))

(define (shot-of file . options)
  (apply run "ball.scm" "--fps=4" "--size=160x90" "--quality=draft" "--quiet" "--hash"
         (string-append "--frames=" file) options))

;; how many frames a movie holds, as text
(define (frames-of movie)
  (string-trim-both
   (run-output (shell (string-append "ffprobe -v error -count_frames -of csv=p=0 -show_entries "
                                     "stream=nb_read_frames " movie)))))

(cond
 ((%drawing?)
  ;; a film whose pictures ffmpeg takes slowly, and whose end takes it long
  (mkdir (in-folder "programs"))
  (write-file "programs/ffmpeg" "#!/bin/sh" "for file; do :; done"
              "sleep 4; cat >/dev/null; sleep 4; echo film >\"${file#file:}\"")
  (chmod (in-folder "programs/ffmpeg") #o755)
  (let ((result (shell (format #f "env PATH=~a:$PATH ~a ball.scm --movie=slow.mp4 --fps=40 --size=640x360 --quality=draft"
                               (in-folder "programs") timewarp))))
    (test-equal "a film: status 0" 0 (run-status result))
    (test-assert (format #f "progress says that drawing is slow, not the ball: ~a" (run-errors result))
      (string-match "s simulated, [0-9] of 21 frames written, 0 rollbacks; slow: drawing\n"
                    (run-errors result)))
    (test-assert "and that the film is being closed"
      (string-match "simulated, all 21 frames written, closing the files, 0 rollbacks\n"
                    (run-errors result)))
    (test-assert "the ball is not blamed" (not (string-match "took" (run-errors result)))))
  (let ((frames-between (@@ (timewarp drawing) frames-between)))
    (test-equal "frames up to and including a time" '(1 30 31 31)
      (map (lambda (end) (frames-between 0 end 30)) '(0 0.99 1 1.01)))
    (test-equal "from a time on" '(0 1 15)
      (map (lambda (start) (frames-between start 1 30)) '(1.01 1 0.52)))
    (test-equal "as C++ has them" (iota 300)
      (map (lambda (k) (1- (frames-between 0 (/ (exact->inexact k) 30) 30))) (iota 300))))
  (let ((result (run "ball.scm" "--frames=out" "--fps=4" "--size=160x90" "--quality=draft" "--stats=s.json")))
    (test-equal "--frames: status 0" 0 (run-status result))
    (test-equal "frames at k/fps up to the end" '(#t #t #t #f)
      (map (lambda (k) (png? (format #f "out/0000~a.png" k))) (iota 4)))
    (test-assert "drawing is counted apart"
      (string-match "\"draw_cpu_seconds\": (0.0[0-9]*[1-9]|0.[1-9])" (read-file "s.json"))))
  ;; a body comes and one goes between the frames of a part
  (write-file "parts.scm"
              "(use-modules (timewarp))"
              "(scene #:duration 1.5)"
              "(camera #:eye #(2 -3 1) #:target #(0 0 0.4))"
              "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
              "(define first (add-body! #:shape (box 1 1 1) #:position #(0 0 0.5)))"
              "(run! #:until 0.6)"
              "(add-body! #:shape (sphere 0.3) #:position #(0.8 -0.8 1))"
              "(run! #:until 0.8)"
              "(remove-body! first)")
  (let ((draw (lambda args (apply run "parts.scm" "--fps=4" "--size=160x90" "--quality=draft" "--hash"
                                  "--quiet" args))))
    (let ((whole (draw "--frames=whole")) (part (draw "--frames=part" "--part=2/3")))
      (test-equal "--part draws every N-th frame, from the K-th" '("00001.png" "00004.png")
        (list-files "part"))
      (test-equal "as they are in the whole" (map (lambda (k) (bytes (format #f "whole/0000~a.png" k))) '(1 4))
        (map (lambda (k) (bytes (format #f "part/0000~a.png" k))) '(1 4)))
      (test-equal "and doesn't change the history" (run-output whole) (run-output part))
      (draw "--frames=few" "--part=1/100")
      (test-equal "there may be more parts than frames" '("00000.png") (list-files "few"))))
  (run "ball.scm" "--frames=frame-%02d.png" "--fps=2" "--size=64x36" "--quality=draft")
  (test-assert "a pattern names the frames" (png? "frame-01.png"))
  (test-assert "drawing does load a library (so the test above can fail)"
    (string-match "libOSMesa|libEGL"
                  (libraries-after "--frames=out" "--size=64x36" "--quality=draft" "--until=0")))
  (test-equal "drawing doesn't change the history" (hash-of)
    (hash-of "--frames=out" "--fps=24" "--size=64x36" "--quality=draft"))
  (write-file "shots.scm"
              "(load \"ball.scm\")"
              "(render! \"shot.png\" #:size \"64x36\" #:quality 'draft)"
              "(simulate! #:until 0.1 #:frames \"own\" #:size '(64 36) #:quality 'draft)")
  (let ((result (run "shots.scm" "--quiet" "--until=0")))
    (test-equal "render! and simulate!: status 0" 0 (run-status result))
    (test-assert "render! draws one picture" (png? "shot.png"))
    (test-equal "simulate! draws frames" '(#t #t #t #t #f)
      (map (lambda (k) (png? (format #f "own/0000~a.png" k))) (iota 5))))
  (write-file "box.scm"
              "(use-modules (timewarp))"
              "(add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
              "(add-body! #:shape (box 1 1 1) #:position #(0 0 0.5))"
              "(camera #:eye #(2 -3 1) #:target #(0 0 0.4))")
  (test-equal "--contacts doesn't change the history"
    (run-output (box-frames "bare"))
    (run-output (box-frames "lines" "--contacts")))
  (test-assert "but the pictures" (not (equal? (bytes "bare/00001.png") (bytes "lines/00001.png"))))
  (write-file "box-shots.scm"
              "(load \"box.scm\")"
              "(define (shot file contacts?) (render! file #:size '(320 180) #:quality 'draft #:contacts? contacts?))"
              "(simulate! #:until 0.5 #:frames \"own-lines\" #:size '(320 180) #:quality 'draft #:contacts? #t)"
              "(shot \"bare.png\" #f) (shot \"lines.png\" #t)")
  (test-equal "#:contacts? is taken by render! and simulate!" 0
    (run-status (run "box-shots.scm" "--quiet" "--until=0" "--fps=2")))
  (test-assert "render! draws contacts if asked to"
    (and (equal? (bytes "bare.png") (bytes "bare/00001.png"))
         (equal? (bytes "lines.png") (bytes "lines/00001.png"))))
  ;; what is drawn in place of the shape
  (write-file "cube.obj" "mtllib cube.mtl" "v -0.5 -0.5 -0.5" "v 0.5 -0.5 -0.5" "v 0.5 0.5 -0.5" "v -0.5 0.5 -0.5"
              "v -0.5 -0.5 0.5" "v 0.5 -0.5 0.5" "v 0.5 0.5 0.5" "v -0.5 0.5 0.5" "usemtl paint"
              "f 4 3 2 1" "f 5 6 7 8" "f 1 2 6 5" "f 2 3 7 6" "f 3 4 8 7" "f 4 1 5 8")
  (write-file "cube.mtl" "newmtl paint" "Kd 1 0.25 0.25")
  (write-file "seen.scm"
              "(use-modules (timewarp) (timewarp worlds))"
              "(define (shot file . arguments)"
              "  (parameterize ((current-world (make-world)))"
              "    (add-body! #:shape (half-space #(0 0 1) 0) #:fixed? #t)"
              "    (apply add-body! #:position #(0 0 0.5) arguments)"
              "    (camera #:eye #(2 -3 1) #:target #(0 0 0.4))"
              "    (render! file #:size '(160 90) #:quality 'draft)))"
              "(define paint #(1 0.25 0.25))"
              "(shot \"shape.png\" #:shape (box 1 1 1) #:color paint)"
              "(shot \"visual.png\" #:shape (sphere 0.2) #:color paint #:visual (box 1 1 1))"
              "(shot \"list.png\" #:shape (sphere 0.2) #:color paint"
              "      #:visual (list (placed (box 1 1 0.5) #:position #(0 0 0.25)) (placed (box 1 1 0.5) #:position #(0 0 -0.25))))"
              "(shot \"mesh.png\" #:shape (sphere 0.2) #:visual (load-visual \"cube.obj\"))"
              "(shot \"scaled.png\" #:shape (sphere 0.2) #:color #(0 0 1)"
              "      #:visual (load-visual \"cube.obj\" #:scale #(-1 1 1) #:up 'y #:color paint))"
              "(shot \"hidden.png\" #:shape (box 1 1 1) #:visual (load-visual \"cube.obj\") #:visible? #f)"
              "(shot \"without.png\" #:shape (box 1 1 1) #:visible? #f)")
  (test-equal "visuals are drawn" "" (run-errors (run "seen.scm" "--quiet" "--until=0")))
  (test-assert "as the shapes that they are, and not the shape"
    (and (equal? (bytes "visual.png") (bytes "shape.png")) (equal? (bytes "list.png") (bytes "shape.png"))))
  (test-equal "a mesh, in the colour of its material" (bytes "shape.png") (bytes "mesh.png"))
  (test-equal "or in that given, mirrored, with its y up" (bytes "shape.png") (bytes "scaled.png"))
  (test-equal "what is not visible is not" (bytes "without.png") (bytes "hidden.png"))
  (test-equal "and so does simulate!" (bytes "lines/00001.png") (bytes "own-lines/00001.png"))
  ;; Ctrl-C: the frame in hand is finished, those that wait are dropped.  Counted, since how long a frame
  ;; takes depends on what else the machine does: one may be finished between the count and the signal
  (let* ((result
          (shell (string-append
                  "{ " timewarp " ball.scm --quiet --until=100 --frames=slow --quality=best"
                  " --size=1920x1080 & p=$!; until [ -e slow/00001.png ]; do sleep 0.1; done;"
                  " ls slow | wc -l; kill -INT $p; wait $p; s=$?; ls slow | wc -l; (exit $s); }")))
         (counts (map string->number (lines-of (run-output result)))))
    (test-equal "Ctrl-C while frames are drawn: status 130" 130 (run-status result))
    (test-assert (format #f "frames before it and in the end: ~a" counts)
      (<= (second counts) (+ 2 (first counts))))
    (test-assert "there are frames, and all are whole"
      (match (list-files "slow")
        (() #f)
        (files (every (lambda (file)
                        (and (string-suffix? ".png" file) (whole-png? (string-append "slow/" file))))
                      files)))))
  ;; ---- one picture, with or without what is written over it ----
  (let ((whole (shot-of "all")) (shot (shot-of "one/shot.png" "--at=0.25" "--until=0.5")))
    (test-equal "--at: status 0" 0 (run-status shot))
    (test-assert "--at draws the frame of that time"
      (equal? (bytes "all/00001.png") (bytes "one/shot.png")))
    (test-equal "and only that" '("shot.png") (list-files "one"))
    (test-equal "and doesn't change the history" (run-output whole) (run-output shot)))
  (shot-of "first.png" "--at=0")
  (test-assert "--at=0 is the first frame" (equal? (bytes "all/00000.png") (bytes "first.png")))
  (shot-of "bare.png" "--at=0.25" "--no-overlay")
  (test-assert "--no-overlay leaves title and time out"
    (and (png? "bare.png") (not (equal? (bytes "bare.png") (bytes "first.png")))
         (< (string-length (bytes "bare.png")) (string-length (bytes "one/shot.png")))))
  (for-each
   (lambda (options message)
     (let ((result (apply run "ball.scm" options)))
       (test-equal (format #f "~a: status 2" options) 2 (run-status result))
       (test-assert (run-errors result) (string-match message (run-errors result)))))
   '(("--at=0.2") ("--at=0.2" "--frames=out") ("--at=3" "--until=2" "--frames=x.png")
     ("--movie=x.mp4" "--part=1/2"))
   '("expected --frames=FILE.png" "--frames is \"out\"; expected" "--at is 3.*, after --until"
     "--part draws some"))
  (in-world ()
    (test-message "a time that no run came to" "no run! reached 0.2 s, of which .*y.png was to be drawn"
      (call-with-recorders (lambda () (run! #:until 0.1)) #:frames (in-folder "y.png") #:at 0.2)))
  ;; ---- cuts: frames after a run have the camera, light and sky that were set since ----
  (write-file "cut.scm" "(load \"ball.scm\")"
              "(run! #:until 0.25)" "(camera #:eye #(0 -9 1) #:target #(0 0 0.4))"
              "(sky #:zenith #(1 0 0))")
  (run "cut.scm" "--fps=4" "--size=160x90" "--quality=draft" "--quiet" "--frames=cut")
  (test-assert "frames before a new camera are as they were"
    (equal? (bytes "all/00001.png") (bytes "cut/00001.png")))
  (test-assert "and those after it are not"
    (not (equal? (bytes "all/00002.png") (bytes "cut/00002.png"))))
  ;; ---- movies ----
  (write-file "avi.scm" "(load \"ball.scm\")" "(simulate! #:until 0.1 #:movie \"x.avi\")")
  (test-assert "a movie's name must end in a format's name"
    (string-match "x.avi' has no ending that is known; expected .mp4" (run-errors (run "avi.scm"))))
  (let ((result (shell (string-append "mkdir -p nothing; PATH=nothing " timewarp
                                      " ball.scm --quiet --poses=unborn.csv -m x.mp4"))))
    (test-equal "without ffmpeg: status 1" 1 (run-status result))
    (test-assert (run-errors result)
      (string-match "needs ffmpeg, which is not in PATH; on Debian: apt-get install ffmpeg"
                    (run-errors result))))
  (when (search-path (parse-path (getenv "PATH")) "ffmpeg")
    (let ((result (run "ball.scm" "--quiet" "--hash" "--movie=new/ball.mp4" "--fps=20" "--size=64x36"
                       "--quality=draft")))
      (test-equal "--movie: status 0" 0 (run-status result))
      (test-equal "and the history is the same" (hash-of) (last (lines-of (run-output result)))))
    (test-equal "a movie has all frames" "11" (frames-of "new/ball.mp4"))
    (write-file "own-movie.scm"
                "(load \"ball.scm\")"
                "(simulate! #:until 0.1 #:movie \"own.webm\" #:size '(65 37) #:quality 'draft #:bare? #t)")
    (test-equal "simulate! makes movies" 0 (run-status (run "own-movie.scm" "--quiet" "--until=0")))
    (test-equal "of odd sizes, too" "4" (frames-of "own.webm"))
    (let ((result
           (shell (string-append
                   "{ " timewarp " ball.scm --quiet --until=1000 --size=320x180 --quality=draft"
                   " --movie=cut.mp4 & p=$!; until [ -s cut.mp4.part ]; do sleep 0.1; done;"
                   " sleep 0.5; kill -INT $p; wait $p; }"))))
      (test-equal "Ctrl-C while a movie is made: status 130" 130 (run-status result))
      (test-assert "leaves a movie that plays"
        (let ((count (string->number (frames-of "cut.mp4")))) (and count (> count 0))))
      (test-assert "under its own name only" (not (file-exists? (in-folder "cut.mp4.part"))))))
  (let ((result (run "ball.scm" "--frames=out" "--size=99999x10")))
    (test-equal "a picture too large: status 2" 2 (run-status result)))
  (write-file "bad-size.scm" "(use-modules (timewarp))" "(render! \"x.png\" #:size 5)")
  (test-assert "a size that is none"
    (string-match "bad-size.scm:2:1: size is 5; expected" (run-errors (run "bad-size.scm")))))
 (else
  (let ((result (run "ball.scm" "--frames=out")))
    (test-equal "without drawing --frames is refused: status 2" 2 (run-status result))
    (test-assert (run-errors result) (string-match "--disable-render" (run-errors result))))
  (write-file "shots.scm" "(load \"ball.scm\")" "(render! \"shot.png\")")
  (test-assert "and render! is an error that says why"
    (string-match "shots.scm:2:1: render! needs drawing" (run-errors (run "shots.scm"))))))

(clean-up)
(test-end "drawing")
