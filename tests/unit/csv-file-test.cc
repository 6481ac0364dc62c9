// CSV files: quoting, digits, and disks that refuse.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "record/csv-file.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "record/statistics-json.h"

namespace tw {
namespace {

// A file name that nobody else uses; the file is removed at the end.
class TemporaryFile {
 public:
  TemporaryFile() {
    char name[] = "/tmp/timewarp-csv-XXXXXX";
    const int descriptor = mkstemp(name);
    EXPECT_GE(descriptor, 0);
    if (descriptor >= 0) ::close(descriptor);
    path_ = name;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }
  std::string text() const {
    std::ostringstream all;
    all << std::ifstream(path_).rdbuf();
    return all.str();
  }

 private:
  std::string path_;
};

TEST(CsvFile, quotes_what_rfc_4180_asks_for_and_nothing_else) {
  EXPECT_EQ(csv_quoted("ball 1"), "ball 1");
  EXPECT_EQ(csv_quoted("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_quoted("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(csv_quoted("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_quoted(""), "");
}

TEST(CsvFile, numbers_read_back_to_the_same_bits) {
  const TemporaryFile file;
  const double values[] = {0.1, 1.0 / 3, -2.5e-308, 1e300, 0, -0.0, 123456789.123456789};
  CsvFile csv(file.path(), "x");
  for (const double value : values) {
    csv.number(value);
    csv.end_row();
  }
  csv.close();
  std::istringstream lines(file.text());
  std::string line;
  std::getline(lines, line);
  for (const double value : values) {
    std::getline(lines, line);
    const double read = std::strtod(line.c_str(), nullptr);
    EXPECT_EQ(std::memcmp(&read, &value, sizeof value), 0) << line;
  }
}

TEST(CsvFile, flush_brings_whole_rows_to_the_file_before_it_is_closed) {
  const TemporaryFile file;
  CsvFile csv(file.path(), "time,body");
  EXPECT_EQ(file.text(), "time,body\n");
  csv.number(0.5);
  csv.text("a,b");
  csv.end_row();
  csv.flush();
  EXPECT_EQ(file.text(), "time,body\n0.5,\"a,b\"\n");
}

TEST(CsvFile, a_full_disk_and_a_missing_folder_are_named_when_the_file_is_opened) {
  for (const auto& [path, reason] : {std::pair{"/dev/full", "No space left on device"},
                                     std::pair{"/proc/none/x.csv", "No such file"}}) {
    try {
      CsvFile csv(path, "x");
      FAIL() << path << " was accepted";
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos);
    }
  }
}

TEST(StatisticsJson, is_one_flat_object_in_the_order_of_the_table) {
  const StatisticsTable table{{"collisions", std::int64_t{3}},
                              {"cpu_seconds", 0.5},
                              {"policy", std::string("time\"warp")},
                              {"ratio", std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_EQ(statistics_json(table),
            "{\n  \"collisions\": 3,\n  \"cpu_seconds\": 0.5,\n  \"policy\": \"time\\\"warp\",\n"
            "  \"ratio\": null\n}\n");
}

TEST(StatisticsJson, a_full_disk_is_an_error) {
  EXPECT_THROW(write_statistics_json("/dev/full", {{"x", 1.0}}), UserError);
}

}  // namespace
}  // namespace tw
