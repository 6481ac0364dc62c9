#!/bin/sh
# Where results are from, as the first lines of their files: machine, date, commit.
#
#   this-run.sh SOURCE
#
# SPDX-License-Identifier: LGPL-3.0-or-later
processor=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
echo "# machine: $(getconf _NPROCESSORS_ONLN) cores, ${processor:-$(uname -m)}"
echo "# date: $(date +%Y-%m-%d)"
commit=$(git -C "$1" rev-parse --short=8 HEAD 2>/dev/null) || exit 0
[ -z "$(git -C "$1" status --porcelain --untracked-files=no)" ] || commit="$commit, with changes"
echo "# commit: $commit"
