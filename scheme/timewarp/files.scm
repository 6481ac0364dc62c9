;; File names in scenes are relative to the scene's file.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp files)
  #:use-module (timewarp errors)
  #:use-module (ice-9 format)
  #:export (current-scene-directory scene-file beside-caller current-file-reader note-file-read
            tell-mended))

;; The folder of the scene that is being loaded, or #f: the current folder.
(define current-scene-directory (make-parameter #f))

(define (scene-file name)
  "Return NAME relative to the folder of the scene that is being loaded."
  (unless (string? name) (bad-value "the file name" name "a string"))
  (if (or (absolute-file-name? name) (not (current-scene-directory)))
      name
      (in-vicinity (current-scene-directory) name)))

(define (beside-caller file place)
  "Return FILE beside the file of PLACE, or, where there is none of that name, in the folder of the
scene that is being loaded, or in the current one."
  (if (or (not (string? file)) (absolute-file-name? file))
      file
      (let ((beside (and place (string? (car place)) (in-vicinity (dirname (car place)) file)))
            (in-scene (scene-file file)))
        (cond ((and beside (file-exists? beside)) beside)
              ((file-exists? in-scene) in-scene)
              (else file)))))

;; A procedure that is told of each file that is read for a scene, but by Guile's `load'.
(define current-file-reader (make-parameter (const #f)))

(define (note-file-read file)
  "Tell that FILE is read for the scene."
  ((current-file-reader) file))

(define (tell-mended notes)
  "Warn of what was wrong in a file, and of what is taken instead: NOTES, strings."
  (for-each (lambda (note) (format (current-warning-port) "timewarp: warning: ~a~%" note)) notes))
