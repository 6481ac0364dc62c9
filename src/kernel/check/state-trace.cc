// Every committed state as text.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/check/state-trace.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/error.h"
#include "kernel/check/state-image.h"

namespace tw {
namespace {

// The part before the next separator; takes it and the separator away.
std::string_view take(std::string_view& text, char separator) {
  const std::size_t at = text.find(separator);
  const std::string_view part = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view{} : text.substr(at + 1);
  return part;
}

template <class Number>
Number number_of(std::string_view text, Number otherwise) {
  std::from_chars(text.data(), text.data() + text.size(), otherwise);
  return otherwise;
}

double time_of(std::string_view line) { return number_of(take(line, '\t'), 0.0); }

// "FIELD: 1,2,3 instead of 1,2,4": of the first fields that differ.
std::string difference(std::string_view now, std::string_view before) {
  for (;;) {
    std::string_view field = take(now, '\t');
    std::string_view other = take(before, '\t');
    if (field == other) {
      if (now.empty() && before.empty()) return "";
      continue;
    }
    const std::string_view name = take(field, '=');
    const std::string_view other_name = take(other, '=');
    return std::string(name) + " is " + std::string(field) + " instead of " +
           (name == other_name ? "" : std::string(other_name) + " ") + std::string(other);
  }
}

}  // namespace

StateTrace::StateTrace(const Scene& scene, const std::string& write, const std::string& compare)
    : scene_(scene), compared_(compare) {
  if (!compare.empty()) read(compare);
  if (write.empty()) return;
  out_ = std::fopen(write.c_str(), "w");
  TW_REQUIRE(out_, "cannot write the states to " + write + ": " + std::strerror(errno));
}

StateTrace::~StateTrace() {
  if (out_) std::fclose(out_);
}

void StateTrace::read(const std::string& path) {
  std::ifstream in(path);
  TW_REQUIRE(in, "cannot read the states of " + path + ": " + std::strerror(errno));
  for (std::string line; std::getline(in, line);) {
    std::string_view rest = line;
    take(rest, '\t');
    lines_of(ProcessId{number_of(take(rest, '\t'), std::uint32_t{0})}).push_back(std::move(line));
  }
}

StateTrace::Lines& StateTrace::lines_of(ProcessId process) {
  if (number(process) >= expected_.size()) expected_.resize(number(process) + 1);
  return expected_[number(process)];
}

void StateTrace::note(double time, std::string text) {
  if (!first_ || time < first_->time) first_ = Difference{time, std::move(text)};
}

void StateTrace::add(const State& state) {
  StateImage image;
  image.add(state);
  const double time = state.key.time;
  const std::string name = scene_.body_of(state.process).info.name;
  const std::string line =
      show(time) + '\t' + std::to_string(number(state.process)) + '\t' + name + image.text();
  if (out_) std::fprintf(out_, "%s\n", line.c_str());
  if (compared_.empty() || first_) return;
  Lines& expected = lines_of(state.process);
  if (expected.empty() || time_of(expected.front()) > time)
    return note(time, "the state of " + name + " with " + show(state.key) + " is not there");
  if (const std::string text = difference(line, expected.front()); !text.empty())
    return note(std::min(time, time_of(expected.front())),
                name + " with " + show(state.key) + ": " + text);
  expected.pop_front();
}

void StateTrace::check(double limit, bool inclusive) {
  for (const Lines& lines : expected_)
    if (!lines.empty())
      if (const double time = time_of(lines.front());
          time < limit || (inclusive && time == limit)) {
        std::string_view line = lines.front();
        take(line, '\t');
        take(line, '\t');
        const std::string name(take(line, '\t'));
        take(line, '\t');
        note(time, name + " has no state with " + std::string(take(line, '\t')));
      }
  if (out_) std::fflush(out_);
  TW_REQUIRE(!first_, "the history differs from that of " + compared_ +
                          " first at t = " + show(first_->time) + " s: " + first_->text);
}

}  // namespace tw
