;; The primitives of the C++ side: private, named %thing, exported by the extension itself.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp primitives))

(eval-when (expand load eval)
  (load-extension "libguile-timewarp" "tw_init_guile")
  (export %interrupt!))
