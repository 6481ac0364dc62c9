// Conversions between Scheme values and C++ values.
//
// From Scheme: they throw BadValue, never longjmp, so they may be used where C++ objects live.
// `name` is what the message calls the value.  Vectors are accepted as #(x y z), lists and
// f64vectors, and returned as #(x y z); quaternions as #(w x y z).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace tw {

// ---- from Scheme ----

// Any real number, also one that is not finite: the kernel's own checks say what it must be.
double to_real(SCM value, const char* name);
double to_finite(SCM value, const char* name);
long to_integer(SCM value, const char* name);
std::uint64_t to_seed(SCM value, const char* name);
bool to_bool(SCM value);
std::string to_string(SCM value, const char* name);
// The name of a symbol.
std::string to_symbol_name(SCM value, const char* name);
// `count` real numbers in #(a b ...), a list or an f64vector; of one, the number alone.
std::vector<double> to_reals(SCM value, std::size_t count, const char* name, const char* expected);
// Three finite numbers.
Vec3 to_vec3(SCM value, const char* name);
// Four finite numbers, not all zero; normalised.
Quat to_quat(SCM value, const char* name);
// Three principal values or three rows.
Mat3 to_inertia(SCM value, const char* name);
std::vector<Vec3> to_points(SCM value, const char* name);
// The elements of a vector or of a proper list; a circular list is BadValue, too.  The value keeps
// them alive.
std::vector<SCM> to_elements(SCM value, const char* name, const char* expected);
// #f is absent.
std::optional<double> to_optional_real(SCM value, const char* name);

// (FILE LINE COLUMN), lines and columns from 1.
bool is_place(SCM value);
Place to_place(SCM value);

// A string's text, "" for everything else.
std::string text_of(SCM value);

// ---- to Scheme ----

SCM from_reals(std::span<const double> numbers);
SCM from_vec3(const Vec3& v);
SCM from_quat(const Quat& q);
SCM from_matrix(const Mat3& m);
SCM from_string(const std::string& text);
SCM from_strings(const std::vector<std::string>& texts);  // a list
// (FILE LINE COLUMN), or #f where the place is unknown.
SCM from_place(const Place& place);

}  // namespace tw
