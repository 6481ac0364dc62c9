// How a Scheme primitive is defined: name, arguments, docstring and guarded body together.
//
//   TW_PRIMITIVES(define_shapes)            // once per file; called by init.cc
//
//   TW_PRIMITIVE(sphere, "%sphere", (SCM radius), "Return a sphere.") {
//     return from_shape(make_sphere(to_real(radius, "radius")));
//   }
//
// The body runs inside `guard`: it may throw UserError and BadValue and use C++ objects freely, but
// must not call what may leave by longjmp.  All arguments are required; the public procedures in
// scheme/timewarp/*.scm deal with keywords and defaults.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <vector>

#include "script/border.h"

namespace tw {

struct Primitive {
  const char* name;
  int arguments;
  scm_t_subr function;
  const char* doc;
};

class PrimitiveList {
 public:
  // What is added from here on is of this list.
  PrimitiveList() { current_ = this; }
  PrimitiveList(const PrimitiveList&) = delete;
  PrimitiveList& operator=(const PrimitiveList&) = delete;
  static bool add(const Primitive& primitive) {
    current_->list_.push_back(primitive);
    return true;
  }
  // Defines and exports all in Guile's current module, with their docstrings.
  void define() const;

 private:
  static inline PrimitiveList* current_ = nullptr;
  std::vector<Primitive> list_;
};

template <auto body>
struct Guarded;

template <class... Arguments, SCM (*body)(Arguments...)>
struct Guarded<body> {
  static constexpr int count = sizeof...(Arguments);
  static SCM call(Arguments... arguments) {
    return guard([&] { return body(arguments...); });
  }
};

}  // namespace tw

// Static objects of a file begin in the order in which they stand there: a list is that of what
// follows it.
#define TW_PRIMITIVES(define_function)               \
  static ::tw::PrimitiveList define_function##_list; \
  void define_function() { define_function##_list.define(); }

#define TW_PRIMITIVE(function, scheme_name, arguments, doc)                           \
  static SCM function arguments;                                                      \
  [[maybe_unused]] static const bool function##_is_listed = ::tw::PrimitiveList::add( \
      {scheme_name, ::tw::Guarded<function>::count,                                   \
       reinterpret_cast<scm_t_subr>(&::tw::Guarded<function>::call), doc});           \
  static SCM function arguments
