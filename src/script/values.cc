// Conversions between Scheme values and C++ values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/values.h"

#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "script/border.h"

namespace tw {

namespace {

// Elements of a vector, list or f64vector of exactly `count` reals; false if it is anything else.
bool read_reals(SCM value, double* out, std::size_t count) {
  if (scm_is_vector(value)) {
    if (SCM_SIMPLE_VECTOR_LENGTH(value) != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const SCM element = SCM_SIMPLE_VECTOR_REF(value, i);
      if (!scm_is_real(element)) return false;
      out[i] = scm_to_double(element);
    }
    return true;
  }
  if (scm_is_true(scm_f64vector_p(value))) {
    if (SCM_BYTEVECTOR_LENGTH(value) != count * sizeof(double)) return false;
    std::memcpy(out, SCM_BYTEVECTOR_CONTENTS(value), count * sizeof(double));
    return true;
  }
  for (std::size_t i = 0; i < count; ++i, value = SCM_CDR(value)) {
    if (!scm_is_pair(value) || !scm_is_real(SCM_CAR(value))) return false;
    out[i] = scm_to_double(SCM_CAR(value));
  }
  return scm_is_null(value);
}

}  // namespace

std::vector<SCM> to_elements(SCM value, const char* name, const char* expected) {
  std::vector<SCM> elements;
  if (scm_is_vector(value)) {
    for (std::size_t i = 0; i < SCM_SIMPLE_VECTOR_LENGTH(value); ++i)
      elements.push_back(SCM_SIMPLE_VECTOR_REF(value, i));
    return elements;
  }
  if (scm_ilength(value) < 0) throw BadValue{name, value, expected};
  for (; scm_is_pair(value); value = SCM_CDR(value)) elements.push_back(SCM_CAR(value));
  return elements;
}

double to_real(SCM value, const char* name) {
  if (!scm_is_real(value)) throw BadValue{name, value, "a real number"};
  return scm_to_double(value);
}

double to_finite(SCM value, const char* name) {
  if (!scm_is_real(value) || !std::isfinite(scm_to_double(value)))
    throw BadValue{name, value, "a finite real number"};
  return scm_to_double(value);
}

long to_integer(SCM value, const char* name) {
  if (!scm_is_signed_integer(value, LONG_MIN, LONG_MAX))
    throw BadValue{name, value, "an exact integer"};
  return scm_to_long(value);
}

std::uint64_t to_seed(SCM value, const char* name) {
  if (!scm_is_unsigned_integer(value, 0, UINT64_MAX))
    throw BadValue{name, value, "an exact integer from 0 to 2^64-1"};
  return scm_to_uint64(value);
}

bool to_bool(SCM value) { return scm_is_true(value); }

std::string text_of(SCM value) {
  if (!scm_is_string(value)) return "";
  std::size_t length = 0;
  const std::unique_ptr<char, decltype(&std::free)> bytes(scm_to_utf8_stringn(value, &length),
                                                          &std::free);
  return std::string(bytes.get(), length);
}

std::string to_string(SCM value, const char* name) {
  if (!scm_is_string(value)) throw BadValue{name, value, "a string"};
  return text_of(value);
}

std::string to_symbol_name(SCM value, const char* name) {
  if (!scm_is_symbol(value)) throw BadValue{name, value, "a symbol"};
  return text_of(scm_symbol_to_string(value));
}

std::vector<double> to_reals(SCM value, std::size_t count, const char* name, const char* expected) {
  std::vector<double> numbers(count);
  if (count == 1 && scm_is_real(value))
    numbers[0] = scm_to_double(value);
  else if (!read_reals(value, numbers.data(), count))
    throw BadValue{name, value, expected};
  return numbers;
}

Vec3 to_vec3(SCM value, const char* name) {
  double x[3];
  if (!read_reals(value, x, 3) || !std::isfinite(x[0] + x[1] + x[2]))
    throw BadValue{name, value, "a vector #(x y z) of finite numbers"};
  return {x[0], x[1], x[2]};
}

Quat to_quat(SCM value, const char* name) {
  double x[4];
  if (!read_reals(value, x, 4) || !std::isfinite(x[0] + x[1] + x[2] + x[3]))
    throw BadValue{name, value, "a quaternion #(w x y z) of finite numbers"};
  Quat q(x[0], x[1], x[2], x[3]);
  // squares that would overflow or vanish: scaled first
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (largest > 0 && (largest < 1e-100 || largest > 1e100)) q.coeffs() /= largest;
  const double norm = q.norm();
  if (!(norm > 0) || !std::isfinite(norm))
    throw BadValue{name, value, "a quaternion #(w x y z) that is not zero"};
  // what is normalised already keeps its bits
  if (std::abs(norm - 1) > 1e-15) q.coeffs() /= norm;
  return q;
}

Mat3 to_inertia(SCM value, const char* name) {
  double x[3];
  if (read_reals(value, x, 3)) return Vec3(x[0], x[1], x[2]).asDiagonal();
  constexpr const char* expected = "three principal moments #(Ixx Iyy Izz), or three rows of three";
  Mat3 m;
  const std::vector<SCM> rows = to_elements(value, name, expected);
  if (rows.size() != 3) throw BadValue{name, value, expected};
  for (int i = 0; i < 3; ++i) m.row(i) = to_vec3(rows[static_cast<std::size_t>(i)], name);
  return m;
}

std::vector<Vec3> to_points(SCM value, const char* name) {
  const std::vector<SCM> elements = to_elements(value, name, "a list of points #(x y z)");
  std::vector<Vec3> points;
  points.reserve(elements.size());
  for (const SCM element : elements) points.push_back(to_vec3(element, name));
  return points;
}

std::optional<double> to_optional_real(SCM value, const char* name) {
  if (scm_is_false(value)) return std::nullopt;
  return to_real(value, name);
}

bool is_place(SCM value) {
  if (scm_ilength(value) != 3 || !scm_is_string(SCM_CAR(value))) return false;
  const SCM line = SCM_CADR(value), column = SCM_CADDR(value);
  return scm_is_signed_integer(line, 0, INT_MAX) && scm_is_signed_integer(column, 0, INT_MAX);
}

Place to_place(SCM value) {
  return {text_of(SCM_CAR(value)), scm_to_int(SCM_CADR(value)), scm_to_int(SCM_CADDR(value))};
}

SCM from_reals(std::span<const double> numbers) {
  const SCM result = scm_c_make_vector(numbers.size(), SCM_BOOL_F);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    SCM_SIMPLE_VECTOR_SET(result, i, scm_from_double(numbers[i]));
  return result;
}

SCM from_vec3(const Vec3& v) {
  const SCM result = scm_c_make_vector(3, SCM_BOOL_F);
  for (int i = 0; i < 3; ++i)
    SCM_SIMPLE_VECTOR_SET(result, static_cast<std::size_t>(i), scm_from_double(v[i]));
  return result;
}

SCM from_quat(const Quat& q) {
  const double values[] = {q.w(), q.x(), q.y(), q.z()};
  const SCM result = scm_c_make_vector(4, SCM_BOOL_F);
  for (std::size_t i = 0; i < 4; ++i) SCM_SIMPLE_VECTOR_SET(result, i, scm_from_double(values[i]));
  return result;
}

SCM from_matrix(const Mat3& m) {
  const SCM result = scm_c_make_vector(3, SCM_BOOL_F);
  for (int i = 0; i < 3; ++i)
    SCM_SIMPLE_VECTOR_SET(result, static_cast<std::size_t>(i), from_vec3(m.row(i).transpose()));
  return result;
}

SCM from_string(const std::string& text) {
  return scm_from_stringn(text.data(), text.size(), "UTF-8", SCM_FAILED_CONVERSION_QUESTION_MARK);
}

SCM from_strings(const std::vector<std::string>& texts) {
  SCM list = SCM_EOL;
  for (std::size_t i = texts.size(); i-- > 0;) list = scm_cons(from_string(texts[i]), list);
  return list;
}

SCM from_place(const Place& place) {
  if (!place.known()) return SCM_BOOL_F;
  return scm_list_3(from_string(place.file), scm_from_int(place.line), scm_from_int(place.column));
}

}  // namespace tw
