;; Names of files and the locale: a file is opened by exactly the bytes given, in every locale.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "file names")

(mkdir (in-folder "скала"))
(write-file "скала/лавина.scm"
            "(use-modules (timewarp))"
            "(scene #:duration 0.1)"
            "(define-scene-parameter name \"ball\" \"name of the ball\")"
            "(load \"часть.scm\")"
            "(add-body! #:name name #:shape (sphere 0.1))"
            "(simulate! #:until 0.05 #:poses \"своё.csv\")"
            "(display \"größer 岩\\n\")")
(write-file "скала/часть.scm" "(display \"part\\n\")")

(define warning
  "^timewarp: warning: ([A-Z_]+) is ([^;]+); expected a locale that is installed [^\n]+\n$")

;; LOCALE is an assignment of the shell; WARNED what the warning must name, or #f.
(define (check-names locale warned)
  (define (run-here . args)
    (shell (string-append locale " " timewarp " " (string-join args " "))))
  (define (claim text) (format #f "~a: ~a" locale text))
  (system (format #f "cd ~a && rm -f *.csv *.json */*.csv" (force folder)))
  (let ((result (run-here "скала/лавина.scm" "-D" "name=ä" "--poses=ü.csv" "--events=é.csv"
                          "--stats=ś.json" "--quiet")))
    (test-equal (claim "status 0") 0 (run-status result))
    (test-equal (claim "output is UTF-8") "part\ngrößer 岩\n" (run-output result))
    (for-each (lambda (file) (test-assert (claim file) (file-exists? (in-folder file))))
              '("ü.csv" "é.csv" "ś.json" "скала/своё.csv"))
    (test-assert (claim "-D takes any characters")
      (string-contains (read-file "ü.csv") "\n0,ä,"))
    (match warned
      (#f (test-equal (claim "no warning") "" (run-errors result)))
      ((variable value)
       (let ((m (string-match warning (run-errors result))))
         (test-equal (claim "one warning, which names the locale") warned
                     (and m (list (match:substring m 1) (match:substring m 2))))))))
  (let ((result (run-here "нет.scm")))
    (test-equal (claim "a file that is not there: status 1") 1 (run-status result))
    (test-assert (claim "its name is shown")
      (string-contains (run-errors result) "cannot read the scene нет.scm: No such file"))))

(check-names "LC_ALL=C.UTF-8" #f)
(check-names "LC_ALL=C" #f)
(check-names "LC_ALL=POSIX" #f)
(check-names "LC_ALL= LC_CTYPE= LANG=" #f)
(check-names "LC_ALL=xx_YY.UTF-8" '("LC_ALL" "xx_YY.UTF-8"))
(check-names "LC_ALL= LC_CTYPE= LANG=xx_YY" '("LANG" "xx_YY"))

;; a byte that is no UTF-8: as it is on the disk
(write-file "plain.scm" "(use-modules (timewarp))"
            "(add-body! #:shape (sphere 0.1))")
(for-each
 (lambda (locale)
   (let ((result (shell (string-append
                         "rm -rf bytes && mkdir bytes && "
                         "scene=\"$(printf 'bytes/\\374\\364\\217\\273\\274.scm')\" && "
                         "cp plain.scm \"$scene\" && "
                         locale " " timewarp " \"$scene\" --until=0.1 "
                         "--poses=\"$(printf 'bytes/\\377ü.csv')\" && LC_ALL=C ls -b bytes"))))
     (test-equal (string-append locale ": bytes that are no UTF-8, or look like our escapes")
       '("\\374\\364\\217\\273\\274.scm" "\\377\\303\\274.csv")
       (lines-of (run-output result)))))
 '("LC_ALL=C.UTF-8" "LC_ALL=C"))

(clean-up)
(test-end "file names")
