// Random scenes under an independent judge, from the command line; without arguments: the tests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "base/error.h"
#include "fuzz/generator.h"
#include "fuzz/verdict.h"

namespace tw::fuzz {
namespace {

struct Options {
  std::string kind;  // empty: in turn
  std::uint64_t first = 0, last = 29;
  Judges judges;
  double budget = 20;  // s
  std::string dump, dump_failures;
};

void print_help() {
  std::puts(
      "fuzz-scenes [OPTION]...   judges random scenes, a line each; without options: the tests\n"
      "  --seeds=A..B        or one seed; 0..29\n"
      "  --kind=KIND         all seeds of this kind; otherwise seeds take the kinds but rolls in "
      "turn\n"
      "  --judge=LIST        of hash,depth,energy,progress; all\n"
      "  --budget=SECONDS    of CPU for the plain run of a scene; 20\n"
      "  --dump=FILE.scm     write the scene (one seed) for the command, do not run it\n"
      "  --dump-failures=DIR write each scene that fails to DIR/KIND-SEED.scm\n"
      "  --help\n"
      "Faults: crash, error, not-finite; lost (a centre outside its room); deep (an overlap\n"
      "beyond 2 % of the smaller body's least width, but of bodies told to be squeezed); energy\n"
      "(above its least so far by 1e-3 of what is at play); slow (more than 0.16 s of CPU per\n"
      "time unit and body, or than the budget); hash (another history in one piece, by 3\n"
      "threads, by narrow windows, under an adversary, with undo-redo, or with vain edits).  Dear: "
      "a schedule\n"
      "that took more than 5 times as long and 1 s, and was not waited for.\n"
      "Status: 0 if no scene has a fault, else 1; 2 for wrong usage.\n"
      "Kinds:");
  for (const Kind& kind : kinds()) std::printf("  %-10s %s\n", kind.name, kind.what);
}

std::uint64_t whole_number(const std::string& text) {
  char* end = nullptr;
  const std::uint64_t value = std::strtoull(text.c_str(), &end, 10);
  TW_REQUIRE(!text.empty() && !*end, "a seed is " + text + "; expected a whole number");
  return value;
}

void read_seeds(const std::string& text, Options& options) {
  const auto dots = text.find("..");
  options.first = whole_number(text.substr(0, dots));
  options.last = dots == std::string::npos ? options.first : whole_number(text.substr(dots + 2));
}

Judges read_judges(const std::string& text) {
  Judges judges{false, false, false, false};
  std::istringstream list(text);
  for (std::string name; std::getline(list, name, ',');) {
    if (name == "hash")
      judges.hash = true;
    else if (name == "depth")
      judges.depth = true;
    else if (name == "energy")
      judges.energy = true;
    else if (name == "progress")
      judges.progress = true;
    else
      throw UserError("judge is " + name + "; expected hash, depth, energy or progress");
  }
  return judges;
}

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (name == "--kind")
      options.kind = value;
    else if (name == "--seeds")
      read_seeds(value, options);
    else if (name == "--judge")
      options.judges = read_judges(value);
    else if (name == "--budget")
      options.budget = std::atof(value.c_str());
    else if (name == "--dump")
      options.dump = value;
    else if (name == "--dump-failures")
      options.dump_failures = value;
    else
      throw UserError("option is " + argument + "; expected one that --help lists");
  }
  TW_REQUIRE(options.dump.empty() || options.first == options.last,
             "--dump got several seeds; expected --seeds=SEED");
  return options;
}

void write(const std::string& file, const DescribedScene& scene) {
  std::ofstream out(file);
  out << scheme_text(scene);
  TW_REQUIRE(out.flush(), "cannot write " + file);
}

// Of one kind, or of all.
struct Row {
  int runs = 0, ok = 0;
  double cpu = 0;
  std::map<Fault, int> faults;

  void add(const Verdict& verdict) {
    ++runs;
    ok += verdict.faults.empty();
    cpu += verdict.findings.cpu;
    for (const Fault fault : verdict.faults) ++faults[fault];
  }
  void print(const std::string& name) const {
    std::printf("%-10s %5d %5d", name.c_str(), runs, ok);
    for (int i = 0; i < fault_count; ++i) {
      const auto found = faults.find(static_cast<Fault>(i));
      std::printf(" %10d", found == faults.end() ? 0 : found->second);
    }
    std::printf(" %8.1f\n", cpu);
  }
};

void print_table(const std::map<std::string, Row>& rows, const Row& all) {
  std::printf("\n%-10s %5s %5s", "kind", "runs", "ok");
  for (int i = 0; i < fault_count; ++i) std::printf(" %10s", name_of(static_cast<Fault>(i)));
  std::printf(" %8s\n", "cpu, s");
  for (const auto& [kind, row] : rows) row.print(kind);
  all.print("all");
}

int judge_all(const Options& options) {
  std::map<std::string, Row> rows;
  Row all;
  for (std::uint64_t seed = options.first; seed <= options.last; ++seed) {
    const std::string kind = options.kind.empty() ? kind_of_seed(seed) : options.kind;
    const DescribedScene scene = random_scene(kind, seed);
    if (!options.dump.empty()) {
      write(options.dump, scene);
      return 0;
    }
    const Verdict verdict = judge(scene, options.judges, options.budget);
    std::puts(verdict.line().c_str());
    std::fflush(stdout);
    rows[kind].add(verdict);
    all.add(verdict);
    if (!options.dump_failures.empty() && !verdict.faults.empty())
      write(options.dump_failures + "/" + kind + "-" + std::to_string(seed) + ".scm", scene);
  }
  print_table(rows, all);
  return all.ok == all.runs ? 0 : 1;
}

bool for_the_tests(int argc, char** argv) {
  return argc == 1 || std::string(argv[1]).rfind("--gtest", 0) == 0;
}

}  // namespace
}  // namespace tw::fuzz

int main(int argc, char** argv) {
  using namespace tw::fuzz;
  if (for_the_tests(argc, argv)) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
  }
  if (std::string(argv[1]) == "--help") {
    print_help();
    return 0;
  }
  try {
    return judge_all(read_options(argc, argv));
  } catch (const tw::UserError& e) {
    std::fprintf(stderr, "fuzz-scenes: %s\n", e.what());
    return 2;
  }
}
