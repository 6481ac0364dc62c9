#!/bin/sh
# Every source, module, scene and test is named in Makefile.am: nothing is silently left out of the
# build, the tests or the release.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
listed=$(tr -s " \\\\" "\n" <Makefile.am)
seen=0
missing=0

for file in $(find src scheme scenes tests -type f ! -name '*~' ! -name '.*' | sort); do
  seen=$((seen + 1))
  if ! printf '%s\n' "$listed" | grep -qxF "$file"; then
    echo "$file is not in Makefile.am"
    missing=$((missing + 1))
  fi
done

echo "$seen files, $missing missing"
[ "$seen" -gt 0 ] && [ "$missing" = 0 ]
