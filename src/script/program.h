// The executable: boots Guile and hands over to the command line, which is written in Scheme.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Does not return: the command line exits with the status that --help names.
[[noreturn]] void run_program(int argc, char** argv);

}  // namespace tw
