;; One file of others: whether it loads, and, of a robot, whether it falls on the ground and lies there.
;; With GROUND=yes in the environment a mesh is loaded as ground, and things fall on that.
;;
;;   timewarp -q --quiet -l check-files.scm -c '(check-file "FILE")'
;;
;; prints one line: what became of it, tab, why, or what was mended first.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp) (timewarp worlds) (srfi srfi-1) (ice-9 match) (ice-9 format))

(define (tell what why)
  (format #t "~a\t~a~%" what (string-map (lambda (c) (if (memv c '(#\newline #\tab)) #\space c)) why)))

;; THUNK's value and the lines that were warned of.
(define (noting thunk)
  (let* ((value #f)
         (warned (call-with-output-string
                  (lambda (port)
                    (parameterize ((current-warning-port port)) (set! value (thunk)))))))
    (values value (filter (negate string-null?) (string-split warned #\newline)))))

(define (short note)
  (if (string-prefix? "timewarp: warning: " note) (substring note 19) note))

(define (tell-loaded notes more)
  (if (null? notes)
      (tell (string-append "loads" more) "")
      (tell (string-append "mended" more) (format #f "~a of these: ~a" (length notes) (short (car notes))))))

(define-syntax-rule (or-refused body ...)
  (catch 'timewarp-error
    (lambda () body ...)
    (lambda (key who format-string arguments . rest) (tell "refused" (car arguments)))))

;; The least z of all links that touch, m.
(define (lowest links)
  (fold (lambda (link least)
          (catch 'timewarp-error
            (lambda ()
              (call-with-values (lambda () (bounding-box link))
                (lambda (low high) (min least (vector-ref low 2)))))
            (const least)))
        +inf.0 links))
(define (error? thunk) (catch 'timewarp-error (lambda () (thunk) #f) (const #t)))

(define seconds 2)

;; How high the lowest point is after a fall by 5 cm on the ground, m.
(define (drop file)
  (parameterize ((current-warning-port (%make-void-port "w")))
    (let ((low (parameterize ((current-world (make-world)))
                 (lowest (multibody-links (load-urdf file #:base 'free))))))
      (if (inf? low)
          low
          (parameterize ((current-world (make-world)))
            (add-body! #:name "the ground" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
            (let ((robot (load-urdf file #:base 'free #:position (vector 0 0 (- 0.05 low)))))
              (run! #:until seconds)
              (lowest (multibody-links robot))))))))

(define (check-robot file)
  (call-with-values (lambda () (noting (lambda () (load-urdf file))))
    (lambda (robot notes)
      (if (not (multibody? robot))
          (tell-loaded notes ", scenery")
          (let ((low (drop file)))
            (cond ((inf? low) (tell-loaded notes ", touches nothing"))
                  ((< low -0.01)
                   (tell "sinks" (format #f "~,4f m below the ground after ~a s" (- low) seconds)))
                  (else (tell-loaded notes ""))))))))

;; Balls and boxes of a thirtieth of the ground's size fall on it from above.  How deep the deepest is in
;; it, in sizes.
(define (rain-on ground)
  (parameterize ((current-world (make-world)))
    (call-with-values (lambda () (bounding-box (add-body! #:name "ground" #:shape ground #:fixed? #t)))
      (lambda (low high)
        (let* ((sides (map - (vector->list high) (vector->list low)))
               (size (* 1/30 (apply max sides)))
               ;; of the middle one of three, or one beside it; past the edge of what is narrow
               (at (lambda (axis which)
                     (+ (* 1/2 (+ (vector-ref low axis) (vector-ref high axis)))
                        (* (- which 1) (max (* 1/3 (list-ref sides axis)) (* 3 size)))))))
          (do ((k 0 (1+ k))) ((= k 9))
            (add-body! #:shape (if (even? k) (sphere size) (box size (* 1.5 size) (* 2 size)))
                       #:position (vector (at 0 (modulo k 3)) (at 1 (quotient k 3))
                                          (+ (vector-ref high 2) (* 3 size)))))
          ;; as long as it takes to fall by the whole
          (run! #:until (sqrt (/ (apply max sides) 4)))
          (/ (assq-ref (statistics) 'max_penetration) size))))))

(define (check-ground file)
  (call-with-values (lambda () (noting (lambda () (load-shape file #:concave? #t))))
    (lambda (shape notes)
      (let ((depth (rain-on shape)))
        (if (> depth 0.02)
            (tell "sinks" (format #f "~,3f of what lies on it" depth))
            (tell-loaded notes ", as ground"))))))

(define (check-mesh file)
  (call-with-values (lambda () (noting (lambda () (load-shape file #:convex-hull? #t))))
    (lambda (shape notes)
      (tell-loaded notes (if (error? (lambda () (load-shape file))) ", as hulls" "")))))

(define (check-file file)
  (or-refused (cond ((string-suffix-ci? ".urdf" file) (check-robot file))
                    ((getenv "GROUND") (check-ground file))
                    (else (check-mesh file)))))
