#include "hil/scenario/scenario_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "hil/loop/effect_overrides.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"
#include "hil/scenario/scenario_plot.h"
#include "hil/scenario/trace_csv.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
constexpr int kRobotId = 1;
constexpr const char* kDefaultRadio = "ulaval-hermes";

std::vector<std::string> files_of(const std::string& path, std::vector<std::string>& problems) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(path, error)) {
    if (entry.is_regular_file() && entry.path().extension() == ".toml")
      files.push_back(entry.path().string());
  }
  if (error) problems.push_back(fmt::format("{}: {}", path, error.message()));
  if (!error && files.empty()) problems.push_back(path + ": no .toml file in this folder");
  std::ranges::sort(files);
  return files;
}

// What a user names: a path, or a name among the shipped ones.
std::string path_of(const std::string& named, const std::string& shipped) {
  if (fs::exists(named) || shipped.empty()) return named;
  for (const char* ending : {"", ".toml"}) {
    const fs::path path = fs::path(shipped) / (named + ending);
    if (fs::exists(path)) return path.string();
  }
  return named;
}

// Shipped ones go by their short name.
std::string shown_name(const std::string& file, const std::string& shipped) {
  if (shipped.empty() || !file.starts_with(shipped)) return file;
  return fs::relative(file, shipped).string();
}

SessionConfig config_of(const Scenario& scenario, const SuiteOptions& options) {
  std::vector<std::string> problems;
  SessionSetup setup;
  const StoredModel stored =
      load_robot_model(options.robot.empty() ? scenario.robot : options.robot, options.model_folders);
  for (const ModelProblem& problem : stored.problems) problems.push_back(problem.text());
  setup.model = stored.bundle;
  if (stored.problems.empty()) add_effects(setup.model, options.with, problems);
  throw_problems(problems);
  setup.radio_format = options.radio;
  if (setup.radio_format.empty() && stored.model) setup.radio_format = stored.model->radio;
  if (setup.radio_format.empty()) setup.radio_format = kDefaultRadio;
  setup.robot_ids = {kRobotId};
  setup.field.contacts = scenario.level == "field" || !scenario.field.empty() || scenario.opponents > 0;
  if (!scenario.field.empty()) setup.field.size = find_field(scenario.field);
  for (int id = 0; id < scenario.opponents; ++id) setup.opponent_ids.push_back(id);
  setup.plant.physics = options.physics;
  setup.plant.seed = options.seed;
  return session_config(setup);
}

void write(const fs::path& file, const std::string& text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  write_text_file(file, text);
}

FirmwareChoice heard_by(ScenarioConsole& console, FirmwareChoice choice) {
  choice.listeners.on_line = console.keeper.listener(choice.listeners.on_line);
  choice.listeners.typed = [&console](std::uint32_t) -> std::string_view { return console.typed; };
  choice.listeners.on_board = [&console, also = choice.listeners.on_board](const MadeBoard& made) {
    for (const mcu::PortEntry& port : made.mcu.spec().ports) {
      console.there = console.there || port.console;
      console.reads = console.reads || (port.console && port.reads());
    }
    if (also) also(made);
  };
  return choice;
}

// The plot of the first failed check that has signals.
std::string plot_failure(const ScenarioOutcome& o, const ScenarioTrace& trace, const std::string& folder) {
  const auto failed =
      std::ranges::find_if(o.results, [](const CheckResult& r) { return !r.passed && !r.signals.empty(); });
  if (folder.empty() || failed == o.results.end()) return {};
  const fs::path file = fs::path(folder) / (fs::path(o.scenario.file).stem().string() + ".svg");
  write(file, scenario_plot(fmt::format("{}: {}{}", o.scenario.title, failed->name,
                                        failed->wheel < 0 ? "" : fmt::format(", wheel {}", failed->wheel)),
                            trace, *failed));
  return file.string();
}

}  // namespace

SuiteReading read_suite(const std::vector<std::string>& paths, const std::string& level,
                        const std::string& shipped) {
  SuiteReading suite;
  const std::vector<std::string> all{shipped};
  for (const std::string& named : paths.empty() ? all : paths) {
    const std::string path = path_of(named, shipped);
    for (const std::string& file : files_of(path, suite.problems)) {
      std::string error;
      const std::string text = read_text_file(file, error);
      if (!error.empty()) {
        suite.problems.push_back(file + ": " + error);
        continue;
      }
      ScenarioReading reading = read_scenario(text, shown_name(file, shipped));
      for (const ModelProblem& problem : reading.problems) suite.problems.push_back(problem.text());
      if (!reading.scenario || (!level.empty() && reading.scenario->level != level)) continue;
      suite.scenarios.push_back(std::move(*reading.scenario));
    }
  }
  return suite;
}

ScenarioRun run_of(const Scenario& scenario, const SuiteOptions& options) {
  const SessionConfig config = config_of(scenario, options);
  ScenarioConsole console;
  const Session::FirmwareMaker maker = open_firmware(heard_by(console, options.firmware), config);
  const Session::FirmwareMaker opponents = open_firmware(options.firmware, config);
  bool first = true;  // the robot that is looked at is made before its opponents
  const auto make = [&](const RobotConfig& robot) {
    std::unique_ptr<Firmware> firmware = std::exchange(first, false) ? maker(robot) : opponents(robot);
    if (options.gdb != nullptr && !options.gdb->problem().empty())
      throw std::invalid_argument("--gdb: " + options.gdb->problem());
    return firmware;
  };
  return run_scenario(scenario, config, make, {options.firmware.file, options.watch, options.set}, &console);
}

ScenarioOutcome run_one(const Scenario& scenario, const SuiteOptions& options) {
  const ScenarioRun run = run_of(scenario, options);
  if (!options.csv.empty())
    write(fs::path(options.csv) / (fs::path(scenario.file).stem().string() + ".csv"), trace_csv(run.trace));
  ScenarioOutcome outcome;
  outcome.scenario = scenario;
  outcome.firmware = run.firmware;
  outcome.commands = run.commands;
  outcome.results = check_scenario(scenario, run);
  outcome.firmware_failed = run.firmware_failed;
  outcome.console = run.console;
  outcome.plot = plot_failure(outcome, run.trace, options.plots);
  return outcome;
}

}  // namespace omnihil
