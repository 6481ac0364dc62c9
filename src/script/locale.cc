// The locale of the program.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/locale.h"

#include <langinfo.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace tw {

namespace {

// The variable that decides on a category, as POSIX orders them; null where none is set.
const char* deciding_variable(const char* category) {
  for (const char* variable : {"LC_ALL", category, "LANG"}) {
    const char* value = std::getenv(variable);
    if (value && *value) return variable;
  }
  return nullptr;
}

void warn_of_missing(const char* category) {
  const char* variable = deciding_variable(category);
  if (!variable) return;
  std::fprintf(
      stderr,
      "timewarp: warning: %s is %s; expected a locale that is installed (`locale -a` lists "
      "them); going on without it\n",
      variable, std::getenv(variable));
}

// One missing category makes setlocale install none, so each is tried by itself; the first that
// fails is told.
void install_each() {
  struct Category {
    int number;
    const char* name;
  };
  bool warned = false;
  for (const auto& [number, name] :
       {Category{LC_CTYPE, "LC_CTYPE"}, Category{LC_COLLATE, "LC_COLLATE"},
        Category{LC_MESSAGES, "LC_MESSAGES"}, Category{LC_MONETARY, "LC_MONETARY"},
        Category{LC_TIME, "LC_TIME"}, Category{LC_NUMERIC, "LC_NUMERIC"}}) {
    if (std::setlocale(number, "") || warned) continue;
    warn_of_missing(name);
    warned = true;
  }
}

}  // namespace

void install_locale() {
  if (!std::setlocale(LC_ALL, "")) install_each();
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0) std::setlocale(LC_CTYPE, "C.UTF-8");
  std::setlocale(LC_NUMERIC, "C");
}

}  // namespace tw
