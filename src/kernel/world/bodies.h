// Bodies that come and go between runs.
//
// Numbers of bodies are parts of keys and places in lists, so what touches nothing takes the place
// of a removed body: fixed where it was last, without a shape, in no box, no list and no sum.  The
// body itself is laid aside as it was: a checkpoint may bring it back.  A number may be given again
// after a restore; serial numbers never are.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collision/distance/separation.h"
#include "dynamics/contact-parameters.h"
#include "kernel/world/definitions.h"

namespace tw {

class ActivePairs;
class CallbackBook;
class Claims;
class Discontinuities;
class Editing;
struct Simulation;

class Bodies {
 public:
  Bodies(Simulation& simulation, ActivePairs& pairs, CallbackBook& callbacks, Claims& claims,
         Discontinuities& discontinuities, Editing& editing);

  BodyId add(const BodyDef& def);
  std::uint32_t add_multibody(const MultibodyDef& def);  // its number
  void remove(BodyId id);
  std::optional<BodyId> find(const std::string& name) const;
  // Tells the body from all others that this world ever had.
  std::uint64_t serial(BodyId id) const { return identities_[id]->serial; }

  // Those that came since the last run: UserError if one overlaps another by more than it may, then
  // they claim.
  bool any_newborn() const;
  void check_newborn();
  void claim_newborn();
  // Who overlaps where it was put since the last run is in contact from here on, but for what
  // closes and is to be struck.
  void meet_overlapping();
  // After the body was placed elsewhere: UserError if it overlaps another by more than it may.
  void check_overlaps(const Body& body);
  // The pairs that a rule between two sides is about and whose boxes overlap at present, but for
  // those that are looked at when the next run begins.
  std::vector<std::pair<BodyId, BodyId>> pairs_near(const ContactSide& a,
                                                    const ContactSide& b) const;
  // Two that passed through each other until now: UserError if they overlap.
  void check_enabled(const Body& a, const Body& b) const;

  // ---- checkpoints ----
  // Who a body is: shared by its place and the checkpoints that know it.  What took the place of a
  // removed body has its serial number, but is another.
  struct Identity {
    std::uint64_t serial;
  };
  using IdentityPtr = std::shared_ptr<const Identity>;
  struct Kept {
    std::vector<IdentityPtr> bodies;
    std::vector<std::shared_ptr<Multibody>> multibodies;
    ContactTable rules;
  };
  Kept keep();
  // Those that were kept, and no others; all queues and processes are theirs, empty.
  void restore(const Kept& kept);
  // Fixed bodies that are back have boxes again; the others get theirs as they claim.
  void place_fixed();

 private:
  const Body* carrier_of(const MultibodyDef& def) const;
  // The body with that id as it is defined; errors where it cannot be.
  std::unique_ptr<Body> make(const BodyDef& def, BodyId id) const;
  // Of a new body and any other that it may meet the pairs of parts are numbered by ints.
  void require_numbers_of_parts(const Body& body) const;
  // `born_as`: whose id its birth has.
  void enter(std::unique_ptr<Body> body, const BodyDef& def, BodyId born_as);
  void require_no_overlap(const Body& a, const Body& b) const;
  // Into the lists that follow from the bodies.
  void enlist(const Body& body);
  void tell_carriers(const Multibody& multibody);
  // At the present time.
  Separation separation_of(const Body& a, const Body& b) const;
  double closing_of(const Body& a, const Body& b, const Separation& s) const;  // m/s
  void bury(Body& body, const BodyState& last);
  double energy_in_springs() const;  // of contacts, J
  void forget_placed(double gone);

  Simulation& sim_;
  ActivePairs& pairs_;
  CallbackBook& callbacks_;
  Claims& claims_;
  Discontinuities& discontinuities_;
  Editing& editing_;
  std::unordered_map<std::string, BodyId> names_;
  std::vector<IdentityPtr> identities_;  // by body
  std::uint64_t last_serial_ = 0;        // that was given
  // Bodies that are not there; those that nobody can bring back any more go at the next checkpoint
  // or restore, but for those that were removed: older arcs may know them.
  struct Aside {
    std::unique_ptr<Body> body;
    bool removed = false;
  };
  std::unordered_map<IdentityPtr, Aside> aside_;
  void lay_aside(BodyId id, bool removed);
  void forget_lost();
  std::size_t most_parts_ = 1;  // of any body so far
};

}  // namespace tw
