// A spring to what stands or moves as it was given.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/anchored-spring.h"

#include "base/constants.h"
#include "base/hash.h"

namespace tw {
namespace {

class AnchoredSpring final : public ForceLaw {
 public:
  AnchoredSpring(const SpringLaw& law, const Vec3& arm, SpringAnchor other)
      : law_(law), arm_(arm), other_(std::move(other)) {
    if (other_.stands) place_ = Frame(other_.motion->pose(0)) * other_.anchor;
  }

  void add(double time, const PoseTwist& body, Wrench& sum) const override {
    const Reach reach(*this, time, body);
    add_force_at(reach.r, law_.force(reach.d, reach.dv), sum);
  }
  void add_derivative(double time, const PoseTwist& body, WrenchDerivative& sum) const override {
    const Reach reach(*this, time, body);
    Mat3 by_d, by_dv;
    law_.derivative(reach.d, reach.dv, by_d, by_dv);
    add_derivative_at(reach.r, body.w, law_.force(reach.d, reach.dv), by_d, by_dv, sum);
  }
  double energy(double time, const PoseTwist& body) const override {
    return law_.energy(Reach(*this, time, body).d);
  }
  double longest_unlooked() const override { return other_.stands ? never : answer::motion_span; }
  bool hangs_on(BodyId other) const override { return other == other_.body; }
  std::uint64_t hash() const override {
    Hasher h;
    h.add(law_.hash());
    h.add(std::uint64_t{other_.body});
    for (const Vec3* point : {&arm_, &other_.anchor})
      for (int i = 0; i < 3; ++i) h.add((*point)[i]);
    return h.value();
  }

 private:
  // From the point of the body to the anchor.
  struct Reach {
    Vec3 r, d, dv;
    Reach(const AnchoredSpring& spring, double time, const PoseTwist& body)
        : r(body.q * spring.arm_) {
      Vec3 place = spring.place_, velocity = Vec3::Zero();
      if (!spring.other_.stands) {
        const PoseTwist other = spring.other_.motion->at(time);
        const Vec3 arm = other.q * spring.other_.anchor;
        place = other.x + arm;
        velocity = other.v + other.w.cross(arm);
      }
      d = place - body.x - r;
      dv = velocity - body.v - body.w.cross(r);
    }
  };

  SpringLaw law_;
  Vec3 arm_;
  SpringAnchor other_;
  Vec3 place_ = Vec3::Zero();  // of the anchor, where it stands
};

}  // namespace

ForceLawPtr make_anchored_spring(const SpringLaw& law, const Vec3& arm, SpringAnchor anchor) {
  return std::make_shared<AnchoredSpring>(law, arm, std::move(anchor));
}

}  // namespace tw
