;;; (load-apart FILE): FILE as a scene in a module of its own, for it may use any name.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define (load-apart file)
  (save-module-excursion
   (lambda ()
     (let ((module (make-fresh-user-module)))
       (module-use! module (resolve-interface '(timewarp)))
       (set-current-module module))
     (load-scene file))))
