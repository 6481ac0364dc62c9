#!/bin/sh
# The same bits as ever: short runs of seven scenes against the hashes in tests/data/golden-hashes.txt, which
# stand there by instruction set (-march): block-lu.cc fuses, by intent, where there is an instruction for it,
# so groups whose matrices are sparse differ.  A change of hashes is meant, and a commit of its own:
#
#   TW_SRCDIR=.. TW_BUILT_FOR=-march=x86-64-v3 ./pre-inst-env ../tests/golden-hashes-test.sh --print
#
# prints the lines of this build.
# SPDX-License-Identifier: LGPL-3.0-or-later
table=$TW_SRCDIR/tests/data/golden-hashes.txt
arch=${TW_BUILT_FOR##*-march=}
arch=${arch%% *}
failures=0
known=0

while read -r for_arch scene seconds expected; do
  case $for_arch in '#'* | '') continue ;; esac
  # any one block names the scenes
  if [ "$1" = --print ]; then
    [ "$for_arch" = x86-64-v3 ] || continue
  else
    [ "$for_arch" = "$arch" ] || continue
  fi
  known=1
  found=$("$TIMEWARP" "$TW_SRCDIR/scenes/$scene" --until="$seconds" --hash --quiet </dev/null 2>/dev/null | tail -n 1)
  if [ "$1" = --print ]; then
    echo "$arch $scene $seconds $found"
  elif [ "$found" = "$expected" ]; then
    echo "ok   $scene to $seconds s"
  else
    echo "FAIL $scene to $seconds s: $found, expected $expected"
    failures=$((failures + 1))
  fi
done <"$table"

if [ $known = 0 ]; then
  echo "no hashes are known for -march=${arch:-(none)}"
  exit 77
fi
if [ $failures -gt 0 ]; then
  echo "$failures of the hashes in $table differ.  They are those of gcc 12, glibc 2.36 and Eigen 3.4; if the"
  echo "change is meant, put in what --print gives"
  exit 1
fi
