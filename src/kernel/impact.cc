// Impacts: from two arcs that meet to two new states.
//
// Single points by the impact law; face-on: at the manifold's centroid first, then at the deepest
// approaching point until none approaches; simultaneous contacts: the worst approacher first, at most
// 200 impulses.  A soft impact needs contact groups and stops the run with a clear message.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "dynamics/impact-law.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

constexpr int most_impulses = 200;
constexpr std::uint32_t most_microsteps = 100000;

// Points this close take part in an impact, share of the smaller size: a tenth of the accuracy.
constexpr double touch_per_accuracy = 0.1;

// Soft impacts (kernel.md): where gravity is 0 this stands in for it, m/s^2.
constexpr double standard_gravity = 9.81;
constexpr std::uint32_t soft_run = 8;
// The interval of a quick run where the pair is not pressed together, share of that where it is.
constexpr double free_run_share = 1e-2;

// A residual approach below this share of the first one is rounding.
constexpr double residual_approach = 1e-12;

// One body during the resolution of an impact.
struct Resolved {
  const Body& body;
  const ArcPoint& point;
  Vec3 v, w;
  Mat3 inverse_inertia = Mat3::Zero();
  double inverse_mass = 0;
  bool moves;

  Resolved(const Body& b, const ArcPoint& p)
      : body(b), point(p), v(p.v), w(p.w), moves(b.dynamic()) {
    if (!moves) return;
    inverse_mass = 1 / b.mass;
    inverse_inertia = inverse_inertia_world(b, p.q);
  }
  Vec3 velocity_at(const Vec3& where) const { return v + w.cross(where - point.x); }
  Mat3 compliance(const Vec3& where) const {
    if (!moves) return Mat3::Zero();
    return contact_compliance(inverse_mass, inverse_inertia, where - point.x);
  }
  void apply(const Vec3& impulse, const Vec3& where) {
    if (!moves) return;
    v += inverse_mass * impulse;
    w += inverse_inertia * (where - point.x).cross(impulse);
  }
};

// The impact of one pair of bodies while impulses are applied.
struct Resolution {
  Resolved a, b;
  double restitution, friction;
  double normal_impulse = 0, kinematic_work = 0;
  double largest = 0, speed = 0;
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();

  // u.n, negative when approaching
  double approach(const ContactPoint& c) const {
    return (b.velocity_at(c.point) - a.velocity_at(c.point)).dot(c.normal);
  }
  void impulse_at(const ContactPoint& c) {
    const Vec3 u = b.velocity_at(c.point) - a.velocity_at(c.point);
    const Mat3 K = a.compliance(c.point) + b.compliance(c.point);
    const Vec3 impulse = impact_impulse(K, c.normal, u, restitution, friction);
    // a kinematic body does work with the force it exerts at its own speed
    if (!a.moves) kinematic_work += impulse.dot(a.velocity_at(c.point));
    if (!b.moves) kinematic_work -= impulse.dot(b.velocity_at(c.point));
    const double along = impulse.dot(c.normal);
    if (along > largest) {
      largest = along;
      speed = -u.dot(c.normal);
      point = c.point;
      normal = c.normal;
    }
    normal_impulse += along;
    a.apply(-impulse, c.point);
    b.apply(impulse, c.point);
  }
};

// Replaces each manifold of several points by its centroid, the others stay.
std::vector<ContactPoint> centroids(const std::vector<ContactPoint>& points) {
  std::vector<ContactPoint> result;
  for (std::size_t i = 0; i < points.size();) {
    ContactPoint c = points[i];
    Vec3 sum = Vec3::Zero();
    std::size_t j = i;
    for (; j < points.size() && points[j].pair == c.pair; ++j) sum += points[j].point;
    c.point = sum / static_cast<double>(j - i);
    result.push_back(c);
    i = j;
  }
  return result;
}

// Worst approacher first until none approaches.  False if some still does after all impulses.
bool resolve(Resolution& r, const std::vector<ContactPoint>& points, double threshold) {
  for (int i = 0; i < most_impulses; ++i) {
    const ContactPoint* worst = nullptr;
    double least = -threshold;
    for (const ContactPoint& c : points)
      if (const double u = r.approach(c); u < least) {
        least = u;
        worst = &c;
      }
    if (!worst) return true;
    r.impulse_at(*worst);
  }
  return false;
}

