;;; A scene whose bodies begin a little aside, each its own way: how fast two runs part that differ by
;;; this alone.
;;;
;;;   timewarp nudged.scm -D scene-file=FILE.scm [-D nudge=METRES] [-D NAME=VALUE ...]
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (timewarp vectors) (srfi srfi-1))

(define-scene-parameter scene-file "atoms.scm" "the scene to load")
(define-scene-parameter nudge 1e-12 "how far each moving body is put aside, m")

(load "load-apart.scm")
(load-apart scene-file)
(for-each (lambda (body i)
            (when (eq? (body-kind body) 'dynamic)
              (let ((aside (vector (sin (* 3 i)) (sin (* 5 i)) (cos (* 7 i)))))
                (set! (position body) (v+ (position body) (v* (/ nudge (norm aside)) aside))))))
          (world-bodies) (iota (length (world-bodies))))
