// The locale of the program: the user's, but in UTF-8.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Installs the locale that the environment names.  One that is not installed is warned of in one
// line on standard error, and the C locale holds.  Characters are those of C.UTF-8 where the
// locale's are not UTF-8 (as in the C and POSIX locales); numbers are written as in C.
void install_locale();

}  // namespace tw
