;; Running one top-level form of a scene.
;;
;; A form is expanded, then walked where it holds no procedure and no loop, else compiled.  Walking
;; takes 20 microseconds where the compiler takes 400, so that a scene may have a hundred
;; thousand forms; and it tells the place of each call exactly, also where compiled code would leave
;; no frame.  What is called again and again is compiled: it is faster, and its frames keep their
;; lines.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp forms)
  #:use-module (timewarp primitives)
  #:use-module (timewarp errors)
  #:use-module (timewarp effects)
  #:use-module (language tree-il)
  #:use-module (system base compile)
  #:use-module (system vm loader)
  #:use-module (system vm program)
  #:use-module (system foreign)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (run-form hold-all-units!))

(define (run-form form)
  "Run FORM, syntax or a datum, in the current module."
  ;; as the compiler expands it: definitions of syntax hold from here on
  (let ((expanded (macroexpand form 'c '(compile load eval))))
    (let ((walkable? (walkable? expanded)))
      (look-for-effects! expanded walkable?)
      (if walkable?
          (walk-form expanded)
          ((compiled expanded))))))

;; ---- compiled ----

;; The plain compiler (-O1): 2 ms a form rather than 30.
(define (compiled expanded)
  (let ((thunk (load-thunk-from-memory
                (compile expanded #:from 'tree-il #:to 'bytecode #:env (current-module)
                         #:optimization-level 1 #:warning-level 0))))
    (hold! (find-mapped-elf-image (program-code thunk)))
    thunk))

;; addresses of the units of code whose data is no root set of the collector any more, of which there
;; may be 2047 only
(define held (make-hash-table))

(define (hold! unit)
  (let ((address (pointer-address (bytevector->pointer unit))))
    (unless (hashv-ref held address)
      (hashv-set! held address #t)
      (%hold-unit! unit))))

(define (hold-all-units!)
  "Let all code that is loaded now, whoever has compiled it, need no root set of the collector."
  (for-each hold! (all-mapped-elf-images)))

;; ---- walked ----

(define (walkable? x)
  (match x
    (($ <call> _ proc args) (and (walkable? proc) (every walkable? args)))
    ((or ($ <const>) ($ <void>) ($ <primitive-ref>) ($ <toplevel-ref>) ($ <module-ref>)
         ($ <lexical-ref>))
     #t)
    ((or ($ <toplevel-define> _ _ _ value) ($ <toplevel-set> _ _ _ value)) (walkable? value))
    (($ <seq> _ head tail) (and (walkable? head) (walkable? tail)))
    (($ <conditional> _ test consequent alternate)
     (and (walkable? test) (walkable? consequent) (walkable? alternate)))
    (($ <let> _ _ _ values body) (and (every walkable? values) (walkable? body)))
    (_ #f)))

;; This procedure's frame on the stack stands for the form: errors.scm asks for `current-form-place'
;; where it meets one.
(define (walk-form expanded)
  (walk expanded '())
  *unspecified*)

;; LEXICALS: alist of the variables of the `let's around, by their unique names.
(define (walk x lexicals)
  (match x
    (($ <const> _ value) value)
    (($ <call> src proc args)
     (let* ((procedure (walk proc lexicals))
            (arguments (map-in-order (lambda (arg) (walk arg lexicals)) args)))
       (mark-place! src)
       (apply procedure arguments)))
    (($ <toplevel-ref> src _ name) (value-of (current-module) name src))
    (($ <lexical-ref> _ _ unique) (assq-ref lexicals unique))
    (($ <module-ref> src module name public?)
     (value-of (if public? (resolve-interface module) (resolve-module module)) name src))
    (($ <primitive-ref> src name) (value-of the-root-module name src))
    (($ <toplevel-define> _ _ name value)
     (module-define! (current-module) name (walk value lexicals)))
    (($ <toplevel-set> src _ name value)
     (let ((value (walk value lexicals)))
       (variable-set! (bound-variable (current-module) name src) value)))
    (($ <seq> _ head tail)
     (walk head lexicals)
     (walk tail lexicals))
    (($ <conditional> _ test consequent alternate)
     (walk (if (walk test lexicals) consequent alternate) lexicals))
    (($ <let> _ _ uniques values body)
     (walk body
           (append (map-in-order (lambda (unique value) (cons unique (walk value lexicals)))
                                 uniques values)
                   lexicals)))
    (($ <void>) *unspecified*)))

(define (mark-place! src)
  (match src
    (#(file line column) (when file (current-form-place (list file (1+ line) (1+ column)))))
    (#f #t)
    (properties
     (let ((file (assq-ref properties 'filename)))
       (when file
         (current-form-place (list file (1+ (assq-ref properties 'line))
                                   (1+ (assq-ref properties 'column)))))))))

(define (bound-variable module name src)
  (let ((variable (module-variable module name)))
    (unless (and variable (variable-bound? variable))
      (mark-place! src)
      (throw 'unbound-variable #f "Unbound variable: ~S" (list name) #f))
    variable))

(define (value-of module name src)
  (variable-ref (bound-variable module name src)))
