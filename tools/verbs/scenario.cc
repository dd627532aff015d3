// omnihil scenario run FILE|FOLDER …: a test bench for controllers. The work is in hil/scenario/.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/recording/recording_header.h"
#include "hil/scenario/scenario_rows.h"
#include "hil/scenario/scenario_suite.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/options/console_options.h"
#include "tools/options/firmware_options.h"
#include "tools/options/gdb_options.h"
#include "tools/options/observe_options.h"
#include "tools/options/scenario_fuzz.h"
#include "tools/options/variable_options.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::vector<std::string> paths;
  std::string level, junit, json, physics = "planar";
  std::string bench;  // expanded before the command line is read (bench_expansion.h)
  bool all = false, no_plots = false;
  SuiteOptions suite;
  GdbWords gdb;
  std::string console;
  ObserveWords observe;
};

void print_rows() {
  fmt::print("Steps, [[step]] at_s = …, do = \"…\" (a fault lasts for_s, or to the end):\n");
  for (const StepRow& row : step_rows()) {
    fmt::print("  {}\n      {}\n      {}\n", row.word, row.what, row.example);
  }
  fmt::print(
      "\nChecks, [[check]] is = \"…\" (over from_s to to_s; from the step's instant to the next step where "
      "none are given):\n");
  for (const CheckRow& row : check_rows()) {
    const std::string limit = row.kind == CheckKind::kSignal ? "at_most_…, at_least_…"
                              : row.suffix.empty()           ? ""
                                                             : fmt::format("at_most_{}", row.suffix);
    fmt::print("  {:<20} {}\n      {}\n", row.word, limit, row.what);
  }
  fmt::print("\nSignals, in a check's signal = \"…\":\n");
  for (const ScenarioSignal& row : scenario_signals()) {
    fmt::print("  {:<28} {}{}\n", row.name, row.what, row.of_wheels ? ", per wheel" : "");
  }
  fmt::print(
      "  {:<28} a variable of the firmware by name (omnihil variables); its limits: at_most_value, "
      "at_least_value\n",
      "var:NAME");
}

int list(const Arguments& a) {
  if (a.paths.empty() && a.level.empty()) print_rows();
  const SuiteReading suite = read_suite(a.paths, a.level, data_folder("examples/scenarios"));
  for (const std::string& problem : suite.problems) fmt::print(stderr, "omnihil scenario: {}\n", problem);
  if (!suite.problems.empty()) return kExitBadInput;
  if (a.paths.empty()) fmt::print("{}Shipped scenarios:\n", a.level.empty() ? "\n" : "");
  for (const Scenario& s : suite.scenarios) {
    fmt::print("  {:<28} {}\n", s.file, s.title);
  }
  return kExitOk;
}

int run(Arguments& a) {
  const SuiteReading suite = read_suite(a.paths, a.level, data_folder("examples/scenarios"));
  for (const std::string& problem : suite.problems) fmt::print(stderr, "omnihil scenario: {}\n", problem);
  if (!suite.problems.empty()) return kExitBadInput;
  if (suite.scenarios.empty()) throw std::invalid_argument("no scenario of level \"" + a.level + "\"");
  a.suite.model_folders = {data_folder("models")};
  a.suite.physics = *parse_physics(a.physics);
  if (a.no_plots) a.suite.plots.clear();
  const std::unique_ptr<GdbServer> gdb = open_gdb(a.gdb, [] { return false; });
  if (gdb && suite.scenarios.size() != 1)
    throw std::invalid_argument(
        fmt::format("--gdb: {} scenarios; allowed: one at a time", suite.scenarios.size()));
  a.suite.gdb = gdb.get();
  a.suite.firmware.listeners.on_line = console_listener(a.console);
  a.suite.firmware.listeners.on_board = gdb_listener(gdb.get());
  ImageReports reports(a.observe, a.suite.firmware.file);
  a.suite.firmware.observer = reports.observer();
  std::vector<ScenarioOutcome> outcomes;
  bool passed = true, firmware_failed = false;
  for (const Scenario& scenario : suite.scenarios) {
    outcomes.push_back(run_one(scenario, a.suite));
    const ScenarioOutcome& o = outcomes.back();
    if (outcomes.size() == 1) fmt::print("firmware \"{}\"\n", o.firmware);
    fmt::print("{}", scenario_text(o, a.all));
    const std::string stem = std::filesystem::path(scenario.file).stem().string();
    fmt::print("{}", reports.write_trace(suite.scenarios.size() > 1 ? stem : "", !o.passed()));
    std::fflush(stdout);
    passed = passed && o.passed();
    firmware_failed = firmware_failed || o.firmware_failed;
  }
  fmt::print("{}", summary_line(outcomes));
  fmt::print("{}", reports.write_profile());
  if (!a.junit.empty()) write_text_file(a.junit, junit_xml(outcomes));
  if (!a.json.empty()) write_text_file(a.json, scenario_json(outcomes, program_commit()));
  const int code = firmware_failed ? kExitFirmware : passed ? kExitOk : kExitDiffers;
  if (gdb) gdb->end(code);
  return code;
}

