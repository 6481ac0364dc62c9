// What a file of others has wrong and is read all the same: each thing with its place and with what
// is taken instead.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace tw {

// "2 holes"
inline std::string several(std::size_t count, const std::string& of) {
  return std::to_string(count) + " " + of + (count == 1 ? "" : "s");
}

class Mending {
 public:
  // `strict`: the first thing wrong is an error.
  explicit Mending(bool strict) : strict_(strict) {}

  // `where`: "FILE:LINE: "; `done`: what is taken instead; `expected`: for the error.
  void mend(const std::string& where, const std::string& wrong, const std::string& done,
            const std::string& expected) {
    if (strict_) throw UserError(where + wrong + "; expected " + expected);
    notes_.push_back(where + wrong + "; " + done);
  }

  // The same of what an error says, "WRONG; expected EXPECTED", after `before`.
  void mend(const std::string& where, const std::string& before, const UserError& error,
            const std::string& done) {
    const auto [wrong, expected] = halves(error);
    mend(where, before + wrong, done, expected);
  }

  // WRONG and EXPECTED of that.
  static std::pair<std::string, std::string> halves(const UserError& error) {
    const std::string text = error.what();
    const std::size_t split = text.rfind(between);
    const bool whole = split == std::string::npos;
    return {text.substr(0, split),
            whole ? "what can be read" : text.substr(split + std::string(between).size())};
  }

  // What is no fault, but to be known.
  void tell(std::string note) { notes_.push_back(std::move(note)); }

  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

 private:
  static constexpr const char* between = "; expected ";

  bool strict_;
  std::vector<std::string> notes_;
};

// The same at lines of one file.
class LineMending {
 public:
  LineMending(const std::string& file, Mending& mending) : file_(file), mending_(mending) {}

  // "FILE:LINE: "
  std::string at(int line) const { return file_ + ":" + std::to_string(line) + ": "; }
  [[noreturn]] void fail(int line, const std::string& what) const {
    throw UserError(at(line) + what);
  }
  void mend(int line, const std::string& wrong, const std::string& done,
            const std::string& expected) {
    mending_.mend(at(line), wrong, done, expected);
  }

 protected:
  const std::string& file_;
  Mending& mending_;
};

}  // namespace tw
