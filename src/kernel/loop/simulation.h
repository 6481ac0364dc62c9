// What all parts of the kernel share: the scene, the states, the events, and the committed present.
//
// No logic: who may change what is said by the parts that hold a reference to it (kernel.h).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "base/parallel.h"
#include "collision/broad/broad-phase.h"
#include "groups/before.h"
#include "groups/contacts/surroundings.h"
#include "kernel/check/adversary.h"
#include "kernel/loop/policy.h"
#include "kernel/loop/present.h"
#include "kernel/world/options.h"
#include "timeline/event-queue.h"
#include "timeline/process.h"
#include "timeline/state-graph.h"

namespace tw {

struct Simulation {
  WorldOptions options;
  Present present;
  std::unique_ptr<Policy> policy = make_policy("timewarp");
  Scene scene{present.settings};
  std::vector<Process> processes;  // by number
  StateGraph graph;
  EventQueue queue;
  Adversary adversary;
  BroadPhase grid;
  std::vector<BodyId> unbounded;  // bodies that no box holds: every claim tests them
  std::vector<BodyId> kinematic;  // bodies that move by a given function of time
  Surroundings surroundings{scene, grid, unbounded};
  bool running = false;
  // Procedures of users are called while arcs are looked at: all is done in their thread.
  bool calls_out = false;
  std::unique_ptr<Team> team;  // that shares loops; null until the first run

  Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Body& body(BodyId id) const { return *scene.bodies[id]; }
  // The body of a process that has one.
  const Body& body_of(ProcessId id) const { return scene.body_of(id); }
  ProcessId process_of(BodyId id) const { return scene.process_of(id); }
  Process& process(const Body& body) { return processes[number(body.process)]; }
  const Process& process(const Body& body) const { return processes[number(body.process)]; }
  // As many as a run may take.
  int threads() const { return options.threads > 0 ? options.threads : Team::cores(); }
  // What stands before a key, and what groups are decided by; as it was when so many had entered.
  Before before(const Key& key, ReadLog* log = nullptr,
                std::uint64_t entered = StateGraph::all_states) const {
    return Before(scene, graph, key, log, entered);
  }

  void schedule(EventQueue::Handle& handle, const Key& key, EventKind kind, std::uint32_t subject,
                double head_start) {
    queue.schedule(handle, adversary.event(key, kind, subject, head_start));
  }

  // Joints follow the gravity that is set.
  void scale_joints();

  // UserError: "WHAT inside a callback or observer; expected ...", "WHAT after the simulation ...".
  void require_between_runs(const char* what) const;
  void require_before_first_run(const char* what) const;
};

}  // namespace tw
