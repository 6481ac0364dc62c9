// User slots that hold Scheme values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/scm-slots.h"

#include <gc/gc.h>

#include <bit>
#include <cstring>
#include <new>

#include "script/border.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

namespace {

// Mixes one word into a hash: the finalizer of SplitMix64 over their sum.
std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  std::uint64_t z = hash * 0x9e3779b97f4a7c15ull + word + 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// The numbers of a value in order; everything else adds nothing.
std::uint64_t hash_value(std::uint64_t hash, SCM value) {
  if (scm_is_real(value)) {
    const double number = scm_to_double(value);
    return mix(hash, std::bit_cast<std::uint64_t>(number));
  }
  if (scm_is_vector(value)) {
    for (std::size_t i = 0; i < SCM_SIMPLE_VECTOR_LENGTH(value); ++i)
      hash = hash_value(hash, SCM_SIMPLE_VECTOR_REF(value, i));
    return hash;
  }
  if (!scm_is_pair(value)) return hash;
  for (; scm_is_pair(value); value = SCM_CDR(value)) hash = hash_value(hash, SCM_CAR(value));
  return hash_value(hash, value);
}

// Copies a value so that nothing reaches the copy but through the slot.  Vectors and strings of the
// copy are read-only, as constants in a program are; pairs have no such mark.
class Freezer {
 public:
  explicit Freezer(SCM slot) : slot_(slot) {}

  SCM copy(SCM value, int depth = 0) {
    // what nobody can change stands for itself
    if (SCM_IMP(value) || scm_is_number(value) || scm_is_symbol(value) || scm_is_keyword(value) ||
        stands_for_body(value))
      return value;
    if (depth == most_depth) refuse(value, shallow);
    if (scm_is_pair(value)) return copy_list(value, depth);
    if (scm_is_vector(value)) return copy_vector(value, depth);
    if (scm_is_string(value))
      return scm_substring_read_only(value, scm_from_int(0), scm_string_length(value));
    refuse(value, depth == 0 ? frozen : frozen_parts);
  }

 private:
  // A slot is copied whenever it is set, and hashed with the history: far beyond what anyone keeps
  // there.
  static constexpr long most_parts = 1000000;
  static constexpr int most_depth = 1000;

  static constexpr const char* frozen =
      "what no callback can change behind a rollback: a number, boolean, symbol, keyword, "
      "character, string or body, or a list or vector of such";
  static constexpr const char* frozen_parts =
      "only parts that no callback can change behind a rollback: numbers, booleans, symbols, "
      "keywords, characters, strings, bodies, lists and vectors";
  static constexpr const char* shallow =
      "a value nested at most 1000 deep (a circular one never ends)";
  static constexpr const char* small =
      "a value of at most 1000000 parts (a circular one never ends)";

  // along the spine by a loop, so that long lists don't need a deep stack
  SCM copy_list(SCM value, int depth) {
    const SCM whole = value;
    const SCM head = scm_cons(copy(SCM_CAR(value), depth + 1), SCM_EOL);
    SCM tail = head;
    for (value = SCM_CDR(value); scm_is_pair(value); value = SCM_CDR(value)) {
      count(whole, 1);
      const SCM next = scm_cons(copy(SCM_CAR(value), depth + 1), SCM_EOL);
      SCM_SETCDR(tail, next);
      tail = next;
    }
    SCM_SETCDR(tail, copy(value, depth + 1));
    return head;
  }

  SCM copy_vector(SCM value, int depth) {
    const std::size_t size = SCM_SIMPLE_VECTOR_LENGTH(value);
    count(value, static_cast<long>(size));
    const SCM result = scm_c_make_vector(size, SCM_BOOL_F);
    for (std::size_t i = 0; i < size; ++i)
      SCM_SIMPLE_VECTOR_SET(result, i, copy(SCM_SIMPLE_VECTOR_REF(value, i), depth + 1));
    // the empty vector is one for all, and has nothing to set
    if (size > 0) SCM_SET_CELL_TYPE(result, SCM_CELL_TYPE(result) | SCM_F_VECTOR_IMMUTABLE);
    return result;
  }

