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

(define-keyword-procedure (simulate! #:key until frames movie record poses events size quality
                                    contacts?)
  "Run the current world to the time `until' (by default the scene's duration) and write frames (a
folder or a pattern like out/%05d.png; size (WIDTH HEIGHT), quality 'draft, 'normal or 'best; with
contacts? they show the contacts as render! does), poses and events (CSV files) on the way.  File names
are relative to the scene's file."
  (%require-outside-callbacks "simulate!")
  (when movie (not-there-yet "#:movie" "the movie writer"))
  (when record (not-there-yet "#:record" "the recording format"))
  (let ((world (current-world)))
    (call-with-recorders world
      (lambda () (run-world! world (or until (world-duration world))))
      #:frames (and frames (scene-file frames))
      #:size size
      #:quality quality
      #:contacts? contacts?
      #:poses (and poses (scene-file poses))
      #:events (and events (scene-file events)))
    (if #f #f)))
