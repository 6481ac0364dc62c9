;; Warnings, when a scene is loaded, of callbacks that change what no rollback undoes.
;;
;; A callback may run again, so what it keeps belongs into slots.  Forms are looked at as the expander
;; leaves them: the procedures that are handed to add-callback!, on-collision!, add-force! and
;; #:motion, written there or defined before, and what these call by name.  Found are `set!' of a
;; variable that is not their own, the usual procedures that change a table, list, vector or string
;; held by one, those that draw from a random state that is not made on the spot, and those that
;; print.  What hides deeper shows under --check, when it happens ((timewarp purity)).
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp effects)
  #:use-module (language tree-il)
  #:use-module (ice-9 match)
  #:use-module (srfi srfi-1)
  #:export (look-for-effects!))

(define takers '(add-callback! on-collision! add-force!))

(define mutators
  '(hash-set! hashq-set! hashv-set! hash-remove! hashq-remove! hashv-remove! hash-clear!
    hash-create-handle! hashq-create-handle! hashv-create-handle! vector-set! vector-fill! set-car!
    set-cdr! array-set! array-fill! string-set! string-fill! f64vector-set! f32vector-set!
    s32vector-set! u32vector-set! u8vector-set! bytevector-u8-set! enq! deq! q-push! q-pop!))

;; What draws from a random state, with the place of that among its arguments.
(define draws
  '((random . 1) (random:uniform . 0) (random:normal . 0) (random:exp . 0) (random:hollow-sphere! . 1)
    (random:solid-sphere! . 1) (random:normal-vector! . 1)))