  void count(SCM value, long parts) {
    parts_ += parts;
    if (parts_ > most_parts) refuse(value, small);
  }

  [[noreturn]] void refuse(SCM value, const char* expected) const {
    throw BadValue{"the value for slot " + text_of(scm_symbol_to_string(slot_)), value, expected};
  }

  SCM slot_;
  long parts_ = 0;
};

}  // namespace

ScmSlots::ScmSlots(std::shared_ptr<const Names> names) : names_(std::move(names)) {
  values_ = static_cast<SCM*>(GC_MALLOC_UNCOLLECTABLE(names_->size() * sizeof(SCM) + 1));
  if (!values_) throw std::bad_alloc();
}

ScmSlots::~ScmSlots() { GC_FREE(values_); }

SlotsPtr ScmSlots::from_alist(SCM alist) {
  constexpr const char* expected = "an association list like '((bounces . 0)), each name once";
  auto names = std::make_shared<Names>();
  for (SCM rest = alist; !scm_is_null(rest); rest = SCM_CDR(rest)) {
    if (!scm_is_pair(rest) || !scm_is_pair(SCM_CAR(rest)) || !scm_is_symbol(SCM_CAAR(rest)))
      throw BadValue{"slots", alist, expected};
    for (const SCM known : *names)
      if (scm_is_eq(known, SCM_CAAR(rest))) throw BadValue{"slots", alist, expected};
    names->push_back(SCM_CAAR(rest));
  }
  const std::shared_ptr<ScmSlots> slots(new ScmSlots(names));
  int index = 0;
  for (SCM rest = alist; !scm_is_null(rest); rest = SCM_CDR(rest))
    slots->values_[index++] = Freezer(SCM_CAAR(rest)).copy(SCM_CDAR(rest));
  return slots;
}

int ScmSlots::find(SCM name) const {
  for (std::size_t i = 0; i < names_->size(); ++i)
    if (scm_is_eq((*names_)[i], name)) return static_cast<int>(i);
  return -1;
}

SlotsPtr ScmSlots::with(int index, SCM value) const {
  const std::shared_ptr<ScmSlots> copy(new ScmSlots(names_));
  std::memcpy(copy->values_, values_, names_->size() * sizeof(SCM));
  copy->values_[index] = Freezer((*names_)[static_cast<std::size_t>(index)]).copy(value);
  return copy;
}

namespace {

// Of values that were frozen: they end, and hold nothing that equal? would call a procedure for.
bool are_same(SCM a, SCM b) {
  for (; scm_is_pair(a) && scm_is_pair(b); a = SCM_CDR(a), b = SCM_CDR(b))
    if (!are_same(SCM_CAR(a), SCM_CAR(b))) return false;
  if (scm_is_string(a) && scm_is_string(b)) return scm_is_true(scm_string_equal_p(a, b));
  if (!scm_is_vector(a) || !scm_is_vector(b)) return scm_is_true(scm_eqv_p(a, b));
  const std::size_t size = SCM_SIMPLE_VECTOR_LENGTH(a);
  if (SCM_SIMPLE_VECTOR_LENGTH(b) != size) return false;
  for (std::size_t i = 0; i < size; ++i)
    if (!are_same(SCM_SIMPLE_VECTOR_REF(a, i), SCM_SIMPLE_VECTOR_REF(b, i))) return false;
  return true;
}

}  // namespace

bool ScmSlots::has_same(int index, const ScmSlots& other) const {
  return are_same(values_[index], other.values_[index]);
}

std::uint64_t ScmSlots::hash() const {
  std::uint64_t hash = names_->size();
  for (std::size_t i = 0; i < names_->size(); ++i) hash = hash_value(mix(hash, i), values_[i]);
  return hash;
}

std::string ScmSlots::names_text() const {
  std::string text;
  for (const SCM name : *names_)
    text += (text.empty() ? "" : ", ") + text_of(scm_symbol_to_string(name));
  return text;
}

}  // namespace tw
