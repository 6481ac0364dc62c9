// The cost of multibodies' algorithms: forward dynamics of chains and of a car, beside Simbody and
// MuJoCo where they are installed, which is a table of doc/performance.md; derivatives, mass matrix
// and impulses.
//
// Counters: ns per link; `off`, the largest difference from our accelerations of joints over their
// largest.  Every evaluation is at another state, so that nothing is found in a cache.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/random.h"
#include "bench/bench-table.h"
#include "multibody/derivatives.h"
#include "multibody/forward-dynamics.h"
#include "multibody/impulses.h"
#include "multibody/joint-laws.h"
#include "support/dynamics-engine.h"

namespace tw::bench {
namespace {

using namespace multibody;
using test::DynamicsEngine;
using test::Links;

class OwnEngine : public DynamicsEngine {
 public:
  OwnEngine(const Links& links, const Vec3& gravity) : tree_(links) { around_.gravity = gravity; }
  void accelerations(const double* q, const double* u, const double* tau, double* rate) override {
    const auto nq = static_cast<std::size_t>(tree_.nq()), nv = static_cast<std::size_t>(tree_.nv());
    Inputs inputs;
    inputs.torques = In(tau, nv);
    joint_torques(tree_, In(q, nq), In(u, nv), inputs, total_);
    place(tree_, In(q, nq), In(u, nv), around_, k_);
    forward_dynamics(tree_, k_, total_, a_, Out(rate, nv));
  }

 private:
  Tree tree_;
  BaseMotion around_;
  Kinematics k_{tree_};
  Articulation a_{tree_};
  std::vector<double> total_ = std::vector<double>(static_cast<std::size_t>(tree_.nv()));
};

std::unique_ptr<DynamicsEngine> make_timewarp(const Links& links, const Vec3& gravity) {
  return std::make_unique<OwnEngine>(links, gravity);
}

LinkSpec part(const std::string& name, const std::string& parent, const Vec3& at, const Vec3& axis,
              double mass, const Vec3& moments) {
  LinkSpec link;
  link.name = name;
  link.parent = parent;
  link.joint.placement.p = at;
  link.joint.axis = axis;
  link.mass = mass;
  link.inertia = moments.asDiagonal();
  return link;
}

// Rods of 1 m whose axes take turns.
Links chain(int count) {
  Links links;
  for (int i = 0; i < count; ++i) {
    links.push_back(part(std::to_string(i), i > 0 ? std::to_string(i - 1) : "",
                         {i > 0 ? 1.0 : 0.0, 0, 0}, i % 2 ? Vec3::UnitZ() : Vec3::UnitY(), 1,
                         {0.01, 0.09, 0.09}));
    links.back().center_of_mass = {0.5, 0, 0};
  }
  return links;
}

// Chassis, two knuckles, four wheels.
Links car() {
  Links links{part("chassis", "", Vec3::Zero(), Vec3::UnitZ(), 1000, {300, 1000, 1200})};
  links[0].joint.kind = JointKind::free;
  for (double side : {-0.8, 0.8}) {
    const std::string name = side < 0 ? "right" : "left";
    links.push_back(part(name, "chassis", {1.3, side, -0.3}, Vec3::UnitZ(), 20, {0.5, 0.5, 0.5}));
    links.push_back(part("front " + name, name, {0, 0.1 * side, 0}, Vec3::UnitY(), 20, {1, 2, 1}));
    links.push_back(
        part("rear " + name, "chassis", {-1.3, side, -0.3}, Vec3::UnitY(), 20, {1, 2, 1}));
  }
  return links;
}

struct States {
  static constexpr std::size_t count = 16;
  std::vector<double> q[count], u[count], tau;

