;; The time left is right to a factor of two whenever it is shown, whatever the course of the cost.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp time-left))

(test-begin "time left")

;; Runs a course from time 0 to 10 that costs (COST time) seconds of wall time a second, sampled
;; each 0.2 s of wall time.  Returns ((TIME ESTIMATE TRUE) ...) of what was shown, and the longest
;; course kept.
(define (shown cost)
  (define dt 0.002)
  (define walls                         ; at k dt
    (let loop ((k 0) (wall 0) (walls '()))
      (if (> k 5000)
          (list->vector (reverse walls))
          (loop (1+ k) (+ wall (* dt (cost (* k dt)))) (cons wall walls)))))
  (define end (vector-ref walls 5000))
  (let loop ((k 0) (next 0) (course '()) (found '()) (longest 0))
    (if (= k 5000)
        (values (reverse found) longest)
        (let ((time (* k dt)) (wall (vector-ref walls k)))
          (if (< wall next)
              (loop (1+ k) next course found longest)
              (let* ((course (add-sample course time wall 10))
                     (left (time-left course 10)))
                (loop (1+ k) (+ wall 0.2) course
                      (if left (cons (list time left (- end wall)) found) found)
                      (max longest (length course)))))))))

(define (right? found)
  (every (match-lambda ((time left true) (and (<= left (* 2 true)) (<= true (* 2 left))))) found))

;; From FROM on it must be shown at least in half of the samples.
(define* (check name cost #:key from)
  (call-with-values (lambda () (shown cost))
    (lambda (found longest)
      (test-assert (string-append name ": right to a factor of two") (right? found))
      (test-assert (string-append name ": the samples kept are bounded") (<= longest 800))
      (when from
        (test-assert (string-append name ": shown in the end")
          (> (length (filter (match-lambda ((time . _) (>= time from))) found)) 10))
        (test-assert (string-append name ": from there on")
          (any (match-lambda ((time . _) (< time (+ from 0.5)))) found))))))

(check "constant" (const 20) #:from 5.7)
(check "constant and quick" (const 2) #:from 5.7)
(check "constant and long" (const 400) #:from 5.7)

(for-each
 (lambda (at)
   (for-each
    (lambda (factor)
      (check (format #f "a step by ~a at ~a" factor at)
             (lambda (time) (if (< time at) 20 (* 20 factor)))))
    '(0.02 0.1 0.4 0.8 1.3 2 5 50)))
 '(0.1 1 2.5 4 5))

(for-each
 (lambda (slope)
   (check (format #f "a ramp to ~a times" slope)
          (lambda (time) (* 20 (+ 1 (* 0.1 time (- slope 1)))))))
 '(0.05 0.3 3 20 100))

(for-each
 (lambda (factor)
   (check (format #f "a burst by ~a, then rest" factor)
          (lambda (time) (if (< 1 time 3) (* 2 factor) 2))
          #:from 7.5))
 '(3 20 200))
(check "the avalanche: rising, falling, resting"
       (lambda (time) (+ 5 (* 600 time (exp (* -1.5 time)))))
       #:from 8.5)
;; what wavers is an average
(check "bursts all the time" (lambda (time) (if (even? (inexact->exact (floor (* 200 time)))) 5 40)) #:from 5.7)

(test-equal "nothing is known at the start" #f (time-left '() 10))
(test-equal "nor where time stands" #f (time-left '((1 . 3) (1 . 2) (1 . 1)) 10))
(test-equal "nor at the end" #f (time-left '((10 . 3) (9 . 2) (0 . 1)) 10))

(test-end "time left")
