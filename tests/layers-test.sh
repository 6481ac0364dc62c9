#!/bin/sh
# A folder under src/ includes only itself and folders listed above it; main.cc may include any.
# Above the binding nobody knows Guile; outside the drawing nobody knows OpenGL.  No two types of a
# namespace have one name.
# SPDX-License-Identifier: LGPL-3.0-or-later
cd "${TW_SRCDIR:-.}" || exit 99
layers='base math geometry collision dynamics multibody integrate timeline detect groups kernel import record render script'
failures=0

complain() {
  echo "$1"
  failures=$((failures + 1))
}

# each folder of src/ has its place in the list, and each of the list exists
for folder in src/*/; do
  name=$(basename "$folder")
  case " $layers " in
    *" $name "*) ;;
    *) complain "src/$name is not in the list of layers" ;;
  esac
done

# "FILE:LINE:#include "FOLDER/..." with a folder further down the list, or a file that isn't there
above=''
checked=0
for layer in $layers; do
  above="$above $layer"
  [ -d "src/$layer" ] || complain "src/$layer is missing"
  includes=$(grep -rnE '^ *# *include *"' "src/$layer" --include='*.h' --include='*.cc')
  while IFS= read -r include; do
    [ -n "$include" ] || continue
    checked=$((checked + 1))
    header=${include#*\"}
    header=${header%%\"*}
    case " $above " in
      *" ${header%%/*} "*) ;;
      *) complain "$include: src/$layer may not include ${header%%/*}/" ;;
    esac
    [ -e "src/$header" ] || complain "$include: there is no src/$header"
  done <<END
$includes
END
done

guile=$(grep -rlE '# *include *<(libguile|gc/)' src | grep -vE '^src/(script/|main\.cc$)')
[ -z "$guile" ] || complain "Guile outside src/script: $guile"
opengl=$(grep -rlE '# *include *<(GL|EGL|png)' src | grep -v '^src/render/')
[ -z "$opengl" ] || complain "OpenGL or libpng outside src/render: $opengl"

# one type, one name: two in a namespace would be one to the linker
twice=$(find src -name '*.h' -exec awk '
  FNR == 1 { space = "" }
  /^namespace [a-z:]+ \{/ { space = $2 }
  /^(struct|class|enum class|union) [A-Za-z]+( final)?( :.*)? \{/ {
    name = $1 == "enum" ? $3 : $2
    print space "::" name, FILENAME }' {} + | sort |
  awk '$1 == last { print $1 " is defined in " file " and in " $2 } { last = $1; file = $2 }')
[ -z "$twice" ] || complain "$twice"

echo "$checked includes checked, $failures wrong"
[ "$checked" -gt 0 ] && [ "$failures" = 0 ]
