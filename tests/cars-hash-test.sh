#!/bin/sh
# The schedule never changes the answer: one hash of scenes/cars.scm, shrunk to two cars among eight
# pendulums, which they strike.
#
# 2.5 s and 2 adversary seeds of two kinds; `make check-long`: 10 s and 20 seeds.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=10 seeds=20 checked=0.5; else seconds=2.5 seeds=2 checked=0.1; fi
scene=$TW_SRCDIR/scenes/cars.scm
parameters="-D rows=2 -D columns=4 -D cars=2"
ahead=0.3
spread=0.05
. "$TW_SRCDIR/tests/same-hash.sh"
