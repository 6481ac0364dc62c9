// A CSV file that is streamed to disk.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "record/csv-file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.h"

namespace tw {

namespace {

// bytes gathered before they go to the system: large enough to be cheap, small enough that a crash
// of the machine costs little
constexpr std::size_t buffer_limit = 1 << 16;

[[noreturn]] void refuse(const std::string& path, int reason) {
  throw UserError("cannot write " + path + ": " + (reason ? std::strerror(reason) : "write error") +
                  "; expected a file that can be written");
}

}  // namespace

std::string csv_quoted(std::string_view value) {
  if (value.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(value);
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

void require_writable(const std::string& path) {
  std::error_code ignored;
  const bool is_there = std::filesystem::exists(path, ignored);
  // who reads a pipe would be left at the first close
  if (is_there && !std::filesystem::is_regular_file(path, ignored)) return;
  std::FILE* const file = std::fopen(path.c_str(), "ab");
  if (!file) refuse(path, errno);
  std::fclose(file);
  if (!is_there) std::remove(path.c_str());
}

CsvFile::CsvFile(const std::string& path, std::string_view header) : path_(path) {
  file_ = std::fopen(path.c_str(), "wb");
  if (!file_) fail(errno);
  // our own buffer is the only one, so that a failed write is seen at once
  std::setvbuf(file_, nullptr, _IONBF, 0);
  buffer_.reserve(buffer_limit + 4096);
  buffer_.append(header);
  buffer_ += '\n';
  flush();
}

CsvFile::~CsvFile() {
  if (!file_) return;
  if (!buffer_.empty()) std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
  std::fclose(file_);
}

void CsvFile::separate() {
  if (row_started_) buffer_ += ',';
  row_started_ = true;
}

void CsvFile::number(double value) {
  separate();
  char digits[40];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17);
  buffer_.append(digits, end.ptr);
}

void CsvFile::text(std::string_view value) {
  separate();
  buffer_ += csv_quoted(value);
}

void CsvFile::end_row() {
  buffer_ += '\n';
  row_started_ = false;
  if (buffer_.size() >= buffer_limit) write_out();
}

void CsvFile::flush() {
  if (!buffer_.empty()) write_out();
}

void CsvFile::write_out() {
  if (!file_) throw UserError("cannot write " + path_ + ": it is closed; expected an open file");
  errno = 0;
  const std::size_t written = std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
  const bool whole = written == buffer_.size();
  buffer_.clear();
  if (!whole) fail(errno);
}

void CsvFile::close() {
  if (!file_) return;
  flush();
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail(errno);
}

void CsvFile::fail(int reason) {
  if (file_) std::fclose(file_);
  file_ = nullptr;
  buffer_.clear();
  refuse(path_, reason);
}

}  // namespace tw
