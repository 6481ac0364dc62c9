;; simulate!: from a scene's program what the command line does.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp simulate)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (timewarp files)
  #:use-module (timewarp running)
  #:use-module (timewarp recorders)
  #:export (simulate!))

(define-keyword-procedure (simulate! #:key until frames movie poses events size quality
                                    contacts? bare?)
  "Run the current world and write what happens to files, as the command line does.  File names are
relative to the scene's file.

#:until      s, the time to run to; the scene's duration
#:frames     a folder, made where it is missing, or a pattern like out/%05d.png: pictures (PNG);
             none
#:movie      a file: .mp4, .mov and .mkv are H.264, .webm is VP9, .gif is GIF; by ffmpeg; none
#:size       of the frames, (WIDTH HEIGHT) in pixels, 1 to 16384 each; --size, else (1280 720)
#:quality    of the frames, 'draft, 'normal or 'best; --quality, else 'normal
#:contacts?  #t: the frames show the contacts as render! does; #f, or #t with --contacts
#:bare?      #t: no title, time and scale in the frames; #f, or #t with --no-overlay
#:poses      a CSV file of the poses and velocities of moving bodies at every frame time; none
#:events     a CSV file of every collision, fusion and fission; none"
  (%require-outside-callbacks "simulate!")
  (let ((world (current-world)))
    (call-with-recorders
      (lambda () (run-world! world (or until (world-duration world))))
      #:frames (and frames (scene-file frames))
      #:movie (and movie (scene-file movie))
      #:size size
      #:quality quality
      #:contacts? contacts?
      #:bare? bare?
      #:poses (and poses (scene-file poses))
      #:events (and events (scene-file events)))
    (if #f #f)))
