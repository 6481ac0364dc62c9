#!/bin/sh
# The schedule never changes the answer: one hash of scenes/atoms.scm.
#
# 2 s of atoms and 4 adversary seeds of two kinds; `make check-long`: 10 s and 50 seeds.  The divider moves
# within the run.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=10 seeds=50 checked=1; else seconds=2 seeds=4 checked=0.2; fi
scene=$TW_SRCDIR/scenes/atoms.scm
parameters="-D compress-at=0.5"
ahead=1
spread=0.5
. "$TW_SRCDIR/tests/same-hash.sh"
