;; Handles of what was added to a world and can be taken away: callbacks, observers and forces.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp parts)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp worlds)
  #:use-module (srfi srfi-9)
  #:use-module (srfi srfi-9 gnu)
  #:export (make-handle
            remove-by-handle!
            names-text
            short-text
            add-frame-observer!
            waiting-observers
            set-waiting-observers!))

;; KIND is a symbol, TEXT says what it is, PART is what the C++ side knows it by.
(define-record-type <handle>
  (make-handle kind text part)
  handle?
  (kind handle-kind)
  (text handle-text)
  (part handle-part))

(set-record-type-printer! <handle>
  (lambda (handle port)
    (format port "#<~a~a>" (handle-text handle)
            (if (or (%inside-callback?) (there? handle)) "" " (removed)"))))

(define (there? handle)
  (let ((part (handle-part handle)))
    (or (%there? part)
        (->bool (memq part (waiting-observers (%addition-world part)))))))

(define (remove-by-handle! who kind maker handle)
  "Take away what HANDLE stands for, of KIND, as MAKER returns it, for the procedure WHO."
  (%require-outside-callbacks who)
  (let ((name (string-append "the " (symbol->string kind))))
    (unless (and (handle? handle) (eq? (handle-kind handle) kind))
      (bad-value name handle (string-append "what " maker " returned")))
    (unless (there? handle)
      (bad-value name handle "one that is there: it was removed, or restore! went back to before it"))
    (let* ((part (handle-part handle))
           (world (%addition-world part)))
      (if (and (eq? world (current-world)) (memq part (waiting-observers world)))
          (set-waiting-observers! world (delq part (waiting-observers world)))
          (%remove! (current-world) part who (string-append "the " (handle-text handle))))
      (if #f #f))))

;; ---- texts ----

(define (names-text sides)
  "Return how SIDES, bodies, multibodies, materials or #t for all, are called in a text."
  (string-join (map (lambda (side)
                      (cond ((symbol? side) (symbol->string side))
                            ((eq? side #t) "all")
                            (else (%body-name side))))
                    sides)
               ", "))

(define (short-text x)
  "Return the number X as a text, a whole one without a point."
  (let ((rounded (round x)))
    (number->string (if (and (= x rounded) (< (abs x) 1e15))
                        (inexact->exact rounded)
                        (exact->inexact x)))))

;; ---- observers of frames ----

;; They wait for the first run, since the scene may still say how many frames a second has.
(define (waiting-observers world)
  "Return the list of the observers of frames that WORLD will have from its next run on."
  (world-ref world 'waiting-observers '()))

(define (set-waiting-observers! world parts)
  (world-set! world 'waiting-observers parts)
  (unless (null? parts)
    (at-first-run! world
      (lambda ()
        (let ((parts (waiting-observers world)))
          (world-set! world 'waiting-observers '())
          (for-each (lambda (part) (%observe-frames! part (world-fps world))) parts))))))

(define (add-frame-observer! world part)
  "Let PART look at the frames of WORLD from its next run on."
  (set-waiting-observers! world (append (waiting-observers world) (list part))))
