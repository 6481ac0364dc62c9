// Scheme primitives: worlds, their settings, and running them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdio>
#include <utility>

#include "base/interruption.h"
#include "record/statistics-json.h"
#include "script/file-names.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_worlds)

namespace {

WorldBox& quiet_box(SCM world, const char* what) {
  require_outside_callbacks(what);
  return to_world_box(world);
}

World& quiet_world(SCM world, const char* what) { return quiet_box(world, what).world; }

// Adds the calls into Guile that happen while it lives to the world's statistics.
class CallCounter {
 public:
  explicit CallCounter(WorldBox& box) : box_(box), before_(guile_calls) {}
  ~CallCounter() { box_.guile_calls += guile_calls - before_; }
  CallCounter(const CallCounter&) = delete;
  CallCounter& operator=(const CallCounter&) = delete;

 private:
  WorldBox& box_;
  std::int64_t before_;
};

// The kernel's statistics and the binding's own.
StatisticsTable all_statistics(const WorldBox& box) {
  StatisticsTable table = box.world.statistics();
  // the kernel knows only the sinks that are still attached
  double cpu_seconds = 0;
  for (auto& [name, value] : table) {
    if (name == "cpu_seconds") cpu_seconds = std::get<double>(value);
    if (box.frames == 0) continue;
    if (name == "frames") value = box.frames;
    if (name == "cpu_seconds_per_frame") value = cpu_seconds / static_cast<double>(box.frames);
  }
  table.emplace_back("guile_calls", box.guile_calls);
  table.emplace_back("callback_cpu_seconds", box.callback_cpu_seconds);
  table.emplace_back("draw_cpu_seconds", box.draw_cpu_seconds);
  return table;
}

SCM from_value(const std::variant<std::int64_t, double, std::string>& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return scm_from_int64(*integer);
  if (const auto* real = std::get_if<double>(&value)) return scm_from_double(*real);
  return from_string(std::get<std::string>(value));
}

// One line on standard error, once a world: what has nowhere to go is no error, but seldom meant.
void warn_of_squeezing(World& world) {
  world.add_collision_observer(
      [&world, warned = false](const Collision& told) mutable {
        if (std::exchange(warned, true)) return;
        const auto name = [&](BodyId id) { return world.body(id).name; };
        const std::string sides = told.body1 == told.body2
                                      ? "within " + name(told.body1)
                                      : "between " + name(told.body1) + " and " + name(told.body2);
        std::fprintf(
            stderr,
            "timewarp: warning: at %s s %s is squeezed %s, %.2g m deep, %.1f %% of the "
            "thinner one's thickness; it has nowhere to go (told once; see `squeezed' in the "
            "statistics, and (observe! 'squeezed ...))\n",
            show(told.time).c_str(), name(told.squeezed).c_str(), sides.c_str(), told.depth,
            100 * told.depth_share);
      },
      CollisionKind::squeezed);
}

struct WorldSetting {
  const char* name;
  void (*set)(World&, SCM value, const char* name);
};

// Settings of a world by name, the test modes among them.
constexpr WorldSetting world_settings[] = {
    {"integrator", [](World& w, SCM v, const char* n) { w.set_integrator(to_string(v, n)); }},
    {"hash", [](World& w, SCM v, const char*) { w.set_hash(to_bool(v)); }},
    {"check", [](World& w, SCM v, const char*) { w.set_check(to_bool(v)); }},
    {"undo-redo", [](World& w, SCM v, const char*) { w.set_undo_redo(to_bool(v)); }},
    {"write-states",
     [](World& w, SCM v, const char* n) { w.set_write_states(to_file_name(v, n)); }},
    {"compare-states",
     [](World& w, SCM v, const char* n) { w.set_compare_states(to_file_name(v, n)); }},
    {"gvt-interval", [](World& w, SCM v, const char* n) { w.set_gvt_interval(to_integer(v, n)); }},
    {"threads",
     [](World& w, SCM v, const char* n) { w.set_threads(static_cast<int>(to_integer(v, n))); }},
    {"window", [](World& w, SCM v, const char* n) { w.set_window_cells(to_real(v, n)); }},
};

struct SceneSetting {
  const char* name;
  void (*read)(SettingChanges&, SCM value, const char* name);
};

// Those that scenes make, too.
constexpr SceneSetting scene_settings[] = {
    {"gravity", [](SettingChanges& c, SCM v, const char* n) { c.gravity = to_vec3(v, n); }},
    {"group-check-rate",
     [](SettingChanges& c, SCM v, const char* n) { c.group_check_rate = to_real(v, n); }},
    {"accuracy", [](SettingChanges& c, SCM v, const char* n) { c.accuracy = to_real(v, n); }},
    {"seed", [](SettingChanges& c, SCM v, const char* n) { c.seed = to_seed(v, n); }},
    {"policy", [](SettingChanges& c, SCM v, const char* n) { c.policy = to_string(v, n); }},
    {"push-overlaps",
     [](SettingChanges& c, SCM v, const char*) {
       c.push_overlaps = to_symbol_name(v, "on-overlap") == "push";
     }},
};

bool read_setting(SettingChanges& changes, SCM name, SCM value) {
  const std::string text = to_symbol_name(name, "the setting");
  for (const SceneSetting& setting : scene_settings)
    if (text == setting.name) {
      setting.read(changes, value, setting.name);
      return true;
    }
  return false;
}

}  // namespace