(define printers '(display write newline write-line pk write-string simple-format))

;; ---- procedures that a scene has defined ----

;; module -> (name -> <lambda>)
(define definitions (make-weak-key-hash-table))

(define (definitions-here)
  (let ((module (current-module)))
    (or (hashq-ref definitions module)
        (hashq-set! definitions module (make-hash-table)))))

(define (definition name) (hashq-ref (definitions-here) name))

(define (note-definition! x)
  (match x
    (($ <toplevel-define> _ _ name value)
     (match value
       (($ <lambda>) (hashq-set! (definitions-here) name value))
       (_ (hashq-remove! (definitions-here) name))))
    (_ #f)))

;; ---- what a procedure changes ----

(define (for-each-part proc tree)
  (tree-il-fold (lambda (x _) (proc x) #f) (lambda (x _) #f) #f tree))

;; The unique names of the variables that are bound within TREE.
(define (own-variables tree)
  (let ((own (make-hash-table)))
    (define (add! names) (for-each (lambda (name) (hashq-set! own name #t)) names))
    (for-each-part (match-lambda
                     (($ <lambda-case> _ _ _ _ _ _ names) (add! names))
                     (($ <let> _ _ names) (add! names))
                     (($ <letrec> _ _ _ names) (add! names))
                     (($ <fix> _ _ names) (add! names))
                     (_ #f))
                   tree)
    own))

;; The place of SOURCE as (FILE LINE COLUMN), or #f.
(define (source-place source)
  (match source
    (#(file line column) (list file (1+ line) (1+ column)))
    ((? pair? properties)
     (list (assq-ref properties 'filename) (1+ (assq-ref properties 'line))
           (1+ (assq-ref properties 'column))))
    (_ #f)))

;; What PROCEDURE, a <lambda>, changes: ((NAME PLACE WHAT) ...), with what it calls but SEEN.
(define (effects procedure seen)
  (let ((own (own-variables procedure)) (found '()))
    (define (found! name source what)
      (set! found (cons (list name (source-place source) what) found)))
    (define (foreign? name) (not (hashq-ref own name)))
    (for-each-part
     (match-lambda
       (($ <toplevel-set> source _ name) (found! name source 'sets))
       (($ <module-set> source _ name) (found! name source 'sets))
       (($ <lexical-set> source name unique) (when (foreign? unique) (found! name source 'sets)))
       (($ <call> source ($ <toplevel-ref> _ _ called) arguments)
        (match arguments
          ((($ <toplevel-ref> _ _ name) . _)
           (when (memq called mutators) (found! name source 'changes)))
          ((($ <lexical-ref> _ name unique) . _)
           (when (and (memq called mutators) (foreign? unique)) (found! name source 'changes)))
          (_ #f))
        (when (draws? called arguments own) (found! called source 'draws))
        (when (prints? called arguments) (found! called source 'prints))
        (let ((callee (definition called)))
          (when (and callee (not (memq callee seen)))
            (set! found (append (effects callee (cons callee seen)) found)))))
       (_ #f))
     procedure)
    (reverse found)))

;; Whether a call draws from Guile's random state, or from one that was there before.
(define (draws? called arguments own)
  (match (assq called draws)
    ((_ . place)
     (match (drop arguments (min place (length arguments)))
       (() #t)
       ((($ <toplevel-ref>) . _) #t)
       ((($ <lexical-ref> _ _ unique) . _) (not (hashq-ref own unique)))
       (_ #f)))
    (#f #f)))

(define (prints? called arguments)
  (or (and (memq called printers) #t)
      (and (eq? called 'format)
           (match arguments
             ((($ <const> _ #f) . _) #f)
             ((_ . _) #t)
             (() #f)))))

;; ---- warnings ----

;; of places that have been told
(define told (make-hash-table))

(define (warn! taker name place what)
  (unless (or (not place) (hash-ref told place))
    (hash-set! told place #t)
    (let ((port (current-warning-port)))
      (match place
        ((file line column)
         (format port "~a:~a:~a: warning: " (or file "prompt") line column)))
      (format port "what is handed to ~a ~a ~a, which a rollback does not undo; expected it to ~a~%"
              taker
              (match what
                ('sets "sets the variable")
                ('changes "changes what is in")
                ('draws "draws from a random state by")
                ('prints "prints by"))
              name
              (cond ((string-prefix? "#:" taker) "depend on the time alone")
                    ((string=? taker "add-force!") "depend on what it is handed alone")
                    ((eq? what 'draws)
                     "draw by (random-real! view), whose state is part of the body")
                    (else "change only what it is handed: a slot keeps values, an observer runs once")))
      (force-output port))))

;; The outermost procedures in ARGUMENT.
(define (procedures-in argument)
  (match argument
    (($ <lambda>) (list argument))
    (($ <toplevel-ref> _ _ name) (let ((known (definition name))) (if known (list known) '())))
    (($ <let> _ _ _ _ body) (procedures-in body))
    (($ <letrec> _ _ _ _ _ body) (procedures-in body))
    (($ <fix> _ _ _ _ body) (procedures-in body))
    (($ <seq> _ _ tail) (procedures-in tail))
    (_ '())))

(define (look-at! taker argument)
  (for-each (lambda (procedure)
              (for-each (match-lambda ((name place what) (warn! taker name place what)))
                        (effects procedure (list procedure))))
            (procedures-in argument)))

(define (look-at-call! x)
  (match x
    (($ <call> _ (or ($ <toplevel-ref> _ _ name) ($ <module-ref> _ _ name)) arguments)
     (when (memq name takers)
       (for-each (lambda (argument) (look-at! (symbol->string name) argument)) arguments))
     (match (find-tail (match-lambda (($ <const> _ #:motion) #t) (_ #f)) arguments)
       ((_ motion . _) (look-at! "#:motion" motion))
       (_ #f)))
    (_ #f)))

(define (look-for-effects! form simple?)
  "Warn of callbacks in FORM, expanded, that change what no rollback undoes, and remember what it
defines.  SIMPLE?: it has no procedures within; then only the call that it is itself is looked at, for
scenes may have a hundred thousand such forms."
  (if simple?
      (begin
        (note-definition! form)
        (look-at-call! form))
      (begin
        (for-each-part note-definition! form)
        (for-each-part look-at-call! form))))
