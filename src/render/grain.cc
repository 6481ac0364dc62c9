// Noise by gradients at the nodes of grids, each grid twice as fine as the one before.
// Source: K. Perlin, "Improving noise", SIGGRAPH 2002.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/grain.h"

#include <algorithm>
#include <cmath>

namespace tw {

namespace {

constexpr int first_cells = 4, octaves = 6;

// Scrambles the bits of a node's place.
// Source: the finalizer of A. Appleby's MurmurHash3.
std::uint32_t scrambled(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bu;
  x ^= x >> 13;
  x *= 0xc2b2ae35u;
  return x ^ (x >> 16);
}

// The node's gradient, one of eight, times the way from the node.
double node_slope(int octave, int cells, int i, int j, double x, double y) {
  const auto wrapped = [cells](int k) { return static_cast<std::uint32_t>(k % cells); };
  const std::uint32_t bits =
      scrambled((static_cast<std::uint32_t>(octave) << 20) + (wrapped(i) << 10) + wrapped(j));
  const double long_way = (bits & 1) ? 1 : -1, short_way = (bits & 2) ? 0.5 : -0.5;
  return (bits & 4) ? long_way * x + short_way * y : short_way * x + long_way * y;
}

double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

double octave_value(int octave, int cells, double x, double y) {
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double u = x - i, v = y - j;
  const auto row = [&](int dj) {
    const double left = node_slope(octave, cells, i, j + dj, u, v - dj);
    const double right = node_slope(octave, cells, i + 1, j + dj, u - 1, v - dj);
    return left + fade(u) * (right - left);
  };
  const double low = row(0), high = row(1);
  return low + fade(v) * (high - low);
}

double value(int column, int row) {
  double sum = 0, share = 1;
  for (int octave = 0; octave < octaves; ++octave, share *= 0.6) {
    const int cells = first_cells << octave;
    const double step = static_cast<double>(cells) / grain_side;
    sum += share * octave_value(octave, cells, (column + 0.5) * step, (row + 0.5) * step);
  }
  return sum;
}

std::uint8_t to_byte(double x) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(128 + 127 * x), 0l, 255l));
}

}  // namespace

std::vector<std::uint8_t> make_grain() {
  constexpr int side = grain_side;
  const auto at = [](int column, int row) {
    return static_cast<std::size_t>((row + side) % side) * side +
           static_cast<std::size_t>((column + side) % side);
  };
  std::vector<double> values;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) values.push_back(value(column, row));
  std::vector<std::uint8_t> bytes;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double along = values[at(column + 1, row)] - values[at(column - 1, row)];
      const double across = values[at(column, row + 1)] - values[at(column, row - 1)];
      for (const double x : {values[at(column, row)], 4 * along, 4 * across})
        bytes.push_back(to_byte(x));
      bytes.push_back(255);
    }
  return bytes;
}

GLuint make_grain_texture(const GlApi& gl) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  // each smaller version is the mean of four texels: our own, as the driver's rounding may change
  std::vector<std::uint8_t> bytes = make_grain();
  for (int level = 0, side = grain_side; side >= 1; ++level, side /= 2) {
    gl.TexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, side, side, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  bytes.data());
    std::vector<std::uint8_t> smaller;
    for (int row = 0; row + 1 < side; row += 2)
      for (int column = 0; column + 1 < side; column += 2)
        for (int channel = 0; channel < 4; ++channel) {
          const auto texel = [&](int x, int y) {
            return bytes[4 * static_cast<std::size_t>((row + y) * side + column + x) +
                         static_cast<std::size_t>(channel)];
          };
          smaller.push_back(static_cast<std::uint8_t>(
              (texel(0, 0) + texel(1, 0) + texel(0, 1) + texel(1, 1) + 2) / 4));
        }
    bytes = std::move(smaller);
  }
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D, axis, GL_REPEAT);
  return texture;
}

}  // namespace tw
