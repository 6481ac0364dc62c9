// The motion of a contact group between two discontinuities: bodies coupled by contact forces,
// integrated implicitly, with dense output.  (What swings widely on springs alone, and a multibody
// that touches nothing, is integrated explicitly: bond-equations.h, joint-equations.h.)
//
// Unknowns per body: x (centre of mass), theta (rotation vector from the step's start, R =
// exp(theta) R0), v, L (world angular momentum, so that no gyroscopic term appears); per anchored
// contact its stretch, and its bend where rolling or spinning is resisted.  RODAS4 (Hairer &
// Wanner), order 4(3), L-stable, stiffly accurate, with the exact Jacobian.  Positions, stretches
// and bends are eliminated exactly: 6 unknowns a body in the linear system.
//
// Between steps: positions and rotation vectors are cubics with the steps' values and rates (x' =
// v, w), so that poses have continuous rates and the bounds hold across steps; velocities, momenta
// and stretches follow the dense output of the method.  Errors of both are of order 4 in the step.
//
// Accuracy (group-arc-bench): on landing, sliding and stacked cubes of 0.2 m the largest error of
// positions was 0.01-0.05 s times the velocity tolerance, with position tolerances of 0.01 to 0.1 s
// times it.
// Cost (2 shared Xeon cores): a step of one body with four contacts 2.4 us, of 10 bodies with 40
// contacts 31, of 64 bodies with 452 contacts 350; construction 0.8, 8, 60.
//
// An arc is a function of its GroupStart alone, bit for bit: it does not matter when or in which
// pieces it is extended.  Completing it and looking at it are two things: what looks never
// integrates, and to look past what was completed is a mistake.
//
// Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.7;
// doc/numerics/integration.md.
// Frames: members by their principal frames P at the centre of mass, outside bodies by the frame
// their motion gives; vectors in the world frame unless a name says otherwise.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/counted.h"
#include "collision/manifold/contact-feature.h"
#include "dynamics/contact-law.h"
#include "dynamics/forces.h"
#include "integrate/arc/arc-end.h"
#include "integrate/trajectory.h"
#include "math/vec.h"
#include "multibody/multibody.h"

