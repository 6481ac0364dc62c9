#!/bin/sh
# Pages have no prose wider than 100 columns (tables, code and pictures may be), and the table of
# known faults is the one that is tested.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
set -- README.md NEWS.md HACKING.md doc/*.md
wide=$(awk '
  FNR == 1 { code = 0 }
  /^```/ { code = !code }
  code || /^(\||!\[|    |---)/ { next }
  length > 100 { print FILENAME ":" FNR ": wider than 100 columns" }' "$@")
[ -z "$wide" ] || echo "$wide"
echo "$# pages checked"
[ -z "$wide" ] && TW_SRCDIR=. sh build-aux/known-faults
