#!/bin/sh
# The schedule never changes the answer: one hash of scenes/robots.scm, shrunk to two arms, which
# pick up a box each, hold it and throw it.
#
# 3 s and 2 adversary seeds of two kinds; `make check-long`: 10 s and 20 seeds.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=10 seeds=20 checked=0.5; else seconds=3 seeds=2 checked=1.5; fi
scene=$TW_SRCDIR/scenes/robots.scm
parameters="-D robots=2"
ahead=0.1
spread=0.02
. "$TW_SRCDIR/tests/same-hash.sh"
