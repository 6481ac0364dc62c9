// A CSV file that is streamed to disk and says so when the disk refuses.
//
// Invariants: what `flush` has returned from is in the file; after a failure nothing more is
// written, and every later call fails with the same message.
// Source: RFC 4180 for quoting; lines end with a single newline.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tw {

class CsvFile {
 public:
  // Creates or truncates the file, writes the header line and flushes it, so that an unwritable
  // file or a full disk shows before any simulation.
  // Errors: UserError with the path and the system's reason.
  CsvFile(const std::string& path, std::string_view header);
  // Closes without complaint; call `close` to hear about failures.
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  // Up to 17 significant digits, which read back to the same double; "nan", "inf", "-inf".
  void number(double value);
  // Quoted where RFC 4180 asks for it: commas, quotes and line ends.
  void text(std::string_view value);
  // Errors of the system may show here, or at the next flush.
  void end_row();
  void flush();
  void close();
  const std::string& path() const { return path_; }

 private:
  void separate();
  void write_out();
  [[noreturn]] void fail(int reason);

  std::string path_;
  std::string buffer_;
  std::FILE* file_ = nullptr;
  bool row_started_ = false;
};

// Whether the file could be written, without touching what is in it.  Errors: as of CsvFile.
void require_writable(const std::string& path);

// "a,b" with quotes where needed.
std::string csv_quoted(std::string_view value);

}  // namespace tw