ContactPoint sphere_contact(const Body& a, const ArcPoint& pa, const Body& b, const ArcPoint& pb) {
  ContactPoint c;
  if (a.is_fixed_plane) {
    c.normal = a.plane_normal;
    c.point = pb.x - b.sphere_radius * c.normal;
  } else if (b.is_fixed_plane) {
    c.normal = -b.plane_normal;
    c.point = pa.x + a.sphere_radius * c.normal;
  } else {
    const Vec3 r = pb.x - pa.x;
    const double distance = r.norm();
    c.gap = distance - a.sphere_radius - b.sphere_radius;
    if (distance > 0) c.normal = r / distance;
    c.point = 0.5 * ((pa.x + a.sphere_radius * c.normal) + (pb.x - b.sphere_radius * c.normal));
  }
  return c;
}

bool simple(const Body& body) { return body.sphere_radius >= 0 || body.is_fixed_plane; }

double default_fusion_speed(double gravity, double size) {
  return std::max(1e-4, 0.07 * std::sqrt(gravity * size));
}

// The run of impacts after one more at `now`; impacts at one instant count once.
ImpactRun continued(const ImpactRun& run, double now, double tau) {
  if (now == run.last_time) return run;
  if (now - run.last_time < tau) return {run.count + 1, now};
  return {0, now};
}

std::string soft_message(const Body& a, const Body& b, double when, double speed,
                         double fusion_speed) {
  return "soft impact of " + a.info.name + " and " + b.info.name + " at " + show(when) +
         " s: they meet at " + show(speed) + " m/s, under the pair's fusion speed of " +
         show(fusion_speed) +
         " m/s or in a quick run of impacts, and would stay in contact; expected bodies that fly "
         "and bounce, since contact groups are not part of this version (stop earlier with "
         "--until, or lower #:fusion-speed in set-contact-parameters!)";
}

}  // namespace

bool Kernel::wants_collision(const Body& a, const Body& b) const {
  if (!collision_observers.empty()) return true;
  for (const CollisionCallbackDef& def : collision_callbacks)
    if (match_specificity(def.a, def.b, a.contact, b.contact)) return true;
  return false;
}

