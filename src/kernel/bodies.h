// Bodies that come and go between runs.
//
// Numbers of bodies are parts of keys and places in lists, so a removed body stays as what touches
// nothing: fixed where it was last, without a shape, in no box, no list and no sum.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "collision/separation.h"
#include "dynamics/contact-parameters.h"
#include "kernel/definitions.h"

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

  // Those that came since the last run: UserError if one overlaps another, then they claim.
  bool any_newborn() const;
  void check_newborn();
  void claim_newborn();
  // After the body was placed elsewhere: UserError if it overlaps another.
  void check_overlaps(const Body& body);
  // Before a rule lets pairs collide that passed through each other: UserError if two overlap.
  void check_enabled(const ContactSide& a, const ContactSide& b, const ContactSettings& settings);

 private:
  const Body* carrier_of(const MultibodyDef& def) const;
  // The body with that id as it is defined; errors where it cannot be.
  std::unique_ptr<Body> make(const BodyDef& def, BodyId id) const;
  // Of a new body and any other that it may meet the pairs of parts are numbered by ints.
  void require_numbers_of_parts(const Body& body) const;
  // `born_as`: whose id its birth has.
  void enter(std::unique_ptr<Body> body, const BodyDef& def, BodyId born_as);
  void require_no_overlap(const Body& a, const Body& b) const;
  // At the present time.
  Separation separation_of(const Body& a, const Body& b) const;
  void bury(Body& body, const BodyState& last);

  Simulation& sim_;
  ActivePairs& pairs_;
  CallbackBook& callbacks_;
  Claims& claims_;
  Discontinuities& discontinuities_;
  Editing& editing_;
  std::unordered_map<std::string, BodyId> names_;
  std::size_t most_parts_ = 1;  // of any body so far
};

}  // namespace tw
