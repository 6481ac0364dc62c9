// Height fields: ground given by its heights over a rectangular grid.
//
// Each cell of the grid is cut along the diagonal from its corner of least x and y to that of
// greatest x and y, but where its four corners lie in one plane.  Cells side by side in one plane
// are joined to rectangles: from the least row and column on, each as wide as it may be, then as
// long.  What is beneath the two triangles or the rectangle is solid: a convex part with vertical
// sides, whose bottom is as far below its lowest corner as cells are wide.
//
// Frames: the shape's own: the middle of the grid at x = y = 0, heights along z, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/lazy-parts.h"

namespace tw {

class HeightField final : public LazyParts {
 public:
  // Row by row, x growing within a row and y from row to row.  `colors`: sRGB, one a height, or
  // none.
  HeightField(std::vector<double> heights, std::size_t columns, double spacing_x, double spacing_y,
              std::vector<Vec3> colors = {});

  std::size_t rows() const { return heights_.size() / columns_; }
  std::size_t columns() const { return columns_; }
  // A point of the grid; by its number, row by row.
  Vec3 corner(std::size_t row, std::size_t column) const;
  Vec3 corner(std::size_t point) const { return corner(point / columns_, point % columns_); }
  // What it looks like, sRGB: for drawing alone.
  bool has_colors() const { return !colors_.empty(); }
  const Vec3& color(std::size_t point) const { return colors_[point]; }
  // The bottom of a part is so far below its lowest corner, m.
  double depth() const { return std::max(spacing_x_, spacing_y_); }

  // Parts have two numbers for each cell.  A rectangle has the first number of its first cell; its
  // other ones stand for no part.
  bool exists(std::size_t number) const override {
    const Rectangle& cells = rectangles_[number / 2];
    return number % 2 == 0 ? cells.rows > 0 : cells.is_cut;
  }
  // The top corners of a part, counter-clockwise from above.
  std::vector<Vec3> top(std::size_t number) const;

 private:
  // Of cells in one plane, at the first of them; none where they are another one's.
  struct Rectangle {
    std::uint32_t rows = 1, columns = 1;
    bool is_cut = false;  // one cell, two triangles
  };

  double rounding(std::size_t row, std::size_t column, const Rectangle& cells) const;
  void join_cells();
  Rectangle rectangle_from(std::size_t row, std::size_t column) const;
  Aabb box(std::size_t number) const;
  ConvexPart make_part(std::size_t number) const override;

  std::vector<double> heights_;
  std::vector<Vec3> colors_;
  std::size_t columns_;
  double spacing_x_, spacing_y_;
  std::vector<Rectangle> rectangles_;  // for each cell
};

}  // namespace tw
