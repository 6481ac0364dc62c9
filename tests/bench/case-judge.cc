// How far a run of a case is from what is known, by the kind of case.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/case-judge.h"

#include <cmath>

#include "bench/made-cases.h"
#include "bench/overlap.h"
#include "support/case-motion.h"

namespace tw::bench {

namespace {

using test::Numbers3;
using Rows = std::vector<std::vector<double>>;

constexpr double settled = 1;         // s
constexpr double sample = 1.0 / 960;  // s: of what is averaged over time
constexpr double frame = 1.0 / 30;    // s: of what is looked for in moving heaps

Vec3 vector_of(const Numbers3& x) { return {x[0], x[1], x[2]}; }
Quat rotation_of(const std::array<double, 4>& q) { return Quat(q[0], q[1], q[2], q[3]); }

Vec3 position(const CaseEngine& engine, std::size_t body) {
  return vector_of(engine.state(body).position);
}

// A NaN is to stay one.
void raise(double& worst, double x) {
  if (!(x <= worst)) worst = x;
}

// ---- against an exact result at the end ----

double attitude_error(const CaseEngine& engine, const Rows& exact) {
  const auto& e = exact.at(0);
  const Quat q(e[3], e[4], e[5], e[6]);
  return 2 * (rotation_of(engine.state(0).orientation).normalized() * q.conjugate()).vec().norm();
}

double worst_position(const CaseEngine& engine, const Rows& exact) {
  double worst = 0;
  for (const auto& row : exact) {
    const Vec3 x = position(engine, static_cast<std::size_t>(row[0]));
    raise(worst, (x - Vec3(row[1], row[2], row[3])).norm());
  }
  return worst;
}

// Of the far end of the last rod.
double tip_error(const CaseEngine& engine, const CaseTable& c, const Rows& exact) {
  const EngineState last = engine.state(c.bodies.size() - 1);
  const Vec3 half(0.5 * c.bodies.back().size[0], 0, 0);
  const Vec3 tip = vector_of(last.position) + rotation_of(last.orientation).normalized() * half;
  return (tip - Vec3(exact.at(0)[0], exact[0][1], exact[0][2])).norm();
}

// Of the ground, the first body.
Vec3 normal_of(const CaseTable& c) { return rotation_of(c.bodies[0].orientation) * Vec3::UnitZ(); }

// Where a cube is on a slope under Coulomb's friction that does not hold it: along the slope, for
// how deep it sinks in is each engine's own law of contact.
double slide_error(const CaseEngine& engine, const CaseTable& c) {
  const Vec3 normal = normal_of(c), gravity = vector_of(c.gravity);
  const double press = -gravity.dot(normal);
  const Vec3 pull = gravity + press * normal;
  const double rate = pull.norm() - c.friction * press;
  const double way = 0.5 * rate * c.duration * c.duration;
  const Vec3 moved = position(engine, 1) - vector_of(c.bodies[1].position);
  return std::abs(moved.dot(pull.normalized()) - way);
}

class EndJudge : public CaseJudge {
 public:
  explicit EndJudge(const CaseTable& c) : case_(c) {
    if (c.name != "slide") exact_ = exact_result(c.name);
  }
  double interval() const override { return case_.duration; }
  void look(double, const CaseEngine& engine) override {
    if (case_.name == "brick")
      error_ = attitude_error(engine, exact_);
    else if (case_.name == "bounce")
      error_ = std::abs(position(engine, 1).z() - exact_.at(0)[0]);
    else if (!case_.hinges.empty())
      error_ = tip_error(engine, case_, exact_);
    else if (case_.name == "slide")
      error_ = slide_error(engine, case_);
    else
      error_ = worst_position(engine, exact_);
  }
  double error() const override { return error_; }

 private:
  const CaseTable& case_;
  Rows exact_;
  double error_ = 0;
};

// ---- what should stand still ----

// How far the body that has moved most is from where it was; on a slope along it.
class DriftJudge : public CaseJudge {
 public:
  explicit DriftJudge(const CaseTable& c) : case_(c) {}
  double interval() const override { return settled; }
  void look(double time, const CaseEngine& engine) override {
    std::vector<Vec3> now;
    for (std::size_t i = 0; i < case_.bodies.size(); ++i)
      now.push_back(case_.bodies[i].fixed ? vector_of(case_.bodies[i].position)
                                          : position(engine, i));
    if (time == 0) start_ = now;
    if (time <= settled) middle_ = now;
    error_ = drift(start_, now);
    settled_error_ = drift(middle_, now);
  }
  double error() const override { return error_; }
  double settled_error() const override { return settled_error_; }

 private:
  double drift(const std::vector<Vec3>& from, const std::vector<Vec3>& to) const {
    const Vec3 normal = normal_of(case_);
    const bool slope = normal.z() < 0.999;
    double worst = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      Vec3 d = to[i] - from[i];
      if (slope) d -= normal.dot(d) * normal;
      raise(worst, d.norm());
    }
    return worst;
  }

  const CaseTable& case_;
  std::vector<Vec3> start_, middle_;
  double error_ = 0, settled_error_ = 0;
};

// ---- SimBenchmark: roots of means over time ----

// The root of the mean of what a case is judged by at each instant.
class MeanJudge : public CaseJudge {
 public:
  explicit MeanJudge(const CaseTable& c) : case_(c) {}
  double interval() const override { return sample; }
  void look(double time, const CaseEngine& engine) override {
    sum_ += square(time, engine);
    ++count_;
  }
  double error() const override { return std::sqrt(sum_ / count_); }

 protected:
  virtual double square(double time, const CaseEngine& engine) = 0;
  const CaseTable& case_;

