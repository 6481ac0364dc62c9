;; Command lines by tables of options: reading what they say, and the help that is made from them.
;;
;; A row is (KEY NAMES ARGUMENT CONVERT HELP).  NAMES are characters and strings; ARGUMENT is a word
;; for --help, #f for none, (WORD) for an optional one; CONVERT makes a value of the long name and
;; the text, or throws `timewarp-usage' with a message; HELP is #f for what --help leaves out.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp option-table)
  #:use-module (srfi srfi-1)
  #:use-module (srfi srfi-37)
  #:use-module (ice-9 format)
  #:use-module (ice-9 match)
  #:export (usage-error
            ;; values
            ->number seconds positive natural positive-integer text optional-text text->size
            ;; rows and tables
            row-key row-long-name row-convert
            parse-options option-ref option-values
            rows-help documented-rows))

(define (usage-error message . args)
  "Say that the command line is wrong."
  (throw 'timewarp-usage (apply format #f message args)))

;; ---- values ----

(define (->number name text valid? expected)
  (let ((number (string->number text)))
    (unless (and number (real? number) (not (nan? number)) (not (inf? number)) (valid? number))
      (usage-error "--~a is ~s; expected ~a" name text expected))
    number))

(define (seconds name text)
  (->number name text (lambda (x) (>= x 0)) "a number of seconds, not negative"))
(define (positive name text)
  (->number name text positive? "a positive number"))
(define (natural name text)
  (->number name text (lambda (x) (and (exact-integer? x) (>= x 0))) "an integer, not negative"))
(define (positive-integer name text)
  (->number name text (lambda (x) (and (exact-integer? x) (> x 0))) "a positive integer"))
(define (text name text)
  (when (string-null? text) (usage-error "--~a is empty; expected a name" name))
  text)

(define (text->size text)
  "Return (WIDTH HEIGHT) of \"WIDTHxHEIGHT\", #f of another text."
  (match (map string->number (string-split text #\x))
    (((? exact-integer? width) (? exact-integer? height)) (list width height))
    (_ #f)))

(define (optional-text name text*)
  (if text* (text name text*) #t))

;; ---- rows ----

(define row-key first)
(define row-convert fourth)
(define (row-long-name row) (long-name (second row)))
(define (long-name names) (or (find string? names) (string (car names))))

;; ---- parsing ----

(define (row->option row)
  (match row
    ((key names argument convert _)
     (option names (string? argument) (pair? argument)
             (lambda (option name value result)
               (acons key
                      (if (and convert (or value (not (string? argument))))
                          (convert (long-name names) value)
                          (or value #t))
                      result))))))

;; SRFI-37 wants --name=value; --name value is as usual elsewhere
(define (join-long-options table args)
  (define (needing style)
    (append-map (match-lambda
                  ((_ names (? string?) . _) (filter-map style names))
                  (_ '()))
                table))
  (define long (needing (lambda (name) (and (string? name) (string-append "--" name)))))
  (define short (needing (lambda (name) (and (char? name) (string #\- name)))))
  (let loop ((args args))
    (match args
      (() '())
      (("--" . rest) args)
      ((arg . rest)
       (cond ((and (member arg long) (pair? rest))
              (cons (string-append arg "=" (car rest)) (loop (cdr rest))))
             ((member arg long) (usage-error "~a has no value; expected one" arg))
             ;; their argument is not an option, whatever it looks like
             ((and (member arg short) (pair? rest)) (cons* arg (car rest) (loop (cdr rest))))
             (else (cons arg (loop rest))))))))

(define (parse-options table args)
  "Return an alist of the options that ARGS give, in their order; operands have the key `operand'."
  (catch 'misc-error
    (lambda ()
      (reverse
       (args-fold (join-long-options table args) (map row->option table)
                  (lambda (option name value result)
                    (usage-error "unknown option ~a; see --help"
                                 (if (char? name) (string #\- name) (string-append "--" name))))
                  (lambda (operand result) (acons 'operand operand result))
                  '())))
    (lambda (key who message args . _)
      (usage-error "~?" message args))))

(define (option-ref options key)
  "Return the value of the option KEY, #f where it is not given; of several the last one holds."
  (fold (lambda (pair value) (if (eq? (car pair) key) (cdr pair) value)) #f options))

(define (option-values options key)
  "Return all values of the option KEY, in their order."
  (filter-map (lambda (pair) (and (eq? (car pair) key) (cdr pair))) options))

;; ---- help ----

(define (names-text names argument)
  (string-append
   (string-join (map (lambda (name)
                       (if (char? name) (string #\- name) (string-append "--" name)))
                     names)
                ", ")
   (match argument
     (#f "")
     ((word) (string-append "[=" word "]"))
     (word (string-append (if (any string? names) "=" " ") word)))))

(define (documented-rows table)
  "Return (NAMES ARGUMENT HELP) of each row of TABLE but those that --help leaves out."
  (filter-map (match-lambda
                ((_ names argument _ help) (and help (list names argument help))))
              table))

(define (rows-help table)
  "Return the text of --help that lists the options of TABLE."
  (string-concatenate
   (map (match-lambda
          ((names argument help)
           (let ((left (names-text names argument)))
             (if (< (string-length left) 26)
                 (format #f "  ~a  ~a\n" (string-pad-right left 26) help)
                 (format #f "  ~a\n~a~a\n" left (make-string 30 #\space) help)))))
        (documented-rows table))))
