#include "tools/options/import_dataset.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "hil/dataset/dataset_reader.h"
#include "hil/logs/log_dataset.h"
#include "hil/loop/model_store.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "identify/checks/check_data.h"
#include "identify/record/rig.h"
#include "tools/exit_codes.h"
#include "tools/options/capture_options.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// A folder of its own that goes away with it.
class ScratchFolder {
 public:
  ScratchFolder() : path_((fs::temp_directory_path() / "omnihil-import-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) throw std::system_error(errno, std::generic_category(), path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string path_of_model(const std::string& model) {
  if (fs::exists(model)) return model;
  const StoredModel stored = load_model(model, {data_folder("models")});
  return stored.bundle.robot_file.empty() ? model : stored.bundle.robot_file;
}

// The model's rig decides which signals there are; its text goes into the dataset.
bool take_model(const ImportDatasetWords& words, LogDatasetOptions& options) {
  if (words.model.empty())
    throw std::invalid_argument(
        "--model: found none, allowed: the nominal model of what was measured (docs/import.md has one to "
        "fill in); it says axis or robot, "
        "and is copied into the dataset");
  const CandidateReading model = read_candidate(path_of_model(words.model));
  for (const ModelProblem& p : model.problems) std::fprintf(stderr, "omnihil import: %s\n", p.text().c_str());
  if (!model.candidate) return false;
  const ModelFile& file = model.candidate->file;
  options.context.rig = file.rig == "robot" ? &rig_robot() : &rig_axis();
  options.context.linear = file.linear;
  options.context.pole_pairs = file.parameters.value_or("motor.pole_pairs", 0.0);
  if (file.robot) {
    options.geometry.wheels = wheel_geometry(*file.robot);
    options.geometry.gear_ratio = file.robot->gear_ratio;
  }
  options.model_text = file.motor_file.empty() ? model.text : candidate_text(*model.candidate);
  if (!(options.counts_per_rev > 0.0))
    options.counts_per_rev = file.parameters.value_or("encoder.counts_per_turn", 0.0);
  options.geometry.counts_per_rotor_turn =
      options.counts_per_rev / (options.on_output ? options.geometry.gear_ratio : 1.0);
  return true;
}

// "t_s,duty,rpm"
std::vector<std::string> split_at_commas(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (const std::string& word : words) {
    std::istringstream parts(word);
    for (std::string part; std::getline(parts, part, ',');) out.push_back(part);
  }
  return out;
}

std::vector<LogRun> read_runs(const ImportDatasetWords& words) {
  std::vector<LogRun> runs;
  const LogOptions options{split_at_commas(words.columns)};
  const auto add = [&](const std::vector<std::string>& files, Split use) {
    for (const std::string& file : files)
      runs.push_back({file, hash_file(file), read_log(file, options), use});
  };
  add(words.files, kTraining);
  add(words.holdout, kValidation);
  add(words.extrapolation, kExtrapolation);
  for (const std::string& pair : words.poses) {
    const std::size_t at = pair.find('=');
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const LogRun& r) {
      return at != std::string::npos && fs::path(r.path).stem().string() == pair.substr(0, at);
    });
    if (run == runs.end()) {
      std::string names;
      for (const LogRun& r : runs) names += (names.empty() ? "" : ", ") + fs::path(r.path).stem().string();
      throw std::invalid_argument(
          fmt::format("--pose {}: no such run; allowed: RUN=FILE, RUN one of {}", pair, names));
    }
    run->pose_path = pair.substr(at + 1);
    run->pose = read_log(run->pose_path, {});
  }
  return runs;
}

// Asks a person at a terminal for one more --map; false: there is none, or no answer.
bool ask(std::vector<ColumnMap>& asked) {
  if (::isatty(STDIN_FILENO) == 0) return false;
  for (;;) {
    fmt::print("COLUMN=SIGNAL:UNIT (empty to stop): ");
    std::fflush(stdout);
    std::string line;
    if (!std::getline(std::cin, line) || line.empty()) return false;
    std::vector<std::string> faults;
    ColumnMap map = parse_map(line, faults);
    for (const std::string& fault : faults) fmt::print("{}\n", fault);
    if (!faults.empty()) continue;
    asked.push_back(std::move(map));
    return true;
  }
}

