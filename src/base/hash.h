// Hashes: a 64-bit mixer for states, and SHA-256 (Nettle) for what users compare.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace tw {

// The finaliser of SplitMix64: a bijection in which every input bit moves every output bit.
// Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// Folds words one after the other; the order of words matters, the moment does not.
class Hasher {
 public:
  void add(std::uint64_t word) { value_ = mix64(value_ + 0x9e3779b97f4a7c15ull + word); }
  // -0 and 0 differ on purpose: the hash is about bits.
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

// SHA-256 of the bytes, as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace tw