namespace tw {

// A body that the arc moves, at the arc's start.
struct GroupMember {
  double mass = 1;              // kg
  Vec3 moments = Vec3::Ones();  // principal, kg m^2
  double radius = 1;            // of the ball about the centre that holds the body, m: error norm
  Vec3 x = Vec3::Zero();
  Quat q = Quat::Identity();
  Vec3 v = Vec3::Zero();
  Vec3 L = Vec3::Zero();       // about the centre, world
  Vec3 force = Vec3::Zero();   // constant, weight included, N
  Vec3 torque = Vec3::Zero();  // constant, about the centre, N m
  ForcesPtr forces;            // that hang on time and on what it does; may be null
  int tree = -1;               // the arc's multibody that it is a link of; -1: it moves by itself
  int link = 0;                // which one
};

// A multibody that the arc moves, at the arc's start.
struct GroupTree {
  std::shared_ptr<const Multibody> multibody;
  MultibodyStatePtr state;
  Vec3 gravity = Vec3::Zero();  // m/s^2
  std::vector<int> members;     // of each link
  std::vector<Vec3> forces;     // on each link's centre of mass, constant, weight not included, N
};

// Whether the core point of b runs over its surface as it rolls.
constexpr bool rolls(ContactFeature feature) {
  return feature == ContactFeature::tangent_plane || feature == ContactFeature::curved;
}

// Ellipsoids that a contact follows: the images A u of the unit vectors u, with the semi-axes as
// columns of A (m, frame of the body), of which one is 0 for a circle and all for a point.
struct ContactEllipsoids {
  Mat3 a = Mat3::Zero(), b = Mat3::Zero();
};

// One contact point.  Body a has the feature, fixed in a's frame; body b a core point, fixed in b's
// frame, with a radius, or a line or circle of such points.
//   plane  n = normal;                    gap = n.(p_b - p_a) - radius_b
//   line   n = s unit((1 - l l^T)(p_b - p_a)), l = direction; gap = s |..| - radius_a - radius_b
//   point  n = s unit(p_b - p_a);         gap = s |p_b - p_a| - radius_a - radius_b
//   crossing: two lines, l = direction and l_b = other_direction, that are not parallel
//          n = s unit(l x l_b);           gap = n.(p_b - p_a) - radius_a - radius_b
//   rim    the same with the tangent of a circle of b, of radius `rim` about point_b, square to
//          other_direction
//   tangent_plane  n = normal, and b has an ellipsoid or a circle about point_b: p_b is its point
//          farthest along -n, where it is lowest; gap = n.(p_b - p_a) - radius_b
//   curved ellipsoids about p_a and p_b, within which the cores of both are points: the n of the
//          greatest gap, n.(p_b - p_a) - radius_a - radius_b, where p_a, p_b are the points of the
//          ellipsoids farthest along n and -n.  Where a has a line, l = direction, its ellipsoid is
//          a point of that and n square to it; else `direction` is 0
// n points from a to b.  The force acts at p_b - radius_b n; of what runs, or rolls, p_b is not
// fixed in b: it runs along both as the bodies slide or roll, and a circle may spin.  s is 1, or -1
// where n would else turn against `normal` (first step) or the n of the step before: cores that
// pass through each other, hollow a.
struct GroupContact {
  int a = 0, b = 0;  // >= 0: member; < 0: outside body ~index
  ContactFeature feature = ContactFeature::plane;
  Vec3 normal = Vec3::UnitZ();     // a's frame, unit: n (plane), or choosing its sign at the start
  Vec3 direction = Vec3::UnitX();  // a's frame, unit: line, crossing, rim; curved: or 0
  Vec3 other_direction = Vec3::UnitY();  // b's frame, unit: crossing, and the axis of a rim
  Vec3 point_a = Vec3::Zero();  // a's frame: a point of the plane, of the line, or the core point
  Vec3 point_b = Vec3::Zero();  // b's frame; a point of its line, or the centre of its rim
  double radius_a = 0, radius_b = 0;
  double rim = 0;                                       // m: of b's circle
  std::shared_ptr<const ContactEllipsoids> ellipsoids;  // tangent plane and curved
  double offset = 0;                                    // m: the depth that presses is offset - gap
  double share = 1;                                     // of k, kt, ct
  ContactConstants law;
  bool pressed = true;          // at the start: packed apart from what is open then
  Vec3 stretch = Vec3::Zero();  // at the start, a's frame, tangential
  // At the start, a's frame, rad: what rolling (across the normal) and spinning (along it) are held
  // back by.
  Vec3 bend = Vec3::Zero();
};

// A spring or hold between two members.
struct GroupBond {
  int a = 0, b = 0;
  BondPtr bond;
};

struct GroupStart {
  double time = 0;  // s
  double end = 0;   // the arc goes no further, s; no base of a multibody has a corner before
  std::vector<GroupMember> members;
  std::vector<GroupTree> trees;
  std::vector<TrajectoryPtr> outside;  // of bodies that the arc meets and does not move
  std::vector<GroupContact> contacts;
  std::vector<GroupBond> bonds;
  double first_step = 0;                             // to be tried first, s; 0: chosen
  int most_steps = std::numeric_limits<int>::max();  // the arc goes no further then
  double position_tolerance = 1e-6;                  // m, of one step (RMS over members)
  double velocity_tolerance = 1e-5;                  // m/s
  // Of a multibody that touches nothing: the error of its joints in one step, rad; 0: it is
  // integrated as groups are.
  double joint_tolerance = 0;
  double joint_size = 1;  // m, of what moves along its joints
  double joint_rate = 1;  // 1/s, how fast it moves by gravity alone
};

struct GroupSample {
  Vec3 x, v, w, L;
  Quat q;
};

// A contact at one instant.
struct ContactForce {
  Vec3 point = Vec3::Zero();     // where it acts
  Vec3 normal = Vec3::UnitZ();   // from a to b
  double gap = 0;                // m, negative: depth
  double normal_force = 0;       // N, >= 0, on b along the normal
  Vec3 friction = Vec3::Zero();  // N, on b
  Vec3 velocity = Vec3::Zero();  // of b's point against a's, m/s
  bool slipping = false;         // the friction is cut at mu N (anchored), N > 0
  Vec3 torque = Vec3::Zero();    // N m, on b, beside that of the force: rolling and spinning

