// Reading patterns of file names.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/frame-name.h"

#include "base/error.h"
#include "render/whole-file.h"

namespace tw {

namespace {

[[noreturn]] void refuse(const std::string& pattern, const std::string& why) {
  throw UserError("frames: pattern '" + pattern + "' " + why +
                  "; expected a folder, or one number like %05d in a name");
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Reads [0][width]d at `at`, which moves past it.
void read_conversion(const std::string& pattern, std::size_t& at, char& fill, int& width) {
  fill = ' ';
  width = 0;
  if (at < pattern.size() && pattern[at] == '0') {
    fill = '0';
    ++at;
  }
  for (; at < pattern.size() && is_digit(pattern[at]); ++at) {
    width = 10 * width + (pattern[at] - '0');
    if (width > 20) refuse(pattern, "asks for more than 20 digits");
  }
  if (at == pattern.size() || pattern[at] != 'd')
    refuse(pattern, "has a percent sign without a number");
  ++at;
}

}  // namespace

FrameName::FrameName(const std::string& folder_or_pattern) {
  const std::string& pattern = folder_or_pattern;
  TW_REQUIRE(!pattern.empty(), "frames: the name of the folder is empty");
  if (pattern.find('%') == std::string::npos) {
    before_ = pattern.back() == '/' ? pattern : pattern + "/";
    after_ = ".png";
    folder_ = folder_of(before_);
    return;
  }
  bool found = false;
  for (std::size_t at = 0; at < pattern.size();) {
    const bool percent = pattern[at] == '%';
    const bool doubled = percent && at + 1 < pattern.size() && pattern[at + 1] == '%';
    if (percent && !doubled) {
      if (found) refuse(pattern, "has more than one number");
      read_conversion(pattern, ++at, fill_, width_);
      found = true;
      continue;
    }
    (found ? after_ : before_) += pattern[at];
    at += doubled ? 2 : 1;
  }
  if (!found) refuse(pattern, "has no number");
  if (after_.find('/') != std::string::npos) refuse(pattern, "numbers a folder");
  folder_ = folder_of(before_);
}

std::string FrameName::name(long index) const {
  std::string digits = std::to_string(index);
  const auto width = static_cast<std::size_t>(width_);
  if (digits.size() < width) digits.insert(0, width - digits.size(), fill_);
  return before_ + digits + after_;
}

}  // namespace tw
