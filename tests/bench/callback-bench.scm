;; What a callback costs beside the bare call of its procedure.
;;
;; A callback is called 200,000 times in a simulated second on bodies that fly, which is timed; then once, and
;; calls its procedure as often on the views that it was handed, by itself: what is left between the two is the
;; kernel's and the border's.  CPU of the whole program, the collector's threads included.  Lines of a table.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (ice-9 format) (ice-9 match))

(define calls 200000)
(define (cpu thunk)
  (let ((start (get-internal-run-time)))
    (thunk)
    (/ (- (get-internal-run-time) start) internal-time-units-per-second)))

(define (bodies count)
  (map (lambda (k)
         (add-body! #:shape (sphere 0.1) #:position (vector k 0 0) #:slots '((number . 0.0) (text . "a"))))
       (iota count)))

;; By itself, as compiled code calls it.
(define (call-often procedure time views)
  (define-syntax-rule (repeat view ...)
    (let loop ((k 0))
      (when (< k calls)
        (procedure time view ...)
        (loop (1+ k)))))
  (match views
    ((a) (repeat a))
    ((a b) (repeat a b))
    ((a b c d) (repeat a b c d))))

;; MAKE-TARGETS in a fresh world, whose callback is PROCEDURE: us a call, in the loop and bare.
(define (row name make-targets procedure)
  (define (seconds period procedure)
    (reset!)
    (let ((targets (make-targets)))
      (add-callback! targets procedure #:period period)
      (cpu (lambda () (run! #:until 1)))))
  (let* ((whole (seconds (/ 1.0 calls) procedure))
         (bare 0))
    (seconds 10
             (lambda (time . views)
               (set! bare (cpu (lambda ()
                                 (call-often procedure time views))))))
    (let ((us (lambda (seconds) (* 1e6 (/ seconds calls)))))
      (format #t "| ~a | ~,2f | ~,2f | ~,2f |~%" name (us whole) (us bare) (us (- whole bare))))))

(format #t "| callback | us a call | bare | beside it |~%| --- | --- | --- | --- |~%")
(row "nothing" (lambda () (bodies 1)) (lambda (time a) #t))
(row "nothing, four targets" (lambda () (bodies 4)) (lambda (time a b c d) #t))
(row "reads `position`" (lambda () (bodies 1)) (lambda (time a) (position a)))
(row "reads `accelerometer`" (lambda () (bodies 1)) (lambda (time a) (accelerometer a)))
(row "reads `rangefinder`"
     (lambda ()
       (cons (add-body! #:shape (half-space #(0 0 1) -20) #:fixed? #t) (bodies 1)))
     (lambda (time ground a) (rangefinder a #(0 0 -1) #:bodies (list ground))))
(row "sets a slot" (lambda () (bodies 1)) (lambda (time a) (set! (slot a 'number) time)))
(row "sets a slot of 20 numbers" (lambda () (bodies 1))
     (lambda (time a) (set! (slot a 'number) (make-vector 20 time))))
(row "sets `applied-force`" (lambda () (bodies 1))
     (lambda (time a) (set! (applied-force a) (vector time 0 0))))
