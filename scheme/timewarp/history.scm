;; What was typed at the prompt, kept from one session to the next.
;;
;; The file has an expression a line, written as a string, so that one of several lines comes back as
;; it was typed.  Each is appended when it is read: nothing is lost when a session dies, and sessions
;; side by side keep each other's.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp history)
  #:use-module (ice-9 match)
  #:use-module (ice-9 textual-ports)
  #:use-module (srfi srfi-1)
  #:export (state-folder
            history-file
            most-entries
            make-folders
            read-history-entries
            append-history-entry!))

;; As the XDG base directory specification has it.
(define (state-folder)
  "Return the user's folder for what programs keep between sessions, with timewarp's name."
  (match (getenv "XDG_STATE_HOME")
    ((? string? (? absolute-file-name? folder)) (string-append folder "/timewarp"))
    (_ (string-append (or (getenv "HOME") ".") "/.local/state/timewarp"))))

(define (history-file)
  "Return the name of the file of the history."
  (string-append (state-folder) "/history"))

;; kept when a session begins; the file is cut when it has half as many more
(define most-entries 2000)

(define (read-history-entries file)
  "Return what FILE keeps, oldest first; nothing where it can't be read.  A long file is cut."
  (let* ((entries (or (false-if-exception (call-with-input-file file entries-of #:encoding "UTF-8"))
                      '()))
         (count (length entries)))
    (if (<= count most-entries)
        entries
        (let ((kept (drop entries (- count most-entries))))
          (when (> (* 2 count) (* 3 most-entries))
            (false-if-exception (rewrite file kept)))
          kept))))

;; A line that is no string was not written by us, or not to its end: it is left out.
(define (entries-of port)
  (let loop ((entries '()))
    (match (get-line port)
      ((? eof-object?) (reverse entries))
      (line
       (match (false-if-exception (call-with-input-string line read))
         ((? string? entry) (loop (cons entry entries)))
         (_ (loop entries)))))))

;; One line: `write' leaves newlines in strings as they are.
(define (put-entry entry port)
  (let ((text (call-with-output-string (lambda (port) (write entry port)))))
    (put-string port (string-join (string-split text #\newline) "\\n"))
    (newline port)))

(define (rewrite file entries)
  (let ((new (format #f "~a.~a" file (getpid))))
    (call-with-private-file new "w"
      (lambda (port) (for-each (lambda (entry) (put-entry entry port)) entries)))
    (rename-file new file)))

;; Only the user may read it: what is typed may be private.
(define (call-with-private-file file mode proc)
  (let* ((outer (umask #o077))
         (port (dynamic-wind
                 (const #t)
                 (lambda () (open-file file mode #:encoding "UTF-8"))
                 (lambda () (umask outer)))))
    (proc port)
    (close-port port)))

(define (append-history-entry! file entry)
  "Add ENTRY to FILE, which is made, with its folders, where it is missing.  A failure is not told:
no session fails over its history."
  (false-if-exception
   (begin
     (make-folders (dirname file))
     (call-with-private-file file "a" (lambda (port) (put-entry entry port))))))

(define (make-folders folder)
  "Make FOLDER, and the folders that it is in, where they are missing; only the user may enter."
  (unless (file-exists? folder)
    (make-folders (dirname folder))
    (mkdir folder #o700)))
