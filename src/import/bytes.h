// Numbers as bytes, between processes of one program.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"

namespace tw {

class ByteWriter {
 public:
  template <class T>
  void put(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_raw(static_cast<std::uint64_t>(values.size()));
    const char* data = reinterpret_cast<const char*>(values.data());
    bytes_.insert(bytes_.end(), data, data + values.size() * sizeof(T));
  }
  void put(const std::string& text) { put(std::vector<char>(text.begin(), text.end())); }
  std::vector<char> take() { return std::move(bytes_); }

 private:
  void put_raw(std::uint64_t value) {
    const char* data = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), data, data + sizeof value);
  }

  std::vector<char> bytes_;
};

// In the order in which they were put.  Errors (UserError): bytes that end too early.
class ByteReader {
 public:
  explicit ByteReader(const std::vector<char>& bytes) : bytes_(bytes) {}

  bool at_end() const { return at_ == bytes_.size(); }
  template <class T>
  std::vector<T> get() {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = 0;
    copy(&count, sizeof count);
    TW_REQUIRE(count <= (bytes_.size() - at_) / sizeof(T), "what was read of a file is cut short");
    std::vector<T> values(count);
    copy(values.data(), count * sizeof(T));
    return values;
  }
  std::string get_text() {
    const std::vector<char> text = get<char>();
    return std::string(text.begin(), text.end());
  }

 private:
  void copy(void* to, std::size_t size) {
    TW_REQUIRE(size <= bytes_.size() - at_, "what was read of a file is cut short");
    if (size > 0) std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace tw
