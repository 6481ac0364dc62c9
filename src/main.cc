// The program `timewarp`.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/program.h"

int main(int argc, char** argv) { tw::run_program(argc, argv); }
