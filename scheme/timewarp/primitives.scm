;; The primitives of the C++ side: private, named %thing, exported by the extension itself.
;;
;; The program has the extension built in.  Plain Guile loads the one that was installed with these
;; modules, wherever the whole tree has been moved; where they are not installed, the one that it
;; finds on its search path (GUILE_EXTENSIONS_PATH).
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp primitives)
  #:use-module (timewarp config))

(eval-when (expand load eval)
  (define (extension-file)
    (let* ((name "libguile-timewarp")
           (here (%search-load-path "timewarp.scm"))
           (file (and here (string-append (dirname here) "/" extension-folder "/" name))))
      (if (and file (file-exists? (string-append file ".so"))) file name)))

  (load-extension (extension-file) "tw_init_guile"))
