;;; A drum that turns about a level axis, with balls in it: they never rest, and hang together in one
;;; heap.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (srfi srfi-1))

(define-scene-parameter balls 200 "balls in the drum")
(define-scene-parameter rate 2 "rad/s, of the drum")

(scene #:title "Balls in a drum" #:accuracy 1e-3 #:duration 5)
(set-contact-parameters! #t #t #:restitution 0.2 #:friction 0.5)

(define ball-radius 0.06)
(define drum-radius (* 0.16 (expt balls 1/3)))
(define drum-length (* 1.2 drum-radius))
(define pi 3.141592653589793)

;;; Staves in a ring about y, and an end on either side.
(define staves 24)
(define thickness 0.1)
(define (stave k)
  (let ((angle (/ (* 2 pi k) staves)) (away (+ drum-radius (/ thickness 2))))
    (placed (box thickness drum-length (* 2.2 away (tan (/ pi staves))))
            #:position (vector (* away (cos angle)) 0 (* -1 away (sin angle)))
            #:orientation (rotation #(0 1 0) angle))))
(define (end side)
  (let ((wide (* 2 (+ drum-radius thickness))))
    (placed (box wide thickness wide)
            #:position (vector 0 (* side 1/2 (+ drum-length thickness)) 0))))
(define turns 100)
(add-body! #:name "drum" #:shape (apply union (end -1) (end 1) (map stave (iota staves)))
           #:motion (keyframes (map (lambda (k)
                                      (list (/ (* k pi) 2 rate) #(0 0 0)
                                            (rotation #(0 1 0) (* k pi 1/2))))
                                    (iota turns))))

;;; Balls on a grid in the middle, a little aside.
(define state (scene-random-state))
(define (aside) (* 0.02 (- (random:uniform state) 0.5)))
(define spacing (* 2.4 ball-radius))
(define reach (inexact->exact (floor (/ drum-radius spacing))))
(define along (inexact->exact (floor (/ (* 1/2 drum-length) spacing))))
(define places
  (append-map (lambda (k)
                (append-map (lambda (i)
                              (filter-map (lambda (j)
                                            (let ((x (* i spacing)) (z (* k spacing)))
                                              (and (< (sqrt (+ (* x x) (* z z)))
                                                      (- drum-radius (* 2 ball-radius)))
                                                   (< (+ (abs (* j spacing)) (* 1.5 ball-radius))
                                                      (/ drum-length 2))
                                                   (list x (* j spacing) z))))
                                          (iota (1+ (* 2 along)) (- along))))
                            (iota (1+ (* 2 reach)) (- reach))))
              (iota (1+ (* 2 reach)) (- reach))))
(for-each (lambda (place)
            (add-body! #:shape (sphere ball-radius) #:density 2600
                       #:position (apply vector (map (lambda (x) (+ x (aside))) place))))
          (take places balls))
