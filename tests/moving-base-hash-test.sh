#!/bin/sh
# The schedule never changes the answer: one hash of tests/data/moving-base.scm, where multibodies
# hang on bodies that move as they were told, with jumps and kinks, and strike others.
#
# 4 s and 8 adversary seeds of two kinds; `make check-long`: 4 s and 60 seeds.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=4 seeds=60 checked=4; else seconds=4 seeds=8 checked=2; fi
scene=$TW_SRCDIR/tests/data/moving-base.scm
parameters=
ahead=0.1
spread=0.02
. "$TW_SRCDIR/tests/same-hash.sh"
