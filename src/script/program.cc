// The executable: boots Guile and hands over to the command line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/program.h"

#include <libguile.h>

#include <cstdlib>

#include "script/init.h"

namespace tw {

namespace {

// Adds a folder at the end of a load path, so that GUILE_LOAD_PATH and -L come first.
[[maybe_unused]] void append_to_path(const char* path_name, const char* folder) {
  const SCM variable = scm_c_lookup(path_name);
  const SCM entry = scm_list_1(scm_from_locale_string(folder));
  scm_variable_set_x(variable, scm_append(scm_list_2(scm_variable_ref(variable), entry)));
}

void inner_main(void*, int argc, char** argv) {
#ifdef TW_GUILE_SITE_DIR
  append_to_path("%load-path", TW_GUILE_SITE_DIR);
#endif
#ifdef TW_GUILE_SITE_CCACHE_DIR
  append_to_path("%load-compiled-path", TW_GUILE_SITE_CCACHE_DIR);
#endif
  // (timewarp primitives) finds the extension built in
  scm_c_register_extension(
      "libguile-timewarp", "tw_init_guile", [](void*) { tw_init_guile(); }, nullptr);
  SCM arguments = SCM_EOL;
  for (int i = argc - 1; i > 0; --i)
    arguments = scm_cons(scm_from_locale_string(argv[i]), arguments);
  scm_call_1(scm_c_public_ref("timewarp command-line", "main"), arguments);
}

}  // namespace

void run_program(int argc, char** argv) {
  scm_boot_guile(argc, argv, inner_main, nullptr);
  std::abort();  // scm_boot_guile exits
}

}  // namespace tw
