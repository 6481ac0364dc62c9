#!/bin/sh
# Pages have no prose wider than 100 columns (tables, code and pictures may be), each reason for the
# end of an arc has its row, and tables of known faults and of results are those that are tested and
# measured.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
set -- README.md NEWS.md HACKING.md doc/*.md doc/numerics/*.md
wide=$(awk '
  FNR == 1 { code = 0 }
  /^```/ { code = !code }
  code || /^(\||!\[|    |---|<!--)/ { next }
  length > 100 { print FILENAME ":" FNR ": wider than 100 columns" }' "$@")
[ -z "$wide" ] || echo "$wide"
echo "$# pages checked"
# each reason for which an arc may end is told
untold=$(sed -n '/end_names{/,/};/p' src/integrate/arc/arc-end.h | grep -o '"[a-z]*"' | tr -d '"' |
  while read -r reason; do
    grep -q "^|.*\`$reason\`" doc/architecture.md || echo "doc/architecture.md: no row of $reason"
    [ "$reason" = rest ] || grep -q "arcs_ended_$reason\`" doc/statistics.md || echo "doc/statistics.md: no $reason"
  done)
[ -z "$untold" ] || echo "$untold"
[ -z "$wide$untold" ] && TW_SRCDIR=. sh build-aux/known-faults && TW_SRCDIR=. sh build-aux/bench-tables