// Fills the drafts with the motion after the impact.
void Kernel::compute_impact(const Key& key, Draft& a, Draft& b,
                            std::shared_ptr<Collision>& collision) {
  const Body& body_a = *a.body;
  const Body& body_b = *b.body;
  const ContactParameters& contact = contact_parameters(body_a.id(), body_b.id());
  const double size = std::min(body_a.least_width, body_b.least_width);

  // where they touch
  contact_points_.clear();
  if (simple(body_a) && simple(body_b)) {
    contact_points_.push_back(sphere_contact(body_a, a.point, body_b, b.point));
  } else {
    const Frame fa(a.point.q.toRotationMatrix(), a.point.x);
    const Frame fb(b.point.q.toRotationMatrix(), b.point.x);
    touching_points(*body_a.shape_P, fa, *body_b.shape_P, fb,
                    touch_per_accuracy * options.accuracy * size, contact_points_);
    if (contact_points_.empty()) {
      const Separation s = separation(*body_a.shape_P, fa, *body_b.shape_P, fb);
      contact_points_.push_back({0.5 * (s.point_a + s.point_b), s.normal, s.distance, 0});
    }
  }

  // impulses
  Resolution r{{body_a, a.point}, {body_b, b.point}, contact.restitution, contact.friction};
  double worst = 0;
  for (const ContactPoint& c : contact_points_) worst = std::min(worst, r.approach(c));
  const double threshold = residual_approach * -worst;
  bool done = true;
  if (contact_points_.size() > 1) {
    for (const ContactPoint& c : centroids(contact_points_))
      if (r.approach(c) < -threshold) r.impulse_at(c);
  }
  done = resolve(r, contact_points_, threshold);

  // soft: pressed together and slow, a quick run of impacts, or an approach without end
  const double gravity = options.gravity.norm() > 0 ? options.gravity.norm() : standard_gravity;
  const double fusion_speed =
      std::max(1e-9, contact.fusion_speed.value_or(default_fusion_speed(gravity, size)));
  const double d0 = 2.5e-4 * size;
  const Vec3 pull = b.data.acceleration - a.data.acceleration;
  const Vec3 axis = contact_points_.empty() ? r.normal : contact_points_.front().normal;
  const bool pressed = pull.dot(axis) < 0;
  // what nothing presses together may knock about in a corner for a while; a true collapse goes on to
  // ever shorter intervals
  const double tau = std::min(fusion_speed / gravity, pi * std::sqrt(d0 / gravity)) *
                     (pressed ? 1 : free_run_share);
  bool run_a = true, run_b = true;
  if (body_a.dynamic()) {
    a.data.impacts = continued(a.data.impacts, key.time, tau);
    run_a = a.data.impacts.count >= soft_run;
  }
  if (body_b.dynamic()) {
    b.data.impacts = continued(b.data.impacts, key.time, tau);
    run_b = b.data.impacts.count >= soft_run;
  }
  const bool soft = (pressed && -worst < fusion_speed) || (run_a && run_b) || !done;

  if (soft) {
    const UserError error(soft_message(body_a, body_b, key.time, -worst, fusion_speed),
                          body_a.info.place);
    a.data.error = b.data.error = std::make_exception_ptr(error);
  } else if (key.microstep > most_microsteps) {
    const UserError error("more than " + std::to_string(most_microsteps) + " impacts at " +
                          show(key.time) + " s between " + body_a.info.name + " and " +
                          body_b.info.name + "; expected them to part");
    a.data.error = b.data.error = std::make_exception_ptr(error);
  }

  // new arcs
  for (Draft* draft : {&a, &b}) {
    if (!draft->body->dynamic()) continue;
    const Resolved& after = draft == &a ? r.a : r.b;
    draft->data.v = draft->point.v = after.v;
    draft->point.w = after.w;
    draft->data.L = angular_momentum(*draft->body, draft->point.q, after.w);
    draft->data.rotation_ready = false;
  }
  // what is told once stands on the first state that enters the graph
  StateData& teller = a.enters ? a.data : b.data;
  teller.kinematic_work = r.kinematic_work;
  if (wants_collision(body_a, body_b)) {
    collision = std::make_shared<Collision>();
    *collision = {key,     body_a.id(), body_b.id(), key.time,        r.point,
                  r.normal, r.speed,    r.normal_impulse};
    teller.collision = collision;
  }
}

// Every callback that matches, in order of registration.
void Kernel::run_collision_callbacks(const Collision& collision, Draft& a, Draft& b) {
  for (const CollisionCallbackDef& def : collision_callbacks) {
    if (!match_specificity(def.a, def.b, a.body->contact, b.body->contact)) continue;
    // the sides in the order given; where both match either way, the body added first comes first
    const bool straight = side_matches(def.a, a.body->contact) && side_matches(def.b, b.body->contact);
    DraftView view_a(a, collision.key, false, options.gravity);
    DraftView view_b(b, collision.key, false, options.gravity);
    ++counters.callbacks_run;
    if (straight)
      def.callback->run(collision, false, view_a, view_b);
    else
      def.callback->run(collision, true, view_b, view_a);
  }
}

void Kernel::process_impact(std::uint32_t index) {
  const Key key = pairs[index].impact;
  Body& body_a = *bodies[pairs[index].a];
  Body& body_b = *bodies[pairs[index].b];

  // only after the receivers' claims have reached its time
  if (!ready(body_a, key) || !ready(body_b, key)) {
    make_ready(body_a, key);
    make_ready(body_b, key);
    return;
  }

  std::vector<Draft> drafts;
  drafts.reserve(2);
  drafts.push_back(draft_for(body_a, key, body_a.dynamic()));
  drafts.push_back(draft_for(body_b, key, body_b.dynamic()));
  std::shared_ptr<Collision> collision;
  compute_impact(key, drafts[0], drafts[1], collision);

  // callbacks see the drafts; their errors stop the receivers, speculatively
  if (collision && !drafts[0].data.error && !collision_callbacks.empty()) {
    try {
      run_collision_callbacks(*collision, drafts[0], drafts[1]);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      drafts[0].data.error = drafts[1].data.error = std::current_exception();
    }
  }
  enter_discontinuity(key, drafts);
}

}  // namespace tw
