#!/bin/sh
# The schedule never changes the answer: one hash of tests/data/hopping-boxes.scm, whose controllers
# read accelerometers, gyros, contact forces, contacts and ranges, in a heap that hops.
#
# 3 s and 4 adversary seeds of two kinds; `make check-long`: 30 seeds.
# SPDX-License-Identifier: LGPL-3.0-or-later
if [ -n "$TW_LONG_TESTS" ]; then seconds=3 seeds=30 checked=3; else seconds=3 seeds=4 checked=1; fi
scene=$TW_SRCDIR/tests/data/hopping-boxes.scm
parameters=
ahead=0.1
spread=0.02
. "$TW_SRCDIR/tests/same-hash.sh"
