// How far a run of a case is from what is known.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "bench/engine-cases.h"

namespace tw::bench {

class CaseJudge {
 public:
  virtual ~CaseJudge() = default;
  // s: how often it looks, from 0 to the end.
  virtual double interval() const = 0;
  virtual void look(double time, const CaseEngine& engine) = 0;
  virtual double error() const = 0;
  // Of what should stand still, from 1 s on.
  virtual double settled_error() const { return 0; }
};

std::unique_ptr<CaseJudge> judge_of(const CaseTable& c);

// Of the error.
std::string unit_of(const std::string& name);
// It is judged by how far it moves, also after it has settled.
bool stands_still(const std::string& name);

}  // namespace tw::bench
