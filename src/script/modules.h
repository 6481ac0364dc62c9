// Where the program finds its Scheme modules.
//
// An installed program takes those that were installed with it, beside itself, wherever the whole
// tree has been moved, and one in its build folder those of its sources; no GUILE_LOAD_PATH can mix
// versions then.  Otherwise Guile's load path decides, at whose end the folders known from
// `configure` stand.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Puts the folders on Guile's load paths and loads the program's own modules.  Where there are
// none, says where they were looked for and exits with status 1.  Called once, in Guile mode.
void load_modules();

}  // namespace tw
