// What became of an event.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

enum class [[nodiscard]] Progress{
    done,
    try_again  // something else may come first: nothing was done, the event stays and is taken
               // again
};

}  // namespace tw