TW_PRIMITIVE(make_world, "%make-world", (), "Return a new, empty world.") {
  require_outside_callbacks("make-world");
  const SCM handle = make_world_handle();
  warn_of_squeezing(to_world(handle));
  return handle;
}

TW_PRIMITIVE(world_properties, "%world-table", (SCM world), "Return the world's hash table.") {
  to_world(world);
  return world_table(world);
}

TW_PRIMITIVE(set_world, "%set-world!", (SCM world, SCM name, SCM value), "Set a world's setting.") {
  const std::string text = to_symbol_name(name, "the setting");
  World& w = quiet_world(world, "a world's setting");
  SettingChanges changes;
  if (read_setting(changes, name, value)) {
    w.set(changes);
    return SCM_UNSPECIFIED;
  }
  for (const WorldSetting& option : world_settings)
    if (text == option.name) {
      option.set(w, value, option.name);
      return SCM_UNSPECIFIED;
    }
  throw UserError("a world has no setting " + text);
}

TW_PRIMITIVE(set_all, "%set-all!", (SCM world, SCM alist),
             "Make all settings of an alist or, where one is refused, none.") {
  SettingChanges changes;
  for (; scm_is_pair(alist); alist = SCM_CDR(alist))
    TW_REQUIRE(read_setting(changes, SCM_CAAR(alist), SCM_CDAR(alist)),
               "a scene has no setting " + to_symbol_name(SCM_CAAR(alist), "the setting"));
  quiet_world(world, "a world's setting").set(changes);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(set_adversary, "%set-adversary!", (SCM world, SCM seed, SCM head_start, SCM every),
             "Make the scheduler an adversary: a test mode.") {
  AdversaryOptions options;
  options.seed = to_seed(seed, "the adversary's seed");
  options.head_start = to_finite(head_start, "the adversary's head start");
  options.every_event = to_bool(every);
  quiet_world(world, "the adversary").set_adversary(options);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(world_seed, "%world-seed", (SCM world), "Return the seed.") {
  return scm_from_uint64(to_world(world).options().seed);
}

// ---- running ----

TW_PRIMITIVE(advance, "%advance!", (SCM world, SCM until, SCM slice),
             "Run for a slice of wall time; true when everything up to `until` is committed.") {
  WorldBox& box = quiet_box(world, "run!");
  const CallCounter counter(box);
  const InterruptionCheck check(look_for_signals);
  const RunStatus status = box.world.advance(to_real(until, "until"), to_real(slice, "slice"));
  raise_if_interrupted();
  return scm_from_bool(status == RunStatus::finished);
}

TW_PRIMITIVE(frame_rates, "%frame-rates", (SCM world),
             "Return the frames per second of all that take frames.") {
  SCM list = SCM_EOL;
  for (const double rate : to_world(world).frame_rates())
    list = scm_cons(scm_from_double(rate), list);
  return list;
}

TW_PRIMITIVE(step, "%step!", (SCM world),
             "Process one event; return (KIND TIME BODY ...), false if there is none.") {
  WorldBox& box = quiet_box(world, "step!");
  const CallCounter counter(box);
  const InterruptionCheck check(look_for_signals);
  const std::optional<StepReport> done = box.world.step();
  raise_if_interrupted();
  if (!done) return SCM_BOOL_F;
  SCM bodies = SCM_EOL;
  for (const BodyId id : done->bodies) bodies = scm_cons(from_body(world, id), bodies);
  return scm_cons2(scm_from_utf8_symbol(done->kind), scm_from_double(done->time),
                   scm_reverse_x(bodies, SCM_EOL));
}

TW_PRIMITIVE(world_time, "%world-time", (SCM world), "Return the last committed time, s.") {
  return scm_from_double(quiet_world(world, "world-time").time());
}

// ---- looking ----

TW_PRIMITIVE(total_energy, "%total-energy", (SCM world), "Return the total energy, J.") {
  return scm_from_double(quiet_world(world, "total-energy").total_energy());
}

TW_PRIMITIVE(total_momentum, "%total-momentum", (SCM world), "Return the momentum, kg m/s.") {
  return from_vec3(quiet_world(world, "total-momentum").total_momentum());
}

TW_PRIMITIVE(history_hash, "%history-hash", (SCM world), "Return the committed history's hash.") {
  return from_string(quiet_world(world, "history-hash").history_hash());
}

TW_PRIMITIVE(statistics, "%statistics", (SCM world), "Return an alist of statistics.") {
  SCM list = SCM_EOL;
  for (const auto& [name, value] : all_statistics(quiet_box(world, "statistics")))
    list = scm_acons(scm_from_utf8_symbol(name.c_str()), from_value(value), list);
  return scm_reverse(list);
}

TW_PRIMITIVE(dearest_groups, "%dearest-groups", (SCM world),
             "Return the groups that took most steps, the dearest first: (NAMES BODIES CONTACTS "
             "STEPS SINCE) each.") {
  SCM list = SCM_EOL;
  for (const DearestGroup& group : quiet_box(world, "statistics").world.dearest_groups())
    list = scm_cons(
        scm_list_5(scm_from_utf8_string(group.names.c_str()), scm_from_size_t(group.bodies),
                   scm_from_uint64(group.contacts), scm_from_uint64(group.steps + group.rejected),
                   scm_from_double(group.since)),
        list);
  return scm_reverse(list);
}

TW_PRIMITIVE(write_statistics, "%write-statistics", (SCM world, SCM path),
             "Write the statistics as JSON.") {
  write_statistics_json(to_file_name(path, "the file"),
                        all_statistics(quiet_box(world, "statistics")));
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(checkpoint, "%checkpoint", (SCM world, SCM extra),
             "Return the committed present of a world, with what Scheme adds.") {
  WorldBox& box = quiet_box(world, "checkpoint");
  const CallCounter counter(box);
  return from_checkpoint({box.world.checkpoint(), box.forces}, world, extra);
}

TW_PRIMITIVE(restore, "%restore!", (SCM world, SCM checkpoint),
             "Bring a world back to a checkpoint; return what Scheme added.") {
  const ScmCheckpoint& kept = to_checkpoint(checkpoint);
  if (!scm_is_eq(checkpoint_world(checkpoint), world))
    throw BadValue{"the checkpoint", checkpoint,
                   "one of the current world (this one belongs to another)"};
  WorldBox& box = quiet_box(world, "restore!");
  box.world.restore(*kept.checkpoint);
  box.forces = kept.forces;
  keep_as_then(checkpoint);
  return checkpoint_extra(checkpoint);
}

TW_PRIMITIVE(state_queue, "%state-queue", (SCM world, SCM body),
             "Return ((time kind microstep committed? position velocity) ...).") {
  SCM list = SCM_EOL;
  for (const QueuedState& s :
       quiet_world(world, "state-queue").state_queue(to_body(world, body, "the body")))
    list = scm_cons(
        scm_list_n(scm_from_double(s.key.time), scm_from_utf8_symbol(kind_name(s.key.kind)),
                   scm_from_uint32(s.key.microstep), scm_from_bool(s.committed),
                   from_vec3(s.state.position), from_vec3(s.state.velocity), SCM_UNDEFINED),
        list);
  return scm_reverse(list);
}

}  // namespace tw
