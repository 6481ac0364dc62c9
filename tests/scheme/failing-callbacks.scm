;; 3000 callbacks that fail, each in one of five ways, in a world of their own: for tests/leaks-test.sh.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (timewarp))

(define ways-to-fail
  (vector (lambda (view) (car 5))
          (lambda (view) (error "no"))
          (lambda (view) (throw 'own-key 1 2))
          (lambda (view) (set! (velocity view) 'fast))
          (lambda (view) (add-body! #:shape (sphere 1)))))

;; whether running a world with this callback raises an error
(define (fails? callback)
  (parameterize ((current-world (make-world)))
    (let ((ball (add-body! #:shape (sphere 0.1) #:slots '((n . 0)))))
      (add-callback! ball
        (lambda (time view)
          (set! (slot view 'n) (1+ (slot view 'n)))
          (callback view))
        #:period 0.1))
    (catch #t
      (lambda () (run! #:until 1) #f)
      (const #t))))

(let loop ((i 0) (failures 0))
  (if (< i 3000)
      (loop (1+ i)
            (if (fails? (vector-ref ways-to-fail (modulo i (vector-length ways-to-fail))))
                (1+ failures)
                failures))
      (begin (gc) (format #t "~a failures~%" failures))))
