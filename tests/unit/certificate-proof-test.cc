// Certificates over random shapes and motions: none passes a time at which the two overlap.
//
// A certificate that is wrong is a collision that is missed, and nothing would tell.  So each of
// ten thousand pairs is followed from certificate to certificate, and what is said to be apart is
// looked at in between by the cold distance query.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "detect/approach.h"
#include "detect/certificate.h"
#include "support/dice.h"
#include "support/flyer.h"

namespace tw::test {
namespace {

ShapePtr random_part(Dice& dice) {
  const double size = dice.between(0.1, 1);
  const auto side = [&] { return size * dice.between(0.05, 1); };
  switch (dice.below(7)) {
    case 0: return make_sphere(side());
    case 1: return make_box({side(), side(), side()});
    case 2: return make_cylinder(side(), side());
    case 3: return make_capsule(side(), side());
    case 4: return make_cone(side(), side());
    case 5: return make_ellipsoid({side(), side(), side()});
    default: {
      std::vector<Vec3> points;
      for (int i = 0; i < 12; ++i) points.push_back(dice.cube(size));
      return make_hull(points);
    }
  }
}

ShapePtr random_shape(Dice& dice) {
  if (dice.below(5) > 0) return random_part(dice);
  // a union of two, side by side or in each other
  return make_union({random_part(dice), random_part(dice)});
}

Flyer random_flyer(Dice& dice, BodyId id, const Vec3& place) {
  Flyer flyer(id, random_shape(dice), place + dice.cube(0.3), dice.cube(3), dice.cube(1));
  flyer.state.q = dice.turn();
  let_fly(flyer.body, flyer.state);
  return flyer;
}

struct Followed {
  double time = 0;  // s, that was certified
  int certificates = 0, looks = 0;
  double deepest = 0;  // m, of what was certified as apart, as a negative distance
};

Followed follow(unsigned seed) {
  Dice dice(seed);
  const Flyer a = random_flyer(dice, 0, Vec3::Zero());
  const Flyer b = random_flyer(dice, 1, Vec3(dice.between(0.5, 3), 0, 0));
  const Piece piece = between(a, b);
  SimplexCaches caches;
  Followed followed;
  constexpr int most = 12, looks = 8;
  for (; followed.certificates < most && followed.time < 2; ++followed.certificates) {
    const double clear = certificate(piece, caches, followed.time, 0);
    if (!(clear > followed.time)) break;
    const double until = std::min(clear, 2.0), length = until - followed.time;
    for (int i = 1; i <= looks; ++i, ++followed.looks) {
      // most of them late, where it would be passed
      const double share = 1 - std::pow(0.5, i) * (i < looks);
      const double when = followed.time + share * length;
      followed.deepest = std::min(followed.deepest, separation_at(piece, when).distance);
    }
    followed.time = until;
  }
  return followed;
}

TEST(CertificateProof, ten_thousand_pairs_are_apart_for_as_long_as_they_are_said_to_be) {
  Followed all;
  for (unsigned seed = 1; seed <= 10000; ++seed) {
    const Followed one = follow(seed);
    all.time += one.time;
    all.certificates += one.certificates;
    all.looks += one.looks;
    // distances of round shapes are found to some thousand roundings of their size at most
    EXPECT_GT(one.deepest, -1e-12) << "seed " << seed;
  }
  // they were asked something, and led somewhere
  EXPECT_GT(all.certificates, 30000);
  EXPECT_GT(all.looks, 200000);
  EXPECT_GT(all.time, 2000);
}

}  // namespace
}  // namespace tw::test
