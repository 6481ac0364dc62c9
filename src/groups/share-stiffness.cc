// How the contacts of a pair share its stiffness.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/share-stiffness.h"

#include <algorithm>

#include "base/constants.h"

namespace tw {
namespace {

// How much of a point counts: all of it to the depth that one weight makes, less and less to twice
// that above the surface.  Nothing jumps where a point comes near.  Where the deepest is beyond its
// hardest, gaps are measured by that depth: of two bodies deep in each other that tilt, the points
// that part would otherwise leave all the springs to the others at once.
double participation(const NewContact& c, double deepest) {
  const double beyond = std::max(0.0, deepest - answer::hardest_ratio * c.contact.law.hardening);
  return std::clamp(2 - c.gap / (c.contact.law.gap_scale() + beyond), 0.0, 1.0);
}

// Of the contacts of one dynamic body with the ground.
void share_ground(const std::vector<NewContact*>& points, const Body& body) {
  const double radius = answer::same_place * body.least_width;
  // seen from the ground all normals point the same way
  const auto cosine = [&](const NewContact& x, const NewContact& y) {
    const double sign = (x.tag.reference == body.id()) == (y.tag.reference == body.id()) ? 1 : -1;
    return sign * x.normal.dot(y.normal);
  };
  double deepest = 0;
  for (const NewContact* c : points) deepest = std::max(deepest, -c->gap);
  thread_local std::vector<double> here;
  here.assign(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i == j || !(cosine(*points[i], *points[j]) > answer::same_normal)) continue;
      const double distance = (points[i]->point - points[j]->point).norm();
      here[i] += participation(*points[j], deepest) * std::max(0.0, 1 - distance / radius);
    }
  for (std::size_t i = 0; i < points.size(); ++i) {
    double places = 0;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (i == j || cosine(*points[i], *points[j]) > 1 - 0.5 * answer::coplanar * answer::coplanar)
        places += participation(*points[j], deepest) / here[j];
    points[i]->contact.share = 1 / std::max(1.0, places * here[i]);
  }
}

}  // namespace

void share_stiffness(Regrouping& work) {
  const Scene& scene = work.scene();
  thread_local std::vector<std::pair<BodyId, std::uint32_t>> on_ground;
  thread_local std::vector<NewContact*> points;
  on_ground.clear();
  for (const ContactPair& pair : work.pairs) {
    const bool a_moves = scene.body(pair.a()).dynamic(), b_moves = scene.body(pair.b()).dynamic();
    double count = 0, deepest = 0;
    each_contact(pair,
                 [&](std::uint32_t c) { deepest = std::max(deepest, -work.contacts[c].gap); });
    each_contact(pair, [&](std::uint32_t c) {
      if (!(a_moves && b_moves)) on_ground.push_back({a_moves ? pair.a() : pair.b(), c});
      count += participation(work.contacts[c], deepest);
    });
    if (a_moves && b_moves)
      each_contact(pair, [&](std::uint32_t c) {
        work.contacts[c].contact.share = 1 / std::max(1.0, count);
      });
  }

  std::sort(on_ground.begin(), on_ground.end());
  for (std::size_t i = 0, j = 0; i < on_ground.size(); i = j) {
    for (j = i; j < on_ground.size() && on_ground[j].first == on_ground[i].first;) ++j;
    points.clear();
    for (std::size_t k = i; k < j; ++k) points.push_back(&work.contacts[on_ground[k].second]);
    share_ground(points, scene.body(on_ground[i].first));
  }
}

}  // namespace tw
