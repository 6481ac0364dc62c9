// Opening shared libraries at run time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <dlfcn.h>

#include <string>

namespace tw {

// Opens a library for the rest of the process: its threads and exit handlers may outlive any use.
// Null with the reason where that fails.
inline void* open_shared_library(const char* name, std::string& reason) {
  void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    if (const char* error = dlerror())
      reason = error;
    else
      (reason = name) += " cannot be opened";
  }
  return library;
}

// False where the library lacks the symbol.
template <class Function>
bool find_symbol(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace tw
