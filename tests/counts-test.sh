#!/bin/sh
# No cost has risen unseen: instructions of a few short runs against tests/data/counts.csv.
# SPDX-License-Identifier: LGPL-3.0-or-later
exec sh "$TW_SRCDIR/tests/bench/counts.sh" --quick
