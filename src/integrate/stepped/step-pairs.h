// The pairs of a cluster: who is near whom, and where they touch.
//
// Pairs are of parts, of a member (`b`) and either what does not belong to the cluster or a member
// before it (`a`).  Who is near is found by boxes with room for some steps, which are made anew
// when a body leaves its own.  A pair is looked at by motion, not by step.  One that is apart is
// passed over as long as the axis along which it was seen apart, as it was in the world, still
// separates the two: along it they come nearer by their centres' motion along it, and by no more
// than they turn.  One in contact keeps its points, a plane of the one and a point of the other,
// until they have moved against each other by a share of the lesser size; to slide along a face is
// no motion while the points stay on it.
//
// All goes in the order of the members and of the pairs of each, so that contacts have one order
// whatever was found first.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "collision/broad/spatial-hash.h"
#include "collision/look/look.h"
#include "integrate/stepped/contact-sweeps.h"
#include "integrate/stepped/step-bodies.h"

namespace tw {

// What holds between two bodies of a cluster.
struct StepLaw {
  double friction = 0, restitution = 0;
  bool collide = true;
};
// By numbers of bodies, members first.
using StepLaws = std::function<StepLaw(int a, int b)>;

struct StepCounts {
  std::uint64_t looks = 0, follows = 0, skips = 0, refits = 0, contacts = 0;
  std::uint64_t steps = 0, halvings = 0;
};

class StepPairs {
 public:
  // The first `members` bodies move; all must outlive it.  `follow`: the share of the size by which
  // a pair may move before it is looked at again.
  StepPairs(std::vector<StepBody>& bodies, int members, StepLaws laws, const Vec3& gravity,
            double follow);

  // Renews what is near and where it touches for a step of h to come.
  void look(double h);
  // Contacts as they are now.  Returns the greatest depth, m, among pairs that have got deeper than
  // `depth` and than at the last call; 0: there are none.
  double gather(double depth, std::vector<StepContact>& contacts);
  // Keeps the impulses of contacts that `gather` told.
  void keep_impulses(std::span<const StepContact> contacts);
  double deepest() const { return deepest_; }  // m, at the last `gather`
  const StepCounts& counts() const { return counts_; }

  // What looks change is written down from now on; to be taken back, or kept.
  void begin_log();
  void end_log() { logging_ = false; }
  void take_back();

 private:
  struct Point {
    LookPoint at;
    double impulse = 0;
    Vec3 tangential = Vec3::Zero();  // world
    int age = 0;                     // looks since it was found
    bool is_lone = false;            // between edges
  };
  struct Pair {
    int a = 0, b = 0;
    std::size_t part_a = 0, part_b = 0;
    StepLaw law;
    bool is_round = false;  // two balls: their only point follows them
    bool touches = false;   // it has points
    double reach = 0, distance = 0, room = 0, depth = 0;
    bool on_face = false;
    Vec3 face_normal = Vec3::Zero();  // a's frame
    Mat3 turned = Mat3::Identity();   // b in a, when it was looked at
    Vec3 placed = Vec3::Zero();
    PairMemory memory;
    std::vector<Point> points;
  };
  // A pair in the list of its member b.
  struct Near {
    Vec3 axis = Vec3::Zero();  // world, from a to b, of a pair that is apart
    double room = -1;          // m: how far it may come along that, or move, until it is looked at
    int a = 0, pair = 0;
    std::uint64_t parts = 0;
    bool live = false;  // it has points
  };
  // A pair that was looked at in a step that may be taken back.
  struct Logged {
    int pair = 0;
    bool touched = false;
    Pair before;  // set where it touched: there is nothing to take back to where it had no points
  };

  void set_out(StepBody& body, double h) const;
  void refit(int body);
  void add_near(int member, int other);
  void add_pair(int a, int b, std::size_t part_a, std::size_t part_b, const StepLaw& law);
  bool still_near(const Pair& pair) const;
  void look_at_pair(Near& near);
  bool follows(Near& near, const Pair& pair) const;
  void renew(Near& near, Pair& pair);
  void log(int number, Pair& pair);
  void keep_points(Pair& pair, const PartLook& look, double reach);
  double relative_travel(const Pair& pair) const;
  double size_of(const Pair& pair) const;
  double margin_of(const Pair& pair) const;
  StepBody& body(int number) { return bodies_[static_cast<std::size_t>(number)]; }
  const StepBody& body(int number) const { return bodies_[static_cast<std::size_t>(number)]; }

  std::vector<StepBody>& bodies_;
  int members_;
  StepLaws laws_;
  double follow_;
  Vec3 gravity_;
  SpatialHash hash_;
  std::vector<int> everywhere_;  // bodies without bounds
  struct Fit {
    Aabb box, tight;
    Vec3 x = Vec3::Zero();
    Mat3 R = Mat3::Zero();
    bool made = false;
  };
  std::vector<Fit> fits_;
  std::vector<std::vector<Near>> near_;  // of each member, by a and parts
  std::vector<Pair> pairs_;
  std::vector<int> free_;
  bool logging_ = false;
  std::vector<Logged> log_;
  std::size_t logged_ = 0;  // of these
  double deepest_ = 0;
  StepCounts counts_;
};

}  // namespace tw
