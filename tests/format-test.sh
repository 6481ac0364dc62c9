#!/bin/sh
# Every C++ file is as clang-format leaves it (.clang-format: one width for all folders), and no line
# is wider than 100 columns.  Other versions of clang-format break lines elsewhere: skipped there.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
expected=14
clang_format=$(command -v clang-format-$expected || command -v clang-format)
if [ -z "$clang_format" ]; then
  echo "skipped: clang-format $expected is not installed (Debian 12: apt-get install clang-format)"
  exit 77
fi
case $("$clang_format" --version) in
  *" version $expected."*) ;;
  *) echo "skipped: expected clang-format $expected, found $("$clang_format" --version)"; exit 77 ;;
esac
[ -e .clang-format ] || { echo "skipped: .clang-format is not beside the sources"; exit 77; }

files=$(find src tests build-aux -name '*.h' -o -name '*.cc' | sort)
wrong=$("$clang_format" --dry-run $files 2>&1 | grep -o '^[^: ]*\.\(h\|cc\):[0-9]*' | sort -u)
[ -z "$wrong" ] || printf '%s\nexpected as by %s -i FILE\n' "$wrong" "$clang_format"
wide=$(awk 'length > 100 { print FILENAME ":" FNR ": wider than 100 columns" }' $files)
[ -z "$wide" ] || echo "$wide"
set -- $files
echo "$# files checked"
[ $# -gt 0 ] && [ -z "$wrong$wide" ]
