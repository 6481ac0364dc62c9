// Images of states.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/check/state-image.h"

#include <bit>

#include "base/hash.h"
#include "groups/group-fields.h"
#include "timeline/field-words.h"
#include "timeline/state-fields.h"

namespace tw {
namespace {

// Calls put(field, word) for each word of a state and, with its first member, of a group.
template <class Put>
void each_field_word(const State& state, Put&& put) {
  const auto visit = [&](const char* field, FieldUse, const auto& value) {
    each_word(value, [&](auto word) { put(field, word); });
  };
  for_each_field(state, [&](const char* field, FieldUse use, const auto& value) {
    if constexpr (std::is_same_v<decltype(value), const std::shared_ptr<Group>&>) {
      put(field, std::uint64_t{value != nullptr});
      if (value && state.member == 0) for_each_field(*value, visit);
    } else {
      visit(field, use, value);
    }
  });
}

void add(Hasher& h, const State& state) {
  h.add(std::uint64_t{number(state.process)});
  each_field_word(state, [&](const char*, auto word) { h.add(word); });
}

template <class Visit>
void for_each_tail(const StateGraph& graph, const Key& key, Visit&& visit) {
  for (std::uint32_t i = 0; i < graph.process_count(); ++i)
    if (const State* tail = graph.tail(ProcessId{i}); tail->key == key) visit(*tail);
}

}  // namespace

void StateImage::add(const State& state) {
  words_.push_back({"process", state.process, false, number(state.process)});
  each_field_word(state, [&](const char* field, auto word) {
    constexpr bool real = std::is_same_v<decltype(word), double>;
    words_.push_back({field, state.process, real, std::bit_cast<std::uint64_t>(word)});
  });
}

std::uint64_t StateImage::checksum() const {
  Hasher h;
  for (const Word& word : words_) h.add(word.bits);
  return h.value();
}

std::string StateImage::text() const {
  std::string text;
  const char* field = nullptr;
  for (const Word& word : words_) {
    if (word.field == field) {
      text += ',';
    } else {
      field = word.field;
      text += std::string("\t") + field + '=';
    }
    text += word.value();
  }
  return text;
}

std::string StateImage::Word::value() const {
  return real ? show(std::bit_cast<double>(bits)) : std::to_string(bits);
}

std::string StateImage::first_difference(const Scene& scene, const StateImage& before) const {
  const auto name = [&](const Word& word) {
    return std::string(word.field) + " of " + scene.body_of(word.process).info.name;
  };
  const std::size_t both = std::min(words_.size(), before.words_.size());
  std::size_t i = 0;
  while (i < both && words_[i] == before.words_[i]) ++i;
  if (i == words_.size() && i == before.words_.size()) return "";
  if (i == before.words_.size())
    return name(words_[i]) + ": " + words_[i].value() + ", before none";
  if (i == words_.size())
    return name(before.words_[i]) + ": none, before " + before.words_[i].value();
  const Word& now = words_[i];
  const Word& then = before.words_[i];
  const bool same_field = now.process == then.process && std::string_view(now.field) == then.field;
  return name(now) + ": " + now.value() + ", before " +
         (same_field ? then.value() : name(then) + ": " + then.value());
}

std::uint64_t state_checksum(const State& state) {
  Hasher h;
  add(h, state);
  return h.value();
}

std::uint64_t graph_checksum(const StateGraph& graph) {
  Hasher h;
  for (std::uint32_t i = 0; i < graph.process_count(); ++i)
    for (const State* s = graph.head(ProcessId{i}); s; s = s->next) add(h, *s);
  return h.value();
}

StateImage image_of_ring(const StateGraph& graph, const Key& key) {
  StateImage image;
  for_each_tail(graph, key, [&](const State& tail) { image.add(tail); });
  return image;
}

}  // namespace tw
