// Entry of the extension libguile-timewarp.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

// Defines and exports all primitives in Guile's current module; called by load-extension.
extern "C" void tw_init_guile();
