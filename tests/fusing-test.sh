#!/bin/sh
# No object fuses multiplications and additions but those that do so by intent, in their source.
#
# What a compiler fuses by itself changes with the code around it, and with it the last bits of results: a refactoring
# would change hashes.  Fused by intent: block-lu.cc (intrinsics), free-rotation.cc and jacobi-theta.cc (std::fma).
# SPDX-License-Identifier: LGPL-3.0-or-later
case $(uname -m) in
  x86_64) ;;
  *) echo "fusing-test: knows the instructions of x86-64 only"; exit 77 ;;
esac
command -v objdump >/dev/null || { echo "fusing-test: objdump (binutils) is missing"; exit 77; }

cd "$TW_BUILDDIR" || exit 1
# units of tests are no library objects: they are not below .libs
objects=$(find src unity -name '*.o' -path '*/.libs/*' 2>/dev/null | sort)
[ -n "$objects" ] || { echo "no objects below $TW_BUILDDIR"; exit 1; }
failures=0
for object in $objects; do
  case $object in
    *block-lu.o | *free-rotation.o | *jacobi-theta.o) continue ;;
  esac
  fused=$(objdump -d --no-show-raw-insn "$object" | grep -oE 'vfn?m(add|sub)[0-9a-z]*' | sort | uniq -c)
  if [ -n "$fused" ]; then
    echo "$object fuses:"
    echo "$fused"
    failures=$((failures + 1))
  fi
done
exit $((failures > 0))
