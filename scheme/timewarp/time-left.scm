;; How long a run will still take: a number that is right to a factor of two, or none.
;;
;; Nobody knows what is yet to be simulated.  But a cost that has been steady for as long as the run
;; still takes, in simulated time, is likely to stay so: then its recent rate tells the time left.
;; So the avalanche shows nothing while it falls, and a run of constant cost shows it from a little
;; beyond its middle on.  A change of the cost after that cannot be foreseen; it hides the number as
;; soon as it is there.
;;
;; A course is a list of samples (SIMULATED-TIME . WALL-TIME), latest first, both in seconds.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp time-left)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (add-sample time-left))

;; how much more than what is left must have been steady: a change at the middle is noticed before
;; anything is shown
(define margin 1.3)
;; the steady stretch is cut into so many pieces, ...
(define pieces 6)
;; ... whose costs differ by at most this factor
(define steadiness 1.6)
;; s: less is the matter of a single event, and of no interest
(define least-answer 1)
;; share of the run below which no stretch is looked at: single events show there
(define least-share 0.05)

(define most-samples 800)

(define (add-sample course time wall until)
  "Return COURSE with one more sample, thinned where it has become long."
  (let ((course (acons time wall course)))
    (if (< (length course) most-samples) course (thinned course until))))

;; Leaves out what neither axis needs: gaps of a 200th of the whole stay.
(define (thinned course until)
  (match-let ((((_ . last-wall) . _) course)
              ((first-time . first-wall) (last course)))
    (let ((time-gap (/ (- until first-time) 200))
          (wall-gap (/ (- last-wall first-wall) 200)))
      (let loop ((course (cdr course)) (kept (list (car course))))
        (match course
          ((oldest) (reverse (cons oldest kept)))
          ((sample . (and older ((time . wall) . _)))
           (match kept
             (((kept-time . kept-wall) . _)
              (loop older
                    (if (and (<= (- kept-time time) time-gap) (<= (- kept-wall wall) wall-gap))
                        kept
                        (cons sample kept)))))))))))

;; The wall time at which the run stood at TIME, on a line between the samples around it.
(define (wall-at course time)
  (let loop ((later (car course)) (course course))
    (match course
      (((sample-time . sample-wall) . older)
       (cond ((> sample-time time) (loop (car course) older))
             ((= (car later) sample-time) sample-wall)
             (else (+ sample-wall
                      (* (- (cdr later) sample-wall)
                         (/ (- time sample-time) (- (car later) sample-time))))))))))

(define (time-left course until)
  "Return how many seconds of wall time a run with this COURSE will take up to the simulated time
UNTIL, or #f where nothing can be said."
  (match course
    (((time . _) . _)
     (let* ((start (car (last course)))
            (left (- until time))
            (stretch (max (* margin left) (* least-share (- until start)))))
       (and (> left 0)
            (>= (- time stretch) start)
            (let* ((walls (map (lambda (k) (wall-at course (- time (* stretch (/ k pieces)))))
                               (iota (1+ pieces))))
                   (costs (map - walls (cdr walls)))
                   (least (apply min costs)))
              (and (> least 0)
                   (<= (apply max costs) (* steadiness least))
                   ;; of the later half, which knows more of a slow change
                   (let ((answer (* (/ left (/ stretch 2))
                                    (apply + (list-head costs (quotient pieces 2))))))
                     (and (>= answer least-answer) answer)))))))
    (() #f)))
