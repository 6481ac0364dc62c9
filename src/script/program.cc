// The executable: boots Guile and hands over to the command line.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/program.h"

#include <fcntl.h>
#include <libguile.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "script/file-names.h"
#include "script/init.h"
#include "script/locale.h"
#include "script/modules.h"

namespace tw {

namespace {

// Ports speak UTF-8 and never fail over a character, also where no UTF-8 locale is installed.
void set_up_ports() {
  for (const SCM port :
       {scm_current_input_port(), scm_current_output_port(), scm_current_error_port()})
    scm_set_port_encoding_x(port, scm_from_utf8_string("UTF-8"));
  scm_fluid_set_x(scm_variable_ref(scm_c_lookup("%default-port-encoding")),
                  scm_from_utf8_string("UTF-8"));
}

// One executable with two names.
const char* main_module_of(std::string_view called) {
  return called.substr(called.rfind('/') + 1) == "timewarp-sweep" ? "timewarp sweep"
                                                                  : "timewarp command-line";
}

void inner_main(void*, int argc, char** argv) {
  set_up_ports();
  // (timewarp primitives) finds the extension built in, whatever file it would load
  scm_c_register_extension(
      nullptr, "tw_init_guile", [](void*) { tw_init_guile(); }, nullptr);
  load_modules();
  const char* main_module = main_module_of(argc > 0 ? argv[0] : "");
  SCM arguments = SCM_EOL;
  for (int i = argc - 1; i > 0; --i) arguments = scm_cons(from_argument(argv[i]), arguments);
  scm_call_1(scm_c_public_ref(main_module, "main"), arguments);
}

}  // namespace

// A closed standard stream would give its number to the next file that is opened, and that file
// what is printed.
static void open_standard_streams() {
  for (int file = STDIN_FILENO; file <= STDERR_FILENO; ++file)
    if (fcntl(file, F_GETFD) < 0 && open("/dev/null", O_RDWR) != file) std::abort();
}

void run_program(int argc, char** argv) {
  open_standard_streams();
  install_locale();
  scm_boot_guile(argc, argv, inner_main, nullptr);
  std::abort();  // scm_boot_guile exits
}

}  // namespace tw