  explicit States(const Tree& tree) {
    Random random(1);
    const auto nv = static_cast<std::size_t>(tree.nv());
    for (std::size_t s = 0; s < count; ++s) {
      std::vector<double> z(nv);
      q[s].resize(static_cast<std::size_t>(tree.nq()));
      u[s].resize(nv);
      for (double& x : z) x = random.real(-1, 1);
      for (double& x : u[s]) x = random.real(-1, 1);
      neutral_position(tree, q[s]);
      displace(tree, q[s], z, q[s]);
    }
    tau.resize(nv);
    // MuJoCo's free joint has the angular velocity in the body's frame: still, they agree
    const bool free = tree.link(0).joint == JointKind::free;
    if (free)
      for (std::size_t s = 0; s < count; ++s) std::fill_n(u[s].begin() + 3, 3, 0.0);
    for (std::size_t i = free ? 6 : 0; i < nv; ++i) tau[i] = random.real(-1, 1);
  }
};

using Make = std::unique_ptr<DynamicsEngine> (*)(const Links&, const Vec3&);

double difference(DynamicsEngine& engine, DynamicsEngine& own, const Tree& tree,
                  const States& states) {
  std::vector<double> theirs(states.tau.size()), ours(theirs);
  engine.accelerations(states.q[0].data(), states.u[0].data(), states.tau.data(), theirs.data());
  own.accelerations(states.q[0].data(), states.u[0].data(), states.tau.data(), ours.data());
  double most = 0, largest = 0;
  for (std::size_t i = tree.link(0).joint == JointKind::free ? 6 : 0; i < ours.size(); ++i) {
    most = std::max(most, std::abs(theirs[i] - ours[i]));
    largest = std::max(largest, std::abs(ours[i]));
  }
  return most / largest;
}

void forward(benchmark::State& state, const Links& links, Make make) {
  const Tree tree(links);
  const States states(tree);
  const Vec3 gravity(0, 0, -9.81);
  const auto engine = make(links, gravity), own = make_timewarp(links, gravity);
  std::vector<double> rate(states.tau.size());
  std::size_t at = 0;
  for (auto _ : state) {
    at = (at + 1) % States::count;
    engine->accelerations(states.q[at].data(), states.u[at].data(), states.tau.data(), rate.data());
    benchmark::DoNotOptimize(rate.data());
  }
  // seconds, which are printed as n: nanoseconds
  state.counters["link"] = benchmark::Counter(
      static_cast<double>(links.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["off"] = difference(*engine, *own, tree, states);
}

// Ours, placed, at one state.
struct Placed {
  Tree tree;
  States states{tree};
  Kinematics k{tree};
  Articulation a{tree};

  explicit Placed(const Links& links) : tree(links) {
    place(tree, states.q[0], states.u[0], BaseMotion(), k);
    factor(tree, k, a);
  }
};

void kinematics(benchmark::State& state, const Links& links) {
  Placed p(links);
  std::size_t at = 0;
  for (auto _ : state) {
    at = (at + 1) % States::count;
    place(p.tree, p.states.q[at], p.states.u[at], BaseMotion(), p.k);
    benchmark::DoNotOptimize(p.k.nodes.data());
  }
}

void linearisation(benchmark::State& state, const Links& links) {
  Placed p(links);
  Linearisation work(p.tree);
  const std::vector<double>& rate = p.states.tau;
  std::vector<double> M(rate.size() * rate.size()), Kq(M), Ku(M);
  work.clear_wrenches();
  for (auto _ : state) {
    linearise(p.tree, p.k, rate, work, M, Kq, Ku);
    benchmark::DoNotOptimize(Kq.data());
  }
}

void masses(benchmark::State& state, const Links& links) {
  Placed p(links);
  InverseDynamics work(p.tree);
  std::vector<double> M(p.states.tau.size() * p.states.tau.size());
  for (auto _ : state) {
    mass_matrix(p.tree, p.k, work, M);
    benchmark::DoNotOptimize(M.data());
  }
}

void point_inertia(benchmark::State& state, const Links& links) {
  Placed p(links);
  Vec3 point(1, 2, 3);
  for (auto _ : state) {
    benchmark::DoNotOptimize(point);
    Mat3 K = inverse_inertia({p.tree, p.k, p.a}, p.tree.link_count() - 1, point);
    benchmark::DoNotOptimize(K);
  }
}

void impulse(benchmark::State& state, const Links& links) {
  Placed p(links);
  ImpulseWork work(p.tree);
  const std::vector<LinkImpulse> impulses{
      {p.tree.link_count() - 1, Vec3::Ones(), Vec3::Ones(), Vec3::Zero()}};
  std::vector<double> du(p.states.tau.size());
  for (auto _ : state) {
    velocity_change({p.tree, p.k, p.a}, impulses, {}, work, du);
    benchmark::DoNotOptimize(du.data());
  }
}

void register_all() {
  std::vector<std::pair<std::string, Links>> cases;
  for (int count : {1, 2, 5, 10, 20, 50})
    cases.emplace_back("chain " + std::to_string(count), chain(count));
  cases.emplace_back("car", car());
  std::vector<std::pair<std::string, Make>> engines{{"timewarp", make_timewarp}};
#ifdef TW_SIMBODY
  engines.emplace_back("simbody", test::make_simbody);
#endif
#ifdef TW_MUJOCO
  engines.emplace_back("mujoco", test::make_mujoco);
#endif
  for (const auto& [name, links] : cases)
    for (const auto& [engine, make] : engines)
      benchmark::RegisterBenchmark(("forward/" + name + "/" + engine).c_str(), forward, links,
                                   make);
  for (const auto& [name, links] : cases) {
    benchmark::RegisterBenchmark(("kinematics/" + name).c_str(), kinematics, links);
    benchmark::RegisterBenchmark(("linearisation/" + name).c_str(), linearisation, links);
    benchmark::RegisterBenchmark(("mass matrix/" + name).c_str(), masses, links);
    benchmark::RegisterBenchmark(("inverse inertia/" + name).c_str(), point_inertia, links);
    benchmark::RegisterBenchmark(("impulse/" + name).c_str(), impulse, links);
  }
}

// Prints as usual, and keeps what forward dynamics took, ns a link, by tree and engine.
class Reporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const std::string& name = run.run_name.function_name;
      const std::size_t tree = name.find('/') + 1, engine = name.rfind('/') + 1;
      if (!name.starts_with("forward/") || !run.counters.count("link")) continue;
      const std::string key = name.substr(tree, engine - 1 - tree);
      if (rows_.empty() || rows_.back().first != key) rows_.emplace_back(key, Costs());
      rows_.back().second[name.substr(engine)] = 1e9 * run.counters.at("link").value;
    }
  }
  void print_table() {
    Table table("forward-dynamics", "tree | timewarp | MuJoCo | Simbody");
    for (auto& [tree, costs] : rows_)
      table.row("%s | %s | %s | %s", tree.c_str(), cell(costs["timewarp"]).c_str(),
                cell(costs["mujoco"]).c_str(), cell(costs["simbody"]).c_str());
  }

 private:
  using Costs = std::map<std::string, double>;
  static std::string cell(double ns) {
    return ns > 0 ? std::to_string(std::lround(ns)) : std::string();
  }
  std::vector<std::pair<std::string, Costs>> rows_;
};

}  // namespace
}  // namespace tw::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  tw::bench::register_all();
  tw::bench::Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_table();
  return 0;
}
