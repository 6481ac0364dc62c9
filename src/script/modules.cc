// Where the program finds its Scheme modules.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/modules.h"

#include <libguile.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <string>

#include "script/file-names.h"

namespace tw {

namespace {

namespace fs = std::filesystem;

constexpr const char* first_module = "timewarp/command-line.scm";

struct Folders {
  std::string sources, compiled;
  std::string made = sources;  // modules that are made when timewarp is built
  bool have_modules() const {
    std::error_code error;
    return fs::exists(fs::path(sources) / first_module, error);
  }
};

Folders configured_folders() { return {TW_GUILE_SITE_DIR, TW_GUILE_SITE_CCACHE_DIR}; }

bool in_build_folder(const fs::path& folder) {
  std::error_code error;
  return fs::equivalent(folder, TW_BUILD_DIR, error);
}

// In the build folder: the sources' own.  Elsewhere: the configured folders, seen from where the
// executable is rather than from BINDIR.
Folders folders_beside_executable() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return configured_folders();
  if (in_build_folder(folder))
    return {TW_SOURCE_DIR "/scheme", TW_BUILD_DIR "/scheme", TW_BUILD_DIR "/scheme"};
  const auto moved = [&folder](const char* configured) {
    return (folder / fs::path(configured).lexically_relative(TW_BIN_DIR))
        .lexically_normal()
        .string();
  };
  return {moved(TW_GUILE_SITE_DIR), moved(TW_GUILE_SITE_CCACHE_DIR)};
}

// One of Guile's paths and folders that go to its beginning or its end.  No destructor: errors
// of Guile leave by longjmp.
struct PathEntry {
  PathEntry(const char* path_name, std::initializer_list<const char*> folders)
      : path(scm_c_lookup(path_name)), others(scm_variable_ref(path)), entries(SCM_EOL) {
    for (auto folder = std::rbegin(folders); folder != std::rend(folders); ++folder)
      entries = scm_cons(from_argument(*folder), entries);
  }
  void put_first() const { scm_variable_set_x(path, scm_append(scm_list_2(entries, others))); }
  void put_last() const { scm_variable_set_x(path, scm_append(scm_list_2(others, entries))); }
  SCM path, others, entries;
};

[[noreturn]] void complain(const Folders& beside, const Folders& configured) {
  std::fprintf(
      stderr,
      "timewarp: its modules are missing: %s is neither in %s nor in %s nor in a folder of "
      "GUILE_LOAD_PATH; expected the program where it was installed, or GUILE_LOAD_PATH naming "
      "the folder\n",
      first_module, beside.sources.c_str(), configured.sources.c_str());
  std::exit(EXIT_FAILURE);
}

}  // namespace

void load_modules() {
  const Folders beside = folders_beside_executable();
  const Folders configured = configured_folders();
  const bool own = beside.have_modules();
  const Folders& folders = own ? beside : configured;
  const PathEntry sources("%load-path", {folders.sources.c_str(), folders.made.c_str()});
  const PathEntry compiled("%load-compiled-path", {folders.compiled.c_str()});
  if (own) {
    // who changes a module compiles it by make
    if (folders.sources != folders.made)
      scm_variable_set_x(scm_c_lookup("%load-should-auto-compile"), SCM_BOOL_F);
    sources.put_first();
    compiled.put_first();
    // all that would otherwise be looked for later, when other folders come first
    for (const char* name :
         {"timewarp", "timewarp vectors", "timewarp repl", "timewarp command-line"})
      scm_c_resolve_module(name);
  }
  sources.put_last();
  compiled.put_last();
  if (scm_is_false(scm_sys_search_load_path(scm_from_utf8_string(first_module))))
    complain(beside, configured);
}

}  // namespace tw
