// Scheme primitives: JSON read and written, by nlohmann's library.
//
// An object is an alist with strings as keys, in its order; an array a vector; null the symbol
// `null'.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include "script/primitive.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_json)

namespace {

using Json = nlohmann::ordered_json;

SCM from_json(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      SCM pairs = SCM_EOL;
      for (const auto& [key, value] : json.items())
        pairs = scm_acons(from_string(key), from_json(value), pairs);
      return scm_reverse_x(pairs, SCM_EOL);
    }
    case Json::value_t::array: {
      SCM elements = SCM_EOL;
      for (const Json& element : json) elements = scm_cons(from_json(element), elements);
      return scm_vector(scm_reverse_x(elements, SCM_EOL));
    }
    case Json::value_t::string: return from_string(json.get<std::string>());
    case Json::value_t::boolean: return scm_from_bool(json.get<bool>());
    case Json::value_t::number_integer: return scm_from_int64(json.get<std::int64_t>());
    case Json::value_t::number_unsigned: return scm_from_uint64(json.get<std::uint64_t>());
    case Json::value_t::number_float: return scm_from_double(json.get<double>());
    default: return scm_from_utf8_symbol("null");
  }
}

Json to_json(SCM value);

Json to_json_object(SCM alist) {
  Json object = Json::object();
  for (const SCM pair : to_elements(alist, "a JSON object", "an association list")) {
    if (!scm_is_pair(pair)) throw BadValue{"an entry of a JSON object", pair, "a pair"};
    object[to_string(SCM_CAR(pair), "a key of a JSON object")] = to_json(SCM_CDR(pair));
  }
  return object;
}

Json to_json_array(SCM vector) {
  Json array = Json::array();
  for (const SCM element : to_elements(vector, "a JSON array", "a vector"))
    array.push_back(to_json(element));
  return array;
}

Json to_json(SCM value) {
  if (scm_is_bool(value)) return scm_is_true(value);
  if (scm_is_string(value)) return text_of(value);
  if (scm_is_symbol(value)) return nullptr;
  if (scm_is_signed_integer(value, INT64_MIN, INT64_MAX)) return scm_to_int64(value);
  if (scm_is_real(value)) {
    const double number = to_real(value, "a JSON number");
    return std::isfinite(number) ? Json(number) : Json(nullptr);
  }
  if (scm_is_vector(value)) return to_json_array(value);
  return to_json_object(value);
}

}  // namespace

TW_PRIMITIVE(read_json, "%read-json", (SCM text), "Return the value that a JSON text describes.") {
  const Json json = Json::parse(to_string(text, "the JSON text"), nullptr, false);
  if (json.is_discarded()) throw BadValue{"the JSON text", text, "valid JSON"};
  return from_json(json);
}

// A number that is not finite becomes null.
TW_PRIMITIVE(write_json, "%write-json", (SCM value), "Return a value as JSON, in one line.") {
  return from_string(to_json(value).dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace tw
