;; Starts: poses that were read back, overlaps that are refused or pushed apart, what set! nudges.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")
(use-modules (timewarp vectors))

(test-begin "starts")

;; a heap settles; its poses, as they are and with six decimals, are put into another world
(define (heap! poses)
  (ground)
  (map (lambda (k)
         (add-body! #:shape (box 0.3 0.3 0.3)
                    #:position (if poses (car (list-ref poses k))
                                   (vector (* 0.03 k) (* 0.02 (modulo k 3)) (+ 0.3 (* 0.4 k))))
                    #:orientation (if poses (cdr (list-ref poses k)) #(1 0 0 0))))
       (iota 6)))
(define (rounded v)
  (list->vector (map (lambda (x) (/ (round (* 1e6 x)) 1e6)) (vector->list v))))
(define poses
  (in-world ()
    (let ((bodies (heap! #f)))
      (run! #:until 8)
      (let ((poses (map (lambda (b) (cons (position b) (orientation b))) bodies)))
        (set! (position (second bodies)) (v+ #(0 0 1e-6) (position (second bodies))))
        (run-for! 0.5)
        (test-assert "a body raised by a micrometre in a heap at rest"
          (every (lambda (b pose) (close? (car pose) (position b) 1e-5)) bodies poses))
        poses))))
(for-each
 (lambda (name poses)
   (in-world ()
     (let ((bodies (heap! poses)))
       (run! #:until 2)
       (test-assert name
         (every (lambda (b pose) (close? (car pose) (position b) 3e-5)) bodies poses)))))
 '("poses read back" "with six decimals")
 (list poses (map (lambda (p) (cons (rounded (car p)) (rounded (cdr p)))) poses)))

;; pieces that abut, of a wall, as an OBJ with six decimals has them
(define (read-cells file)
  (let loop ((lines (string-split (call-with-input-file file get-string-all) #\newline))
             (cells '()))
    (match (and (pair? lines) (string-tokenize (car lines)))
      (#f (reverse (map reverse cells)))
      (("o" _) (loop (cdr lines) (cons '() cells)))
      (("v" . numbers)
       (loop (cdr lines)
             (cons (cons (list->vector (map string->number numbers)) (car cells)) (cdr cells))))
      (_ (loop (cdr lines) cells)))))
(in-world ()
  (ground)
  (let* ((cells (read-cells (string-append (dirname (current-filename)) "/../data/cells.obj")))
         (middles (map (lambda (points) (v* (/ 1 (length points)) (apply v+ points))) cells))
         (bodies (map (lambda (points middle)
                        (add-body! #:position middle
                                   #:shape (convex (map (lambda (p) (v- p middle)) points))))
                      cells middles)))
    (run! #:until 1)
    (test-equal "thirty cells" 30 (length bodies))
    (test-assert "a wall of cells stands"
      (every (lambda (b middle) (< (norm (v- (position b) middle)) 1e-4)) bodies middles))))

;; what is deeper
(define (sunk!)
  (ground)
  (add-body! #:name "ball" #:shape (sphere 0.1)))
(in-world ()
  (sunk!)
  (test-message "a ball half sunk is refused, and the remedy is named"
    "ground and ball overlap by 0.1 m at 0 s; expected .*\\(0.001 m\\).*#:on-overlap 'push.*disable-collisions!"
    (run! #:until 1)))
(in-world ()
  (scene #:on-overlap 'push)
  (let ((ball (sunk!)) (fastest 0))
    (do ((k 1 (1+ k))) ((> k 300))
      (run! #:until (/ k 100))
      (set! fastest (max fastest (norm (velocity ball)))))
    (test-assert "or pushed out" (close? #(0 0 0.1) (position ball) 1e-4))
    (test-assert "slowly" (< fastest 0.14))
    (set! (position ball) #(0 0 0.05))
    (run-for! 2)
    (test-assert "and so it is where it is put there between runs"
      (close? #(0 0 0.1) (position ball) 1e-4))
    (scene #:on-overlap 'refuse)
    (test-message "until it is refused again" "overlap by"
      (begin (set! (position ball) #(0 0 0)) (run-for! 1)))))
(in-world ()
  (test-message "what becomes of overlaps" "on-overlap is shove; expected 'refuse or 'push"
    (scene #:on-overlap 'shove)))

(test-end "starts")
