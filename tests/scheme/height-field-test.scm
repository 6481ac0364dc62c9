;; Height fields.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors) (ice-9 receive))

(test-begin "height-field")

(define rows '((0 0 0 0) (0 1 2 0) (0 0 0 0)))
(define typed (list->typed-array 'f64 2 '((0.0 0.0) (0.0 1.0))))

(test-equal "prints as what it is" "#<shape height field>" (format #f "~s" (height-field rows)))
(test-equal "its grid is in the middle" '(#(-3.0 -0.5 -2.0) #(3.0 0.5 2.0))
  (in-world ()
    (let ((ground (add-body! #:shape (height-field rows #:spacing #(2 0.5)) #:fixed? #t)))
      (receive box (bounding-box ground) box))))
;; rows along y: the corner of height 2 is at x = 0.5 in the middle row
(test-assert "a ray finds the height at a corner of the grid"
  (in-world ()
    (add-body! #:shape (height-field rows) #:fixed? #t)
    (close? 3 (hit-distance (ray-cast #(0.5 0 5) #(0 0 -1))) 1e-12)))
(test-assert "cells are cut along the diagonal of greater x and y"
  (in-world ()
    (add-body! #:shape (height-field typed) #:fixed? #t)
    (and (close? 4.5 (hit-distance (ray-cast #(0 0 5) #(0 0 -1))) 1e-12)
         (close? 4.75 (hit-distance (ray-cast #(0.25 -0.25 5) #(0 0 -1))) 1e-12))))
(test-assert "a ball lies in a hollow"
  (in-world ()
    (let ((ball (begin
                  (add-body! #:shape (height-field '((1 1 1) (1 0 1) (1 1 1))) #:fixed? #t)
                  (add-body! #:shape (sphere 0.2) #:position #(0.1 0.05 0.9)))))
      (set-contact-parameters! #t #t #:restitution 0 #:friction 0.5 #:rolling-friction 0.01)
      (run! #:until 6)
      (and (< (norm (velocity ball)) 1e-6)
           ;; it lies on the steep faces beside the diagonal, along which these are level
           (close? (vector-ref (position ball) 0) (vector-ref (position ball) 1) 1e-3)
           (close? (* 0.2 (sqrt 3)) (vector-ref (position ball) 2) 1e-3)))))
(test-assert "what is placed on it has the same end in one piece and in many"
  (let ((run (lambda (step)
               (in-world ()
                 (set-contact-parameters! #t #t #:restitution 0.4 #:friction 0.5)
                 (add-body! #:shape (height-field '((0 0.3 0 0.2) (0.1 0 0.2 0) (0 0.2 0 0.3))
                                                  #:spacing 0.4)
                            #:fixed? #t)
                 (add-body! #:shape (box 0.2 0.15 0.1) #:position #(0.1 0 0.6)
                            #:angular-velocity #(2 1 0))
                 (do ((t step (+ t step))) ((> t 1)) (run! #:until t))
                 (run! #:until 1)
                 (all-poses)))))
    (equal? (run 1) (run 0.07))))

;; ---- colours ----

(define two-rows '((0 1) (2 3)))
(test-assert "colours by height" 
  (shape? (height-field rows #:colors '((0 #(0.2 0.5 0.2)) (1 #(0.5 0.4 0.3)) (2 #(1 1 1))))))
(test-assert "colours for each height, as rows or an array"
  (every shape? (list (height-field two-rows #:colors '((#(0 0 0) #(1 0 0)) (#(0 1 0) #(0 0 1))))
                      (height-field typed #:colors (make-array #(1 0.5 0) 2 2)))))
(test-equal "a procedure gets x, y and the height of each point of the grid"
  '((-1.0 -0.25 0) (-1.0 0.25 2) (1.0 -0.25 1) (1.0 0.25 3))
  (let ((seen '()))
    (height-field two-rows #:spacing #(2 0.5)
                  #:colors (lambda (x y height)
                             (set! seen (cons (list (* 1.0 x) (* 1.0 y) height) seen))
                             #(1 1 1)))
    (sort seen (lambda (a b) (or (< (car a) (car b))
                                 (and (= (car a) (car b)) (< (cadr a) (cadr b))))))))
(test-assert "arrays may count from anywhere"
  (shape? (height-field (make-shared-array (list->array 2 two-rows) (lambda (i j) (list (- i 3) (1- j)))
                                           '(3 4) '(1 2))
                        #:colors (lambda (x y height) (if (= (abs x) (abs y) 1/2) #(1 0 0) 'wrong)))))
(test-equal "a body falls as without" '(#t)
  (let ((end (lambda (colors)
               (in-world ()
                 (add-body! #:shape (height-field rows #:colors colors) #:fixed? #t)
                 (add-body! #:shape (box 0.2 0.2 0.2) #:position #(0.1 0 3))
                 (run! #:until 1)
                 (all-poses)))))
    (list (equal? (end #f) (end '((0 #(0 0 0)) (1 #(1 1 1))))))))
(test-message "colours of a wrong size" "colors.*rows as the heights"
  (height-field rows #:colors '((#(0 0 0) #(1 0 0)) (#(0 1 0) #(0 0 1)))))
(test-message "rows of colours of different lengths" "row 1 of colors has 1 colors and row 0 has 2"
  (height-field two-rows #:colors '((#(0 0 0) #(1 0 0)) (#(0 1 0)))))
(test-message "heights that do not grow" "heights that grow"
  (height-field rows #:colors '((0 #(0 0 0)) (0 #(1 1 1)))))
(test-message "no colour at a height" "heights that grow"
  (height-field rows #:colors '((0 #(0 0 0)) (1 red))))
(test-message "a colour that is none" "color 1 in row 0 of a height field is #.0 2 0.; expected red, green and blue"
  (height-field two-rows #:colors '((#(0 0 0) #(0 2 0)) (#(0 1 0) #(0 0 1)))))
(test-message "a procedure that returns none" "a color of the ground"
  (height-field two-rows #:colors (lambda (x y height) 5)))
(test-message "a procedure of one argument" "#:colors.*takes.*expected one that takes 3"
  (height-field two-rows #:colors (lambda (height) #(0 0 0))))
(test-message "no colours" "colors" (height-field rows #:colors 'green))
(test-message "wrong heights are told first" "heights"
  (height-field '((0 a) (0 0)) #:colors (lambda (x y height) #(0 0 0))))

(test-message "no array" "heights" (height-field 3))
(test-message "a vector" "array of rank 2" (height-field #(1 2 3)))
(test-message "rows of different lengths" "row 1 of heights has 3 .*row 0 has 2; .*of one length"
  (height-field '((0 0) (0 0 0))))
(test-message "one row" "1 rows of 3 heights; expected at least 2 of 2" (height-field '((0 0 0))))
(test-message "no number" "heights" (height-field '((0 0) (0 a))))
(test-message "not finite" "height 1 in row 1" (height-field '((0 0) (0 +inf.0))))
(test-message "no spacing" "spacing" (height-field rows #:spacing 0))
(test-message "a spacing of three" "spacing" (height-field rows #:spacing #(1 2 3)))
(test-message "it does not move" "is a height field" (add-body! #:shape (height-field rows)))
(test-message "nor with a mass" "height field that moves freely"
  (add-body! #:shape (height-field rows) #:mass 1 #:inertia #(1 1 1)))
(test-message "it has no volume" "without mass" (shape-volume (height-field rows)))
(test-message "no part of a union" "body of its own" (union (sphere 1) (height-field rows)))
(test-message "not placed within a shape" "#:position" (placed (height-field rows)))

(test-message "too many pairs of parts" "many has 46341 parts and body-0 46341; expected a product"
  (let ((many (apply union (make-list 46341 (sphere 1)))))
    (add-body! #:shape many)
    (add-body! #:shape many #:name "many" #:position #(5 0 0))))

(test-end "height-field")
