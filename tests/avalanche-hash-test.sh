#!/bin/sh
# The schedule never changes the answer: one hash of scenes/avalanche.scm, contact groups and all.
#
# 40 rocks for 3 s and 3 adversary seeds of two kinds; `make check-long`: all rocks, 5 s, 2 seeds (an hour).
# SPDX-License-Identifier: LGPL-3.0-or-later
scene=$TW_SRCDIR/scenes/avalanche.scm
if [ -n "$TW_LONG_TESTS" ]; then
  parameters= seconds=5 seeds=2 checked=0.6
else
  parameters="-D rocks=40" seconds=3 seeds=3 checked=1
fi
ahead=0.1
spread=0.02
. "$TW_SRCDIR/tests/same-hash.sh"
