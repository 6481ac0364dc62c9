// A table of results: Markdown on standard output and, where the environment names a folder by
// TW_BENCH_RESULTS, the same cells there as NAME.csv, which build-aux/bench-tables puts into
// doc/performance.md.
//
// Columns and cells are given as one text with " | " between them.  The first lines of the file say
// where it is from: what TW_BENCH_RUN holds (tests/bench/this-run.sh: machine, date, commit) and
// the command, TW_BENCH_COMMAND or this program.  tests/bench/keep-table.sh does the same for
// programs in other languages.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace tw::bench {

class Table {
 public:
  Table(const std::string& name, const std::string& columns) {
    open(name);
    std::printf("| %s |\n|", columns.c_str());
    std::size_t count = 1;
    for (std::size_t at = 0; (at = columns.find(" | ", at)) != std::string::npos; at += 3) ++count;
    for (std::size_t i = 0; i < count; ++i) std::printf(" --- |");
    std::printf("\n");
    std::fflush(stdout);
    keep(columns);
  }
  ~Table() {
    if (file_) std::fclose(file_);
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  // As std::printf.  Written at once, so that a child process may add rows.
  [[gnu::format(printf, 2, 3)]] void row(const char* format, ...) {
    std::va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    std::string cells(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, again)), ' ');
    va_end(again);
    std::vsnprintf(cells.data(), cells.size() + 1, format, values);
    va_end(values);
    std::printf("| %s |\n", cells.c_str());
    std::fflush(stdout);
    keep(cells);
  }

 private:
  void open(const std::string& name) {
    const char* const folder = std::getenv("TW_BENCH_RESULTS");
    if (!folder || !*folder) return;
    std::filesystem::create_directories(folder);
    const std::string path = std::string(folder) + "/" + name + ".csv";
    file_ = std::fopen(path.c_str(), "w");
    if (!file_) throw std::runtime_error("cannot write " + path);
    if (const char* const run = std::getenv("TW_BENCH_RUN")) std::fprintf(file_, "%s\n", run);
    const char* const command = std::getenv("TW_BENCH_COMMAND");
    std::fprintf(file_, "# command: %s%s\n", command ? "" : "tests/bench/",
                 command ? command : program_invocation_short_name);
  }

  void keep(const std::string& cells) {
    if (!file_) return;
    std::string line;
    std::size_t from = 0;
    while (true) {
      const std::size_t end = cells.find(" | ", from);
      line += quoted(cells.substr(from, end == std::string::npos ? end : end - from));
      if (end == std::string::npos) break;
      line += ',';
      from = end + 3;
    }
    std::fprintf(file_, "%s\n", line.c_str());
    std::fflush(file_);
  }

  static std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"") == std::string::npos) return cell;
    std::string out = "\"";
    for (const char c : cell) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
  }

  std::FILE* file_ = nullptr;
};

}  // namespace tw::bench
