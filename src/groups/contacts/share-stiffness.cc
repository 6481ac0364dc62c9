// How the contacts of a pair share its stiffness.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/share-stiffness.h"

#include <algorithm>

#include "base/constants.h"
#include "math/near-in-x.h"

namespace tw {
namespace {

// How near a point is: 1 down from the depth that one weight makes, to 0 at twice that above the
// surface.  Nothing jumps where a point comes near.
double nearness(const NewContact& c) {
  return std::clamp(2 - c.gap / c.contact.law.gap_scale(), 0.0, 1.0);
}

// What a contact had before at most, where it is deeper than it hardens: of two bodies deep in each
// other that turn, points part, and what these leave to the others would be energy that nobody
// gave.
double most_share(const NewContact& c) {
  return -c.gap > answer::hardest_ratio * c.contact.law.hardening ? c.share_before : 1;
}

// The contacts of one body with another, or of one with the ground.
struct Points {
  std::vector<NewContact*> contacts;
  // of each: how much of it counts, and of those for which it stands that are not here
  std::vector<double> counts;
  std::vector<double> beyond;

  void clear() { contacts.clear(); }

  // Of points of two parts that lie on each other the lower ones touch, and the others count as
  // well, as flat as they lie with these: a body that rocks lifts some of them, and if all their
  // stiffness went to the others by that, at once and while these are pressed, it would be driven
  // by its own springs.
  void weigh() {
    counts.resize(contacts.size());
    beyond.resize(contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) counts[i] = nearness(*contacts[i]);
    for (std::size_t i = 0, j = 0; i < contacts.size(); i = j) {
      double nearest = 0;
      for (j = i; j < contacts.size() && same_parts(*contacts[i], *contacts[j]); ++j)
        nearest = std::max(nearest, counts[j]);
      for (std::size_t k = i; k < j; ++k) {
        counts[k] = std::max(counts[k], nearest * contacts[k]->tag.flatness);
        beyond[k] = nearest * contacts[k]->tag.beyond;
      }
    }
  }

  static bool same_parts(const NewContact& x, const NewContact& y) {
    return x.tag.parts == y.tag.parts &&
           std::minmax(x.tag.reference, x.tag.other) == std::minmax(y.tag.reference, y.tag.other);
  }
};

// Points at one place are one: `same_plane` and `same_side` say of whom that is asked.
template <class SamePlane, class SameSide>
void share(Points& all, double radius, const SamePlane& same_plane, const SameSide& same_side) {
  all.weigh();
  const std::vector<NewContact*>& points = all.contacts;
  thread_local std::vector<double> here;
  here.assign(points.size(), 1);
  thread_local NearInX near;
  near.set(points.size(), [&](std::size_t i) { return points[i]->point.x(); });
  for (std::size_t i = 0; i < points.size(); ++i)
    near.visit(points[i]->point.x(), radius, [&](std::size_t j) {
      if (i == j || !same_side(*points[i], *points[j])) return;
      const double distance = (points[i]->point - points[j]->point).norm();
      here[i] += all.counts[j] * std::max(0.0, 1 - distance / radius);
    });
  double places = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // of one normal all have the same places
    const bool as_before = i > 0 && points[i]->normal == points[i - 1]->normal &&
                           points[i]->tag.reference == points[i - 1]->tag.reference;
    if (!as_before) places = 0;
    for (std::size_t j = 0; j < points.size() && !as_before; ++j)
      if (i == j || same_plane(*points[i], *points[j]))
        places += all.counts[j] / here[j] + all.beyond[j];
    points[i]->contact.share =
        std::min(1 / std::max(1.0, places * here[i]), most_share(*points[i]));
  }
}

// Of the contacts of two dynamic bodies.
void share_pair(Points& points, const Body& a, const Body& b) {
  const auto any = [](const NewContact&, const NewContact&) { return true; };
  share(points, answer::same_place * std::min(a.least_width, b.least_width), any, any);
}

// Of the contacts of one dynamic body with the ground.
void share_ground(Points& points, const Body& body) {
  // seen from the ground all normals point the same way
  const auto cosine = [&](const NewContact& x, const NewContact& y) {
    const double sign = (x.tag.reference == body.id()) == (y.tag.reference == body.id()) ? 1 : -1;
    return sign * x.normal.dot(y.normal);
  };
  const auto same_plane = [&](const NewContact& x, const NewContact& y) {
    return cosine(x, y) > 1 - 0.5 * answer::coplanar * answer::coplanar;
  };
  const auto same_side = [&](const NewContact& x, const NewContact& y) {
    return cosine(x, y) > answer::same_normal;
  };
  share(points, answer::same_place * body.least_width, same_plane, same_side);
}

}  // namespace

void share_stiffness(const Scene& scene, Contacts& contacts) {
  thread_local std::vector<std::pair<BodyId, std::uint32_t>> on_ground;
  thread_local Points points;
  on_ground.clear();
  for (const ContactPair& pair : contacts.pairs) {
    const bool a_moves = scene.body(pair.a()).dynamic(), b_moves = scene.body(pair.b()).dynamic();
    points.clear();
    each_contact(pair, [&](std::uint32_t c) {
      if (!(a_moves && b_moves)) on_ground.push_back({a_moves ? pair.a() : pair.b(), c});
      points.contacts.push_back(&contacts.all[c]);
    });
    if (a_moves && b_moves) share_pair(points, scene.body(pair.a()), scene.body(pair.b()));
  }

  std::sort(on_ground.begin(), on_ground.end());
  for (std::size_t i = 0, j = 0; i < on_ground.size(); i = j) {
    for (j = i; j < on_ground.size() && on_ground[j].first == on_ground[i].first;) ++j;
    points.clear();
    for (std::size_t k = i; k < j; ++k)
      points.contacts.push_back(&contacts.all[on_ground[k].second]);
    share_ground(points, scene.body(on_ground[i].first));
  }
}

}  // namespace tw
