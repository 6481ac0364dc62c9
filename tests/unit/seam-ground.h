// Fixed bodies that are neighbours of each other, for tests of seams.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "collision/seams/seams.h"

namespace tw::test {

using Points = std::vector<ManifoldPoint>;

inline Frame at(double x, double y, double z) { return Frame(Mat3::Identity(), Vec3(x, y, z)); }

inline Frame turned(const Vec3& rotation, const Vec3& position) {
  return Frame(rotation_by(rotation).toRotationMatrix(), position);
}

// Fixed bodies that are neighbours of each other.
struct Ground {
  std::vector<ShapePtr> shapes;
  std::vector<Frame> frames;

  void add(const ShapePtr& shape, const Frame& frame) {
    shapes.push_back(shape);
    frames.push_back(frame);
  }
  std::vector<SeamNeighbour> around(std::size_t body) const {
    std::vector<SeamNeighbour> neighbours;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (i != body)
        for (const ConvexPart& part : shapes[i]->parts()) neighbours.push_back({&part, frames[i]});
    return neighbours;
  }
  // What a moving body meets; the normals point up from the ground.
  Points meets(const ShapePtr& moving, const Frame& frame, double reach, bool moving_is_a) const {
    Points all;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      Points some;
      if (moving_is_a)
        manifold_at_seams(*moving, frame, {}, *shapes[i], frames[i], around(i), reach,
                          moving->least_width(), some, ReferenceChoice::of_b);
      else
        manifold_at_seams(*shapes[i], frames[i], around(i), *moving, frame, {}, reach,
                          moving->least_width(), some, ReferenceChoice::of_a);
      for (ManifoldPoint p : some) {
        if (p.reference_is_a == moving_is_a) p.normal = -p.normal;
        all.push_back(p);
      }
    }
    return all;
  }
};

}  // namespace tw::test
