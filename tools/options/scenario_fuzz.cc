#include "tools/options/scenario_fuzz.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/scenario/chip_fuzz.h"
#include "hil/scenario/scenario_rows.h"
#include "hil/text/program_files.h"
#include "hil/text/text_file.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/options/firmware_options.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

struct FuzzArguments {
  std::vector<std::string> paths, kinds;
  std::string out = "fuzz-failures";
  SuiteOptions suite;
  FuzzOptions fuzz;
};

void write_case(const fs::path& file, const std::string& text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  write_text_file(file, text);
}

void print_failure(const FuzzArguments& a, const Scenario& scenario, const FuzzFailure& f) {
  const fs::path file =
      fs::path(a.out) /
      fmt::format("{}-{}-{}.toml", fs::path(scenario.file).stem().string(), a.fuzz.seed, f.number);
  write_case(file, f.file_text);
  fmt::print("FAIL  {} case {}: {} faults, {} of them are enough\n", scenario.file, f.number, f.drawn.size(),
             f.faults.size());
  for (const ChipFault& fault : f.faults) fmt::print("  {}\n", fault_words(fault));
  fmt::print("  {}\n  {}\n", f.why, file.string());
}

int fuzz(FuzzArguments& a) {
  const std::vector<std::string> usual{"robot/radio_silence"};
  const SuiteReading suite =
      read_suite(a.paths.empty() ? usual : a.paths, "", data_folder("examples/scenarios"));
  for (const std::string& problem : suite.problems) fmt::print(stderr, "omnihil scenario: {}\n", problem);
  if (!suite.problems.empty()) return kExitBadInput;
  for (const std::string& word : a.kinds) a.fuzz.kinds.push_back(*chip_fault_kind(word));
  a.suite.model_folders = {data_folder("models")};
  bool failed = false;
  for (const Scenario& scenario : suite.scenarios) {
    const FuzzOutcome outcome = fuzz_scenario(scenario, a.suite, a.fuzz);
    for (const FuzzFailure& f : outcome.failures) print_failure(a, scenario, f);
    fmt::print("{}: {} cases of seed {}, {} failed; {} runs\n", scenario.file, outcome.cases, a.fuzz.seed,
               outcome.failures.size(), outcome.runs);
    std::fflush(stdout);
    failed = failed || !outcome.failures.empty();
  }
  return failed ? kExitDiffers : kExitOk;
}

}  // namespace

void add_scenario_fuzz(Verb& scenario, VerbResult& result) {
  auto a = std::make_shared<FuzzArguments>();
  Verb sub =
      scenario.add_subcommand("fuzz", "faults in the chip at random instants: does the robot stop safely?");
  sub.add_option("PATH", a->paths,
                 "scenarios with a command and a radio_silence after it; none: robot/radio_silence");
  add_firmware_options(sub, a->suite.firmware);
  std::vector<std::string> words;
  for (int k = 0; k < kChipFaultKinds; ++k)
    words.emplace_back(chip_fault_word(static_cast<ChipFaultKind>(k)));
  sub.add_option("--faults", a->kinds, "kinds of faults to draw; several allowed (default: all)")
      .one_of(words);
  sub.add_option("--cases", a->fuzz.cases, "how many").range(1, 1'000'000).capture_default_str();
  sub.add_option("--most", a->fuzz.most, "faults of a case, at most").range(1, 100).capture_default_str();
  sub.add_option("--seed", a->fuzz.seed, "the same seed draws the same cases").capture_default_str();
  sub.add_option("--within", a->fuzz.within_s,
                 "s after the silence from which on every wheel stands or its bridge is off")
      .positive()
      .capture_default_str();
  sub.add_option("--robot", a->suite.robot, "robot model instead of the scenarios' own, by name or path");
  sub.add_option("--out", a->out, "folder for one scenario per case that failed, as small as it got")
      .capture_default_str();
  sub.footer(
      "docs/chip-faults.md has the faults and how cases get small.\n"
      "Exit codes: 0 all stopped safely, 1 some did not, 2 unusable scenario or firmware, 3 a file could not "
      "be\n"
      "written.");
  sub.callback([a, &result] { result.exit_code = guarded("scenario", [&] { return fuzz(*a); }); });
}

}  // namespace omnihil
