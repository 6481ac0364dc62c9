#!/bin/sh
# A run without drawing never maps OSMesa or LLVM: neither the program nor the extension is linked to
# them, as far as the whole list of libraries goes.
# The extension exports its entry only.
# SPDX-License-Identifier: LGPL-3.0-or-later
failures=0
for file in "$TW_BUILDDIR/timewarp" "$TW_BUILDDIR/.libs/libguile-timewarp.so"; do
  libraries=$(ldd "$file") || exit 99
  printf '%s\n' "$libraries" | grep -q 'libguile-3' || { echo "$file: no libguile?"; exit 99; }
  if printf '%s\n' "$libraries" | grep -E 'OSMesa|LLVM|libGL|libEGL'; then
    echo "$file is linked to the libraries above"
    failures=1
  fi
done

# one symbol of ours is seen from outside, so that nothing of ours can hide a symbol of others
symbols=$(nm -D --defined-only "$TW_BUILDDIR/.libs/libguile-timewarp.so" | sed 's/.* //')
if [ "$symbols" != tw_init_guile ]; then
  echo "the extension exports: $symbols"
  failures=1
fi
exit $failures