// Read back as `compare` reads it; what it says is said. Exit code.
int check_written(const LogDataset& made, const std::string& out) {
  const ScratchFolder scratch;
  for (const DatasetFile& file : made.files) write_new_file(fs::path(scratch.path()) / file.name, file.text);
  const DatasetReading reading = read_dataset(scratch.path());
  for (const ModelProblem& p : reading.problems)
    std::fprintf(stderr, "omnihil import: %s\n", p.text().c_str());
  if (!reading.dataset) return kExitBadInput;
  NewFolder folder(out);
  for (const DatasetFile& file : made.files) folder.write(file.name, file.text);
  folder.finish();
  for (const std::string& note : reading.dataset->notes) fmt::print("note: {}\n", note);
  const std::vector<DataFinding> findings = check_data(*reading.dataset, *reading.nominal);
  for (const DataFinding& f : findings) {
    fmt::print("{}: {}\n",
               f.grade == DataFinding::Grade::kFault   ? "data fault"
               : f.grade == DataFinding::Grade::kDoubt ? "doubtful"
                                                       : "note",
               f.sentence);
  }
  std::size_t rows = 0;
  for (const Run& run : reading.dataset->runs) rows += run.time_s.size();
  fmt::print("{}: {} runs, {} rows; picture in import.svg\n", out, reading.dataset->runs.size(), rows);
  return first_fault(findings) == nullptr ? kExitOk : kExitDiffers;
}

}  // namespace

bool ImportDatasetWords::any() const {
  return !holdout.empty() || !extrapolation.empty() || !maps.empty() || !columns.empty() ||
         !imposed.empty() || !model.empty() || !title.empty() || counts_per_rev > 0.0 || period_s > 0.0 ||
         split < 1.0 || si || !poses.empty();
}

int import_dataset(ImportDatasetWords words) {
  LogDatasetOptions options;
  std::vector<std::string> faults;
  for (const std::string& map : words.maps) options.asked.push_back(parse_map(map, faults));
  for (const std::string& fault : faults) std::fprintf(stderr, "omnihil import: %s\n", fault.c_str());
  if (!faults.empty()) return kExitBadInput;
  options.counts_per_rev = words.counts_per_rev;
  options.on_output = words.shaft == "output";
  options.fit_share = words.split;
  options.title = words.title.empty() ? fs::path(words.files.front()).stem().string() : words.title;
  options.context.period_s = words.period_s;
  options.context.imposed = words.imposed;
  options.context.si = words.si;
  if (!take_model(words, options)) return kExitBadInput;
  if (fs::exists(words.out) && !(fs::is_directory(words.out) && fs::is_empty(words.out)))
    throw FileExists(words.out + ": is there already");
  const std::vector<LogRun> runs = read_runs(words);
  for (;;) {
    const LogDataset made = make_log_dataset(runs, options);
    fmt::print("{}\n", log_format_name(runs.front().table.format));
    for (const std::string& line : made.table) fmt::print("{}\n", line);
    std::fflush(stdout);
    if (made.doubts.empty()) {
      print_notes(made.notes);
      return check_written(made, words.out);
    }
    for (const std::string& doubt : made.doubts) std::fprintf(stderr, "omnihil import: %s\n", doubt.c_str());
    if (!ask(options.asked)) return kExitBadInput;
  }
}

void add_import_dataset_options(Verb& verb, ImportDatasetWords& words) {
  verb.add_option("--model", words.model, "dataset: the nominal model of what was measured, copied into it");
  verb.add_option("--map", words.maps,
                  "dataset: COLUMN=SIGNAL:UNIT says what a column is; COLUMN=- leaves it out");
  verb.add_flag("--si", words.si,
                "dataset: columns whose unit is not said are in rad/s, A, V, m, as the signals are");
  verb.add_option("--holdout", words.holdout, "dataset: logs that are never fitted to").type_name("LOG");
  verb.add_option("--extrapolation", words.extrapolation, "dataset: logs of another kind of motion")
      .type_name("LOG");
  verb.add_option("--split", words.split, "dataset: share of each log's time to fit on; the rest is held out")
      .range(0.05, 1.0);
  verb.add_option("--counts-per-rev", words.counts_per_rev,
                  "dataset: of an encoder, after quadrature (default: the model's)")
      .not_negative();
  verb.add_option("--shaft", words.shaft, "dataset: of the encoder").one_of({"rotor", "output"});
  verb.add_option("--columns", words.columns, "dataset: names of a table without a header line, by commas")
      .type_name("NAMES");
  verb.add_option("--period", words.period_s, "dataset: seconds from row to row, where no column is the time")
      .not_negative();
  verb.add_option("--pose", words.poses,
                  "dataset: RUN=FILE, poses that another device took of a robot's run (RUN: its log's name "
                  "without the "
                  "ending), on a clock of its own; put on the run's by what the wheels say")
      .type_name("RUN=FILE");
  verb.add_option("--imposed", words.imposed, "dataset: signals that the bench set, such as motor_current")
      .type_name("SIGNAL");
  verb.add_option("--title", words.title, "dataset: its title");
}

}  // namespace omnihil