 private:
  double sum_ = 0, count_ = 0;
};

// Velocities of the box and of the first ball, m/s.  As balls roll, the box carries 2/7 of their
// mass along, (M + 2/7 n m) a = F - mu (M + n m) g, and each ball accelerates by 2/7 a.
class RollingJudge : public MeanJudge {
 public:
  explicit RollingJudge(const CaseTable& c) : MeanJudge(c) {
    const test::CaseBody& box = c.bodies[1];
    const double balls = static_cast<double>(c.bodies.size() - 2) * c.bodies[2].mass;
    const Vec3 force = vector_of(box.force);
    const double friction = -c.bodies[0].friction * (box.mass + balls) * c.gravity[2];
    acceleration_ = (force.norm() - friction) / (box.mass + 2.0 / 7 * balls) * force.normalized();
  }

 protected:
  double square(double time, const CaseEngine& engine) override {
    const Vec3 expected = time * acceleration_;
    return (vector_of(engine.state(1).velocity) - expected).squaredNorm() +
           (vector_of(engine.state(2).velocity) - 2.0 / 7 * expected).squaredNorm();
  }

 private:
  Vec3 acceleration_;
};

// The energy's change since the start, over the energy at the start above the ground.
class EnergyJudge : public MeanJudge {
 public:
  using MeanJudge::MeanJudge;

 protected:
  // m v^2/2 + I w^2/2 + m g z, of balls
  double square(double time, const CaseEngine& engine) override {
    double now = 0;
    for (std::size_t i = 0; i < case_.bodies.size(); ++i) {
      const test::CaseBody& body = case_.bodies[i];
      if (body.fixed) continue;
      const EngineState state = engine.state(i);
      now += 0.5 * body.mass * vector_of(state.velocity).squaredNorm() +
             0.5 * body.inertia[0] * vector_of(state.angular_velocity).squaredNorm() -
             body.mass * case_.gravity[2] * state.position[2];
    }
    if (time == 0) start_ = now;
    return std::pow((now - start_) / start_, 2);
  }

 private:
  double start_ = 0;
};

// Depths of balls in each other and in the ground, m: the sum of their squares.
class BallsJudge : public MeanJudge {
 public:
  using MeanJudge::MeanJudge;

 protected:
  double square(double, const CaseEngine& engine) override {
    centers_.clear();
    for (std::size_t i = 1; i < case_.bodies.size(); ++i) centers_.push_back(position(engine, i));
    const double radius = case_.bodies[1].size[0];
    const auto square_of = [](double depth) { return depth > 0 ? depth * depth : 0; };
    double sum = 0;
    for (std::size_t i = 0; i < centers_.size(); ++i) {
      const Vec3& x = centers_[i];
      if (!is_finite(x)) return x.sum();
      sum += square_of(radius - x.z());
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 apart = x - centers_[j];
        if (apart.squaredNorm() < 4 * radius * radius) sum += square_of(2 * radius - apart.norm());
      }
    }
    return sum;
  }

 private:
  std::vector<Vec3> centers_;
};

// ---- moving heaps ----

// The deepest overlap of any two bodies of which one is free, at any frame, m.
class DepthJudge : public CaseJudge {
 public:
  explicit DepthJudge(const CaseTable& c) : case_(c), shapes_(c.bodies.size()) {
    for (std::size_t i = 0; i < c.bodies.size(); ++i) {
      const test::CaseBody& body = c.bodies[i];
      if (body.shape == "sphere")
        shapes_[i].radius = body.size[0];
      else
        shapes_[i].half_edges = vector_of(body.size);
    }
  }
  double interval() const override { return frame; }
  void look(double time, const CaseEngine& engine) override {
    for (std::size_t i = 0; i < shapes_.size(); ++i) place(i, time, engine);
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (!is_finite(shapes_[i].frame.p)) raise(depth_, shapes_[i].frame.p.sum());
      for (std::size_t j = 0; j < i; ++j)
        if (!case_.bodies[i].driven || !case_.bodies[j].driven)
          raise(depth_, overlap(shapes_[i], shapes_[j]));
    }
  }
  double error() const override { return depth_; }

 private:
  void place(std::size_t i, double time, const CaseEngine& engine) {
    const test::CaseBody& body = case_.bodies[i];
    Pose pose;
    if (body.driven) {
      const test::CaseBody now = test::driven_body(body, case_.motion, time);
      pose = {vector_of(now.position), rotation_of(now.orientation)};
    } else {
      const EngineState state = engine.state(i);
      pose = {vector_of(state.position), rotation_of(state.orientation).normalized()};
    }
    shapes_[i].frame = Frame(pose);
  }

  const CaseTable& case_;
  std::vector<BoxOrBall> shapes_;
  double depth_ = 0;
};

}  // namespace

bool stands_still(const std::string& name) {
  return name == "creep" || name == "stack" || name == "kapla";
}

std::string unit_of(const std::string& name) {
  if (name == "brick") return "rad";
  if (name == "rolling" || name == "rolling-diagonal") return "m/s";
  return name == "bouncing" || name == "elastic-666" ? "of the energy" : "m";
}

std::unique_ptr<CaseJudge> judge_of(const CaseTable& c) {
  if (stands_still(c.name)) return std::make_unique<DriftJudge>(c);
  if (is_heap(c.name)) return std::make_unique<DepthJudge>(c);
  if (c.name == "rolling" || c.name == "rolling-diagonal") return std::make_unique<RollingJudge>(c);
  if (c.name == "bouncing" || c.name == "elastic-666") return std::make_unique<EnergyJudge>(c);
  if (c.name == "666") return std::make_unique<BallsJudge>(c);
  return std::make_unique<EndJudge>(c);
}

}  // namespace tw::bench
