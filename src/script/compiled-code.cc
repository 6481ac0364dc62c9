// Keeps what compiled code refers to alive, for any number of loaded units of code.
//
// Guile's loader registers the writable data of each unit it loads (variables, symbols, strings of
// the code) as a root set of the collector, which ends the program at the 2048th.  A unit's data is
// moved here from there: into a list without limit, which the collector is shown by a hook.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gc/gc.h>
#include <gc/gc_mark.h>
#include <libguile.h>
#include <link.h>

#include <atomic>
#include <span>

#include "script/primitive.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_compiled_code)

namespace {

// entries of a unit's dynamic segment, as Guile's assembler writes them
constexpr auto tag_gc_root = 0x37146000;
constexpr auto tag_gc_root_size = 0x37146001;

struct Roots {
  char* begin = nullptr;
  char* end = nullptr;
  const Roots* next = nullptr;
};

// The collector may stop this thread anywhere: an entry is complete before it becomes the first.
// Code is never unloaded, and so no entry is ever removed.
std::atomic<const Roots*> all_roots = nullptr;

GC_push_other_roots_proc push_others = nullptr;

void push_roots() {
  if (push_others != nullptr) push_others();
  for (const Roots* roots = all_roots.load(); roots != nullptr; roots = roots->next)
    GC_push_all(roots->begin, roots->end);
}

void hold(char* begin, char* end) {
  if (all_roots.load() == nullptr) {
    push_others = GC_get_push_other_roots();
    GC_set_push_other_roots(push_roots);
  }
  all_roots.store(new Roots{begin, end, all_roots.load()});
}

// Offsets in the file are those in memory.
std::span<char> roots_of_unit(char* unit) {
  const auto* header = reinterpret_cast<const ElfW(Ehdr)*>(unit);
  const auto* segments = reinterpret_cast<const ElfW(Phdr)*>(unit + header->e_phoff);
  std::span<char> roots;
  for (int i = 0; i < header->e_phnum; ++i) {
    if (segments[i].p_type != PT_DYNAMIC) continue;
    char* begin = nullptr;
    std::size_t size = 0;
    for (const auto* entry = reinterpret_cast<const ElfW(Dyn)*>(unit + segments[i].p_offset);
         entry->d_tag != DT_NULL; ++entry) {
      if (entry->d_tag == tag_gc_root) begin = unit + entry->d_un.d_val;
      if (entry->d_tag == tag_gc_root_size) size = entry->d_un.d_val;
    }
    if (begin != nullptr) roots = {begin, size};
  }
  return roots;
}

}  // namespace

TW_PRIMITIVE(hold_unit, "%hold-unit!", (SCM unit),
             "Take the data of a loaded unit of code, its memory as a bytevector, out of the "
             "collector's root sets and keep it alive without one.") {
  if (!scm_is_bytevector(unit)) throw BadValue{"the unit", unit, "a bytevector"};
  const std::span<char> roots =
      roots_of_unit(reinterpret_cast<char*>(SCM_BYTEVECTOR_CONTENTS(unit)));
  if (roots.empty()) return SCM_BOOL_F;
  hold(roots.data(), roots.data() + roots.size());
  GC_remove_roots(roots.data(), roots.data() + roots.size());
  return SCM_BOOL_T;
}

}  // namespace tw
