// Cells of height fields as convex parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/height-field.h"

#include <cmath>

#include "geometry/polyhedron.h"

namespace tw {

HeightField::HeightField(std::vector<double> heights, std::size_t columns, double spacing_x,
                         double spacing_y, std::vector<Vec3> colors)
    : LazyParts(2 * (columns - 1) * (heights.size() / columns - 1)),
      heights_(std::move(heights)),
      colors_(std::move(colors)),
      columns_(columns),
      spacing_x_(spacing_x),
      spacing_y_(spacing_y),
      rectangles_((columns - 1) * (heights_.size() / columns - 1)) {
  join_cells();
  std::vector<Aabb> boxes(part_count());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (exists(i)) boxes[i] = box(i);
  set_boxes(boxes);
}

Vec3 HeightField::corner(std::size_t row, std::size_t column) const {
  // multiples of half a spacing: exact where the spacing has few digits
  const auto from_middle = [](std::size_t i, std::size_t count) {
    return 0.5 * (2 * static_cast<double>(i) - static_cast<double>(count - 1));
  };
  return {from_middle(column, columns_) * spacing_x_, from_middle(row, rows()) * spacing_y_,
          heights_[row * columns_ + column]};
}

// What rounding makes of heights in a plane, and of the faces of a part over these cells.
double HeightField::rounding(std::size_t row, std::size_t column, const Rectangle& cells) const {
  const double* const low = &heights_[row * columns_ + column];
  const double* const high = low + cells.rows * columns_;
  const double span = std::max(cells.rows * spacing_y_, cells.columns * spacing_x_);
  const double size =
      std::abs(low[0] - high[cells.columns]) + std::abs(low[cells.columns] - high[0]) + span;
  return 1e-15 * (std::abs(low[0]) + std::abs(high[cells.columns])) + 1e-14 * size;
}

// As large as it may be from this cell on; a cut cell where its four corners are in no plane.
HeightField::Rectangle HeightField::rectangle_from(std::size_t row, std::size_t column) const {
  const double* const first = &heights_[row * columns_ + column];
  Rectangle cells;
  // height of the plane through three corners of what there is, as many cells away
  const auto expected = [&](std::size_t i, std::size_t j) {
    const double along_x = (first[cells.columns] - first[0]) / cells.columns;
    const double along_y = (first[cells.rows * columns_] - first[0]) / cells.rows;
    return first[0] + (along_x * static_cast<double>(i) + along_y * static_cast<double>(j));
  };
  const auto fits = [&](std::size_t i, std::size_t j) {
    return std::abs(first[j * columns_ + i] - expected(i, j)) <= rounding(row, column, cells);
  };
  const auto is_free = [&](std::size_t i, std::size_t j) {
    return rectangles_[(row + j) * (columns_ - 1) + column + i].rows > 0;
  };
  cells.is_cut = !fits(1, 1);
  if (cells.is_cut) return cells;
  while (column + cells.columns + 1 < columns_ && is_free(cells.columns, 0) &&
         fits(cells.columns + 1, 0) && fits(cells.columns + 1, 1))
    ++cells.columns;
  const auto row_fits = [&] {
    for (std::size_t i = 0; i <= cells.columns; ++i) {
      if (i < cells.columns && !is_free(i, cells.rows)) return false;
      if (!fits(i, cells.rows + 1)) return false;
    }
    return true;
  };
  while (row + cells.rows + 1 < rows() && row_fits()) ++cells.rows;
  return cells;
}

void HeightField::join_cells() {
  for (std::size_t row = 0; row + 1 < rows(); ++row)
    for (std::size_t column = 0; column + 1 < columns_; ++column) {
      const std::size_t cell = row * (columns_ - 1) + column;
      if (rectangles_[cell].rows == 0) continue;
      const Rectangle found = rectangle_from(row, column);
      for (std::size_t j = 0; j < found.rows; ++j)
        for (std::size_t i = 0; i < found.columns; ++i)
          rectangles_[cell + j * (columns_ - 1) + i] = {0, 0, false};
      rectangles_[cell] = found;
    }
}

std::vector<Vec3> HeightField::top(std::size_t number) const {
  const std::size_t cell = number / 2;
  const std::size_t row = cell / (columns_ - 1), column = cell % (columns_ - 1);
  const Rectangle& cells = rectangles_[cell];
  const Vec3 a = corner(row, column), b = corner(row, column + cells.columns);
  const Vec3 c = corner(row + cells.rows, column + cells.columns),
             d = corner(row + cells.rows, column);
  if (!cells.is_cut) return {a, b, c, d};
  return number % 2 == 0 ? std::vector<Vec3>{a, b, c} : std::vector<Vec3>{a, c, d};
}

Aabb HeightField::box(std::size_t number) const {
  Aabb box;
  for (const Vec3& p : top(number)) box.add(p);
  box.lo.z() -= depth();
  return box;
}

ConvexPart HeightField::make_part(std::size_t number) const {
  const std::vector<Vec3> corners = top(number);
  const auto count = static_cast<int>(corners.size());
  const Aabb box = this->box(number);
  // the part's frame is in the middle of its cells: short coordinates, exact ones where the grid's
  // are
  const Vec3 middle = 0.5 * (corners[0] + corners[2]);
  std::vector<Vec3> vertices;
  std::vector<int> above, below;
  for (const Vec3& p : corners) vertices.push_back(p - middle);
  for (const Vec3& p : corners) vertices.push_back(Vec3(p.x(), p.y(), box.lo.z()) - middle);
  std::vector<std::vector<int>> faces;
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    above.push_back(i);
    below.push_back(2 * count - 1 - i);
    faces.push_back({i, count + i, count + next, next});
  }
  faces.insert(faces.begin(), {above, below});

  return part_about(middle, std::make_shared<const Polyhedron>(std::move(vertices), faces));
}

}  // namespace tw
