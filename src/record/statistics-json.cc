// Statistics of a run as one flat JSON object.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "record/statistics-json.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace tw {

std::string statistics_json(const StatisticsTable& table) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const auto& [name, value] : table)
    std::visit([&, &key = name](const auto& v) { object[key] = v; }, value);
  return object.dump(2) + "\n";
}

void write_statistics_json(const std::string& path, const StatisticsTable& table) {
  const std::string text = statistics_json(table);
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool ok = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (file && std::fclose(file) != 0) ok = false;
  TW_REQUIRE(ok, "cannot write " + path + ": " + std::strerror(errno) +
                     "; expected a file that can be written");
}

}  // namespace tw
