;; Drawing: frames of a run and single pictures.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp drawing)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (timewarp files)
  #:use-module ((timewarp option-table) #:select (text->size))
  #:use-module (ice-9 match)
  #:export (render!)
  ;; for the other modules
  #:export (open-frames
            attach-frames!
            show-new-looks!
            await-frames
            close-frames!
            frames-written
            frames-awaited?
            check-shot
            keep-first-view!
            draw-world!
            require-drawing))

(define (require-drawing what)
  "Raise an error unless drawing is compiled in."
  (unless (%drawing?)
    (raise-error (string-append what " needs drawing, which was left out when timewarp was built; "
                                "expected a build without --disable-render"))))

;; SIZE as two values; (WIDTH HEIGHT), a vector of these, "WIDTHxHEIGHT", or #f for the default.
(define (picture-size size)
  (match (cond ((not size) (or (override 'size) '(1280 720)))
               ((string? size) (or (text->size size) size))
               (else size))
    ((or ((? exact-integer? width) (? exact-integer? height))
         #((? exact-integer? width) (? exact-integer? height)))
     (values width height))
    (other (bad-value "size" other "(WIDTH HEIGHT) in pixels, or \"WIDTHxHEIGHT\""))))

(define (picture-quality quality)
  (let ((quality (or quality (override 'quality) 'normal)))
    (unless (memq quality '(draft normal best))
      (bad-value "quality" quality "'draft, 'normal or 'best"))
    quality))

;; No other format is written, whatever a name promises.
(define (check-picture-name what file)
  (unless (and (string? file) (string-suffix-ci? ".png" file))
    (bad-value what file "a name that ends in .png, the only format that is written")))

(define (draw-contacts? contacts?)
  (->bool (or contacts? (override 'contacts))))

(define (draw-overlay? bare?)
  (not (or bare? (override 'no-overlay))))

(define (looks world)
  ;; a box to be in view, where a picture of a later time is to look like the first
  (list (append (world-ref world 'camera '()) (world-ref world 'in-view '()))
        (world-ref world 'light '())
        (world-ref world 'sky '())))

(define (open-frames frames movie size quality bare?)
  "Prepare drawing into the folder or pattern FRAMES, the file MOVIE, or both (#f: neither); refuse
at once what cannot be written."
  (require-drawing "drawing frames")
  ;; a pattern says what the files are called, a folder does not
  (when (and (string? frames) (string-index frames #\%))
    (check-picture-name "the pattern of frames" frames))
  ;; a movie of every N-th frame would run N times too fast
  (when (and movie (override 'part))
    (raise-error (string-append "a movie has all frames, --part draws some of them; expected "
                                "--frames with --part, or a movie without it")))
  (call-with-values (lambda () (picture-size size))
    (lambda (width height)
      (%open-frames frames movie width height (picture-quality quality)
                    (draw-overlay? bare?)))))

(define (attach-frames! world drawer fps contacts?)
  "Let WORLD feed DRAWER with FPS frames per second, or with what --part says of them, its contacts
drawn if CONTACTS? is true."
  (world-set! world 'drawer drawer)
  (world-set! world 'drawn-from (cons (%world-time world) fps))
  (%attach-frames! world drawer fps (override 'part) (looks world) (world-ref world 'title #f)
                   (draw-contacts? contacts?)))

(define (show-new-looks! world)
  "Let the frames of WORLD, if any are being drawn, have the camera, light and sky that it has now."
  (let ((drawer (world-ref world 'drawer #f)))
    (when drawer (%set-looks! world drawer (looks world)))))

;; s of wall time: Ctrl-C has its say between two waits
(define patience 0.05)

(define (await-frames drawer most idle)
  "Wait until at most MOST frames of DRAWER are not on disk; call IDLE again and again until then."
  (unless (%await-frames drawer most patience)
    (idle)
    (await-frames drawer most idle)))

(define (close-frames! world drawer interrupted? idle)
  "Let WORLD no longer feed DRAWER, and wait until all its frames are on disk, calling IDLE again and
again; if INTERRUPTED?, or when Ctrl-C interrupts the waiting, for the one only that is being drawn."
  (let ((all? #f))
    (dynamic-wind
      (const #t)
      (lambda ()
        (unless interrupted?
          (let loop ()
            (unless (%finish-frames! world drawer patience)
              (idle)
              (loop)))
          (set! all? #t)))
      (lambda ()
        (world-set! world 'drawer #f)
        (%close-frames! world drawer all?)))))

(define (frames-written world until)
  "Return how many frames of WORLD are on disk in this run, and how many it has up to the time UNTIL;
#f and #f where none are drawn."
  (match (world-ref world 'drawer #f)
    (#f (values #f #f))
    (drawer
     (match (world-ref world 'drawn-from)
       ((start . fps) (values (%frames-written drawer) (frames-between start until fps)))))))

(define (frames-awaited? world)
  "Return #t if the run of WORLD waits for its frames to be drawn."
  (call-with-values (lambda () (frames-written world (%world-time world)))
    (lambda (written due) (and written (> (- due written) 2)))))

;; Frame k is at k/fps; of every PARTS one is drawn, the PART-th.
(define (frames-between start end fps)
  (define (at k) (/ (exact->inexact k) fps))
  (define (first-at-least time)
    (let loop ((k (inexact->exact (floor (* time fps)))))
      (if (< (at k) time) (loop (1+ k)) k)))
  (define (first-beyond time)
    (let ((k (first-at-least time))) (if (= (at k) time) (1+ k) k)))
  (match (or (override 'part) '(1 1))
    ((part parts)
     (let ((drawn-before (lambda (k) (quotient (+ k (- parts part)) parts))))
       (max 0 (- (drawn-before (first-beyond end)) (drawn-before (first-at-least start))))))))

(define (check-shot file size quality)
  "Refuse at once what draw-world! could not draw into FILE; make its folder."
  (require-drawing "drawing a picture")
  (check-picture-name "the picture's file" file)
  (call-with-values (lambda () (picture-size size))
    (lambda (width height)
      (%check-picture file width height (picture-quality quality)))))

(define (keep-first-view! world)
  "Let a camera of WORLD that is placed so that the scene is in view stay where it is now."
  (world-set! world 'in-view (list (cons 'in-view (%bounds-in-view world)))))

(define (draw-world! world file size quality contacts? bare?)
  "Draw WORLD as it is now into FILE."
  (call-with-values (lambda () (picture-size size))
    (lambda (width height)
      (%render! world file width height (picture-quality quality) (draw-overlay? bare?)
                (looks world) (world-ref world 'title #f) (draw-contacts? contacts?)))))

(define-keyword-procedure (render! file #:key size quality contacts? bare?)
  "Draw the current world as it is now into FILE (PNG), a name relative to the scene's file.

#:size       (WIDTH HEIGHT) in pixels, 1 to 16384 each; --size, else (1280 720)
#:quality    'draft, 'normal or 'best; --quality, else 'normal
#:contacts?  #t: a line along the normal shows each contact that carries load, its length by the
             logarithm of the force, its colour whether it sticks or slips; #f, or #t with
             --contacts
#:bare?      #t: no title, time and scale in the picture; #f, or #t with --no-overlay"
  (%require-outside-callbacks "render!")
  (require-drawing "render!")
  (check-picture-name "the picture's file" file)
  (draw-world! (current-world) (scene-file file) size quality contacts? bare?))