void add_run(Verb& verb, const std::shared_ptr<Arguments>& a, VerbResult& result) {
  Verb sub = verb.add_subcommand("run", "run scenarios and judge them");
  sub.add_option("PATH", a->paths,
                 "scenario files, folders of them, or names of shipped ones; none: all shipped");
  sub.add_option(
      "--bench", a->bench,
      "robot, firmware, effects, radio, physics and seed as this bench file says (docs/bench.md); what "
      "is given here wins");
  add_firmware_options(sub, a->suite.firmware);
  add_gdb_options(sub, a->gdb);
  add_console_option(sub, a->console);
  add_variable_options(sub, a->suite.watch, a->suite.set);
  add_trace_options(sub, a->observe, "a check fails");
  add_profile_options(sub, a->observe);
  sub.add_option(
      "--csv", a->suite.csv,
      "folder for a table per scenario: every signal and watched variable at every control period");
  sub.add_option("--level", a->level,
                 "wheel: what a firmware of one wheel can do, too; robot; without it: all")
      .one_of({"wheel", "robot", "field"});
  sub.add_option("--robot", a->suite.robot, "robot model instead of the scenarios' own, by name or path");
  sub.add_option("--with", a->suite.with, "add an effect: ID.parameter=value, or ID; several allowed");
  sub.add_option("--radio", a->suite.radio, "radio format instead of the robot model's");
  sub.add_option("--physics", a->physics, "planar, simbody or simbody-free")
      .one_of({"simbody", "planar", "simbody-free"})
      .capture_default_str();
  sub.add_option("--seed", a->suite.seed, "of everything random").capture_default_str();
  sub.add_option("--junit", a->junit, "write JUnit XML to this file");
  sub.add_option("--json", a->json, "write every check's numbers to this file");
  a->suite.plots = "scenario-plots";
  sub.add_option("--plots", a->suite.plots, "folder for one SVG per failed scenario; made when one fails")
      .capture_default_str();
  sub.add_flag("--no-plots", a->no_plots, "no plots");
  sub.add_flag("--all", a->all, "print passed checks, too");
  sub.footer(
      "`omnihil scenario list` says which steps, checks and signals there are; docs/firmware.md is the "
      "tutorial.\n"
      "Exit codes: 0 all checks passed, 1 a check failed, 2 unusable scenario, robot or firmware, 3 a file "
      "could\n"
      "not be read or written, 6 the firmware crashed or hung.");
  sub.callback([a, &result] { result.exit_code = guarded("scenario", [&] { return run(*a); }); });
}

}  // namespace

void add_verb_scenario(Verb& program, VerbResult& result) {
  Verb verb = program.add_subcommand("scenario", "a test bench for controllers: steps, faults, checks");
  verb.require_subcommand(1);
  auto a = std::make_shared<Arguments>();
  add_run(verb, a, result);
  add_scenario_fuzz(verb, result);
  auto b = std::make_shared<Arguments>();
  Verb sub =
      verb.add_subcommand("list", "what can stand in a scenario; or the scenarios in files and folders");
  sub.add_option("PATH", b->paths, "scenario files, or folders of them");
  sub.add_option("--level", b->level, "wheel, robot or field").one_of({"wheel", "robot", "field"});
  sub.callback([b, &result] { result.exit_code = guarded("scenario", [&] { return list(*b); }); });
}

}  // namespace omnihil
