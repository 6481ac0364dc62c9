// The parts of ground that has many of them, each made when it is first asked for.
//
// Frames: the shape's own, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "geometry/part-tree.h"
#include "geometry/shape.h"

namespace tw {

class LazyParts {
 public:
  virtual ~LazyParts();
  LazyParts(const LazyParts&) = delete;
  LazyParts& operator=(const LazyParts&) = delete;

  std::size_t part_count() const { return parts_.size(); }
  // Whether the number stands for a part.
  virtual bool exists(std::size_t) const { return true; }
  // Any number of threads may ask at once.
  const ConvexPart& part(std::size_t number) const;
  // Numbers that stand for no part are not in it.
  const PartTree& tree() const { return *tree_; }

 protected:
  explicit LazyParts(std::size_t count);
  // One box for each number, empty where that stands for no part.
  void set_boxes(std::span<const Aabb> boxes);
  virtual ConvexPart make_part(std::size_t number) const = 0;

 private:
  mutable std::vector<std::atomic<const ConvexPart*>> parts_;
  std::unique_ptr<const PartTree> tree_;
};

// A polyhedron with short coordinates: its frame is at `middle`, where its own is that of the
// shape.
ConvexPart part_about(const Vec3& middle, std::shared_ptr<const Polyhedron> core);

}  // namespace tw
