#!/bin/sh
# The schedule never changes the answer: one hash of tests/data/integral-arm.scm, whose controller
# keeps an integral in a slot, attaches a box and lets go of it, while balls strike the arm.
#
# 3.3 s and 2 adversary seeds of two kinds; `make check-long`: 4 s and 20 seeds.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=4 seeds=20 checked=2; else seconds=3.3 seeds=2 checked=1; fi
scene=$TW_SRCDIR/tests/data/integral-arm.scm
parameters=
ahead=0.1
spread=0.02
. "$TW_SRCDIR/tests/same-hash.sh"
