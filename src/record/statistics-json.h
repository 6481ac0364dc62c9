// Statistics of a run as one flat JSON object.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "kernel/report/statistics.h"

namespace tw {

// One key per line, in the table's order; a number that is not finite becomes null.
std::string statistics_json(const StatisticsTable& table);

// Errors: UserError with the path and the system's reason.
void write_statistics_json(const std::string& path, const StatisticsTable& table);

}  // namespace tw
