#!/bin/sh
# What `make install' puts on a machine works there, for the program and for plain guile, also after
# the whole tree has been moved; and what it needs it says.
#
# Installed with DESTDIR below the build folder: such a tree is one that was moved from its prefix.
# SPDX-License-Identifier: LGPL-3.0-or-later
if nm -D "$TIMEWARP" | grep -q __asan_init; then
  echo "built with sanitizers, without compiled modules"
  exit 77
fi

stage=$(mktemp -d "$TW_BUILDDIR/installation-test-XXXXXX") || exit 99
trap 'rm -rf "$stage"' EXIT
failures=0

# claim TEXT COMMAND...: the command must succeed
claim() {
  text=$1
  shift
  if "$@"; then
    echo "ok   $text"
  else
    echo "FAIL $text"
    failures=$((failures + 1))
  fi
}

# bare COMMAND...: without any of the paths that ./pre-inst-env sets
bare() {
  env -i PATH=/usr/bin:/bin HOME="$stage/home" GUILE_AUTO_COMPILE=0 "$@"
}

# Scheme that prints the name of the extension, if it is loaded as a shared library
mapped='(call-with-input-file "/proc/self/maps"
  (lambda (port)
    (let loop ((files (quote ())))
      (let ((line ((@ (ice-9 rdelim) read-line) port)))
        (if (eof-object? line)
            (for-each (lambda (file) (display file) (newline)) files)
            (let ((start (string-index line #\/)))
              (loop (if (and start (string-contains line "libguile-timewarp")
                             (not (member (substring line start) files)))
                        (cons (substring line start) files)
                        files))))))))'

MAKEFLAGS= make -s -C "$TW_BUILDDIR" install DESTDIR="$stage/first" >"$stage/log" 2>&1 || {
  cat "$stage/log"
  exit 1
}
program=$(cd "$stage/first" && find . -name timewarp -path '*/bin/*')
prefix=${program%/bin/timewarp}
first=$stage/first/$prefix

# check_tree PREFIX: all that is installed there
check_tree() {
  site=$(dirname "$(find "$1" -name timewarp.scm)")
  compiled=$(dirname "$(find "$1" -name timewarp.go)")
  extension=$(find "$1" -name libguile-timewarp.so)

  bare "$1/bin/timewarp" "$(find "$1" -name bouncing-ball.scm)" --until=1 --hash >"$stage/out" 2>&1
  claim "the program runs a scene" [ "$(tail -n 1 "$stage/out")" = "$hash" ]
  bare "$1/bin/timewarp" -q -c "$mapped" >"$stage/out" 2>&1
  claim "the program has the extension built in" [ ! -s "$stage/out" ]
  claim "modules elsewhere on GUILE_LOAD_PATH are not mixed with its own" \
    bare GUILE_LOAD_PATH="$stage/strange" "$1/bin/timewarp" -c '(use-modules (timewarp vectors))'

  if bare sh -c 'command -v parallel' >/dev/null; then
    rm -rf "$stage/sweep"
    bare "$1/bin/timewarp-sweep" "$(find "$1" -name bouncing-ball.scm)" --out="$stage/sweep" \
      --seed=1,2 --until=1 --hash >"$stage/out" 2>&1
    claim "a sweep runs it, by the program beside it" \
      [ "$(grep -c "\"hash\":\"$hash\"" "$stage/sweep/runs.jsonl")" = 2 ]
  fi

  bare GUILE_LOAD_PATH="$site" GUILE_LOAD_COMPILED_PATH="$compiled" "$GUILE_PROGRAM" \
    -c "(use-modules (timewarp)) (add-body! #:shape (sphere 1)) $mapped" >"$stage/out" 2>&1
  claim "plain guile loads the extension that was installed with the modules" \
    [ "$(realpath -m "$(cat "$stage/out")")" = "$(realpath -m "$extension")" ]
}

GUILE_PROGRAM=$(sed -n "s/^GUILE = //p" "$TW_BUILDDIR/Makefile")
ball=$TW_SRCDIR/scenes/gallery/bouncing-ball.scm
hash=$("$TIMEWARP" "$ball" --until=1 --hash 2>/dev/null | tail -n 1)
[ ${#hash} = 64 ] || { echo "no hash: $hash"; exit 1; }
mkdir -p "$stage/strange/timewarp"
for module in timewarp timewarp/command-line timewarp/vectors; do
  echo '(error "a strange module")' >"$stage/strange/$module.scm"
done

check_tree "$first"
cp -a "$first" "$stage/second place"
rm -rf "$stage/first"
check_tree "$stage/second place"
moved="$stage/second place"

# a program without its modules
cp "$moved/bin/timewarp" "$stage/alone"
configured=$(sed -n 's/^prefix = //p' "$TW_BUILDDIR/Makefile")
if [ ! -e "$configured/share/guile/site/3.0/timewarp.scm" ]; then
  bare "$stage/alone" --version >"$stage/out" 2>"$stage/err"
  claim "a program alone: status 1" [ $? = 1 ]
  claim "it says where it looked, and what to set" \
    grep -q 'modules are missing: .* is neither in .* nor in .*GUILE_LOAD_PATH' "$stage/err"
  claim "in one line" [ "$(wc -l <"$stage/err")" = 1 ]
fi
claim "and does with GUILE_LOAD_PATH" \
  bare GUILE_LOAD_PATH="$(dirname "$(find "$moved" -name timewarp.scm)")" "$stage/alone" --version \
  >"$stage/out"

# ---- beside the program ----

pc=$(find "$moved" -name timewarp.pc)
claim "pkg-config knows the folders, in the place where they are" \
  [ "$(eval "realpath -m $(PKG_CONFIG_PATH="$(dirname "$pc")" pkg-config --variable=guilesitedir timewarp)")" = \
    "$(dirname "$(find "$moved" -name timewarp.scm)")" ]
claim "its file is valid" env PKG_CONFIG_PATH="$(dirname "$pc")" pkg-config --validate timewarp

if [ -e "$TW_BUILDDIR/doc/timewarp.info" ]; then
  claim "the manual is there" [ -s "$moved/share/info/timewarp.info" ]
fi
for program in timewarp timewarp-sweep; do
  page=$moved/share/man/man1/$program.1
  options=$("$(dirname "$TIMEWARP")/$program" --help | sed -n 's/^  \(-.*\)/\1/p' | cut -c 1-26 |
    grep -o -- '--[a-z][a-z-]*')
  for option in $options; do
    claim "the manual page of $program has $option" \
      grep -qF "$(printf '%s' "$option" | sed 's/-/\\-/g')" "$page"
  done
  if command -v groff >/dev/null; then
    claim "groff finds nothing wrong with it" \
      [ -z "$(groff -man -ww -Tutf8 "$page" 2>&1 >/dev/null)" ]
  fi
done

# ---- what plain guile must be told ----

hint() { bare "$@" "$TW_SRCDIR/build-aux/plain-guile-hint" "$GUILE_PROGRAM" "/a b/site" /c/ccache; }
hint | grep export >"$stage/lines"
echo 'echo "$GUILE_LOAD_PATH:$GUILE_LOAD_COMPILED_PATH"' >>"$stage/lines"
claim "the lines set both paths" \
  [ "$(bare GUILE_LOAD_PATH=/old sh "$stage/lines")" = "/a b/site:/old:/c/ccache" ]
claim "and nothing is said where they are set" \
  [ -z "$(hint GUILE_LOAD_PATH="/a b/site" GUILE_LOAD_COMPILED_PATH=/c/ccache)" ]

# ---- uninstalled again ----

MAKEFLAGS= make -s -C "$TW_BUILDDIR" install install-html DESTDIR="$stage/third" >"$stage/log" 2>&1 &&
  MAKEFLAGS= make -s -C "$TW_BUILDDIR" uninstall DESTDIR="$stage/third" >>"$stage/log" 2>&1
claim "make uninstall leaves no file" [ -z "$(find "$stage/third" ! -type d)" ]
claim "and no folder of ours" [ -z "$(find "$stage/third/$prefix" -name '*timewarp*')" ]
claim "a staged installation says nothing of paths" \
  [ "$(grep -c GUILE_LOAD "$stage/log")" = 0 ]

exit $((failures > 0))
