#!/bin/sh
# The REPL through a terminal: what a user types and sees, Ctrl-C, Ctrl-D and exit included.
# SPDX-License-Identifier: LGPL-3.0-or-later
command -v expect >/dev/null || { echo "expect is not installed"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 99
cat >good.scm <<'END'
(use-modules (timewarp))
(add-body! #:name "good" #:shape (sphere 0.1) #:position #(0 0 1))
END
cat >wrong.scm <<'END'
(use-modules (timewarp))
(add-body! #:name "bad" #:shape (sphere 1))
(define (make n)
  (+ 1 (car (list (shape-volume (sphere (- n 6)))))))
(list (make 5) 6)
END
HOME=$folder TERM=dumb expect -f "$TW_SRCDIR/tests/scheme/repl.exp"
