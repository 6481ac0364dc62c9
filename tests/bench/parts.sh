#!/bin/sh
# Runs commands one after the other, says which is running and how long each took, goes on after one
# that fails, and fails at the end if any did.
#
#   parts.sh COMMAND...     each one argument, for sh -c
#
# SPDX-License-Identifier: LGPL-3.0-or-later
number=0 failed=
begin=$(date +%s)
for part; do
  number=$((number + 1))
  start=$(date +%s)
  echo "== $number of $#: $part"
  if sh -c "$part"; then
    echo "-- took $(($(date +%s) - start)) s, $(($(date +%s) - begin)) s in all"
  else
    echo "-- FAILED after $(($(date +%s) - start)) s"
    failed="$failed
  $part"
  fi
  echo
done
if [ -n "$failed" ]; then
  echo "parts that failed:$failed" >&2
  exit 1
fi
