#!/bin/sh
# A session at the prompt, through a terminal: history kept from one session to the next, completion,
# Ctrl-C in runs, callbacks and loops, errors in callbacks; then a run whose hash is that of a session
# in which nothing of this happened.
# SPDX-License-Identifier: LGPL-3.0-or-later
command -v expect >/dev/null || { echo "expect is not installed"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 99
cat >clock.scm <<'END_OF_SCENE'
;; A ball that bounces for ever, with a callback that does what `mood' says.
(use-modules (timewarp) (timewarp primitives))
(define mood 'calm)
(%set-world! (current-world) 'hash #t)
(add-body! #:name "floor" #:shape (half-space #(0 0 1) 0) #:fixed? #t)
(set-contact-parameters! #t #t #:restitution 1)
(define ball (add-body! #:name "red ball" #:shape (sphere 0.1) #:position #(0 0 1)
                        #:slots '((ticks . 0))))
(add-callback! ball
  (lambda (time ball)
    (case mood
      ((angry) (car time))
      ((lost) (let loop () (loop))))
    (set! (slot ball 'ticks) (1+ (slot ball 'ticks))))
  #:period 0.1)
(define (hash) (%history-hash (current-world)))
END_OF_SCENE
HOME=$folder XDG_STATE_HOME=$folder/state TERM=dumb expect -f "$TW_SRCDIR/tests/scheme/session.exp"
