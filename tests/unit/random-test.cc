// Random numbers and hashes: known answers, and the properties that rollback relies on.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

namespace tw::test {
namespace {

// The reference implementation's first words for seed 1234567 (S. Vigna, splitmix64.c).
TEST(Random, is_splitmix64) {
  Random random(1234567);
  const std::uint64_t expected[] = {6457827717110365317ull, 3203168211198807973ull,
                                    9817491932198370423ull, 4593380528125082431ull,
                                    16408922859458223821ull};
  for (const std::uint64_t word : expected) EXPECT_EQ(random.word(), word);
}

TEST(Random, copy_continues_the_same_stream) {
  Random a(5);
  for (int i = 0; i < 10; ++i) a.word();
  Random b = a;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.word(), b.word());
}

// Uniform: mean 1/2, variance 1/12, each within 5 standard deviations; 10 classes by chi-square.
TEST(Random, reals_are_uniform_in_0_to_1) {
  Random random(6);
  const int n = 200000;
  double sum = 0, squares = 0;
  std::array<int, 10> classes{};
  for (int i = 0; i < n; ++i) {
    const double x = random.real();
    ASSERT_TRUE(x >= 0 && x < 1);
    sum += x;
    squares += (x - 0.5) * (x - 0.5);
    ++classes[static_cast<std::size_t>(10 * x)];
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / n));
  double chi_square = 0;
  for (const int count : classes)
    chi_square += (count - n / 10.0) * (count - n / 10.0) / (n / 10.0);
  EXPECT_LT(chi_square, 34);  // 9 degrees of freedom, 1e-4
}

TEST(Mix64, every_input_bit_moves_about_half_of_the_output_bits) {
  Random random(7);
  for (int bit = 0; bit < 64; ++bit) {
    int flipped = 0;
    for (int i = 0; i < 200; ++i) {
      const std::uint64_t x = random.word();
      flipped += std::popcount(mix64(x) ^ mix64(x ^ 1ull << bit));
    }
    EXPECT_NEAR(flipped / 200.0, 32, 3) << "bit " << bit;
  }
}

TEST(Hasher, tells_order_signs_of_zero_and_last_bits_apart) {
  const auto hash = [](double a, double b) {
    Hasher h;
    h.add(a);
    h.add(b);
    return h.value();
  };
  EXPECT_EQ(hash(1, 2), hash(1, 2));
  EXPECT_NE(hash(1, 2), hash(2, 1));
  EXPECT_NE(hash(0.0, 1), hash(-0.0, 1));
  EXPECT_NE(hash(1, 1), hash(1, std::nextafter(1.0, 2.0)));
}

// FIPS 180-2, appendix B.
TEST(Sha256, known_answers) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace
}  // namespace tw::test