  // On b, or on a.
  Vec3 force_on(bool b) const {
    const Vec3 force = normal_force * normal + friction;
    return b ? force : Vec3(-force);
  }
  Wrench wrench_on(bool b, const Vec3& about) const {
    const Vec3 force = force_on(b);
    return {force, (point - about).cross(force) + (b ? torque : Vec3(-torque))};
  }
};

// A contact of a member, and whether the work at it is asked for.
struct WorkingContact {
  int contact = 0;
  bool counts = false;
};

struct GroupCounts {
  std::uint64_t steps = 0, rejected = 0, factorizations = 0, evaluations = 0;
};

class JointRecord;

class GroupArc : public Counted<GroupArc> {
 public:
  explicit GroupArc(GroupStart start);
  ~GroupArc();
  GroupArc(const GroupArc&) = delete;
  GroupArc& operator=(const GroupArc&) = delete;

  const GroupStart& start() const;
  // Integrates as far as `time`.  False: it stopped before; see last() and failure().
  bool extend(double time);
  // The same; may be given up between two steps (base/interruption.h): for those who have changed
  // nothing yet.
  bool extend_patiently(double time);
  double reached() const;  // how far it is integrated, s
  // How far it goes, s: to the end that its start tells or, found out on the way, to where it has
  // taken its most steps.
  double last() const;
  // Whether all that there will ever be of it is there: to look at it changes nothing any more.
  bool complete() const;
  // Where the members' trajectories end: at the arc's end, or earlier where somebody found out that
  // it does not hold so far.  Told once, before anybody relies on them.
  void lower_ends(std::vector<ArcEnd> ends);
  double end(int member) const;
  const std::vector<ArcEnd>& found_ends() const;  // of each member; empty: the arc's
  // Empty, or why it stopped: a step size under the spacing of doubles or a state that is not
  // finite, with the time and the contact with the largest force.
  const std::string& failure() const;
  int failed_contact() const;  // index, or -1

  // All of the following look only: a time must not lie past what was completed.  Beyond its end,
  // and where it failed, an arc stands still.
  GroupSample evaluate(int member, double time) const;
  // Position and attitude alone, or the position: cheaper.
  void pose(int member, double time, Vec3& x, Quat& q) const;
  Vec3 position(int member, double time) const;
  // Rates of the pose's interpolant itself, continuous in time (differ from v and w by the
  // integration error, and at the ends of steps by rounding): for bounds.
  void pose_rates(int member, double time, Vec3& dx, Vec3& w) const;
  // Both, cheaper than one by one.
  PoseTwist path_at(int member, double time) const;
  MotionBounds bounds(int member, double from, double to) const;
  // As Trajectory's.
  double turn_change_across(const Vec3& n, int member, double from, double to,
                            const MotionBounds& known) const;
  // The end of the step that holds `time`, or begins there: beyond it bounds may be much wider.
  double step_end(double time) const;
  // What the member does over [from, to]: a copy of that stretch, which keeps nothing else of the
  // arc.
  TrajectoryPtr excerpt(int member, double from, double to) const;
  // What the member does; lives as long as the arc (member_trajectory shares it).
  const Trajectory& trajectory(int member) const;
  // How the joints of a multibody stand and move.
  void joints(int tree, double time, std::vector<double>& q, std::vector<double>& u) const;
  const JointRecord& joints_record(int tree) const;
  Vec3 stretch(int contact, double time) const;  // a's frame
  Vec3 bend(int contact, double time) const;     // a's frame, rad; 0 where nothing resists
  ContactForce contact_force(int contact, double time) const;
  // The same, cheaper where few of the group's contacts are asked for at that instant.
  ContactForce lone_contact_force(int contact, double time) const;
  // The work done on a member over [from, to] at those of its contacts that count, by the outside
  // bodies that it meets there, J: force times the outside body's own speed where it acts, torque
  // times its turning.
  // `contacts`: all of the member's.
  double work_on(int member, std::span<const WorkingContact> contacts, double from,
                 double to) const;
  // Of normal springs, and of stretches as far as friction holds them, J; `counted`: which
  // contacts.
  double elastic_energy(double time, const std::vector<bool>& counted) const;
  double elastic_energy(double time) const {
    return elastic_energy(time, std::vector<bool>(start().contacts.size(), true));
  }
  // The step that the controller would take after the arc's end, s: for the next arc's first_step.
  double next_step() const;
  GroupCounts counts() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace tw
