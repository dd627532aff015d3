// omnihil compare DATASET: how far a model is from a measurement, and where it is worst.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "hil/dataset/dataset_reader.h"
#include "hil/text/dataset_files.h"
#include "hil/text/toml_keys.h"
#include "identify/compare/force_error.h"
#include "identify/estimate/heard_commands.h"
#include "tools/command_line.h"
#include "tools/compare_report.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/options/dataset_options.h"
#include "tools/options/firmware_cost.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string dataset, model, json;
  OtherFirmware firmware;
  std::vector<std::string> tubes;
  bool runs = false;
};

std::vector<std::string> compared_names(const Predictor& predictor) {
  std::vector<std::string> names;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const ComparedSignal& signal : predictor.compared(r)) {
      if (std::find(names.begin(), names.end(), signal.name) == names.end()) names.push_back(signal.name);
    }
  }
  return names;
}

std::vector<Tube> read_tubes(const Arguments& a, const std::vector<std::string>& names,
                             std::vector<std::string>& faults) {
  std::vector<Tube> tubes;
  const std::vector<std::string_view> words(names.begin(), names.end());
  for (const std::string& text : a.tubes) {
    std::string fault;
    std::optional<Tube> tube = parse_tube(text, fault);
    if (tube && std::find(names.begin(), names.end(), tube->signal) == names.end())
      fault = fmt::format("--tube {}: this signal is not compared here; {}", text,
                          spelling_hint(tube->signal, words));
    if (!fault.empty()) {
      faults.push_back(std::move(fault));
    } else {
      tubes.push_back(std::move(*tube));
    }
  }
  return tubes;
}

void add_left_out(const Predictor& predictor, std::vector<std::string>& out) {
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const ComparedSignal& signal : predictor.compared(r)) {
      if (signal.left_out.empty()) continue;
      const std::string line = fmt::format("{}, {}: {}", predictor.run(r).file, signal.name, signal.left_out);
      constexpr std::size_t kShown = 6;
      if (out.size() < kShown) out.push_back(line);
      if (out.size() == kShown) out.push_back("… and likewise in further runs");
    }
  }
}

int run(const Arguments& a) {
  DatasetReading reading = read_dataset(a.dataset, a.model, a.firmware);
  for (const ModelProblem& p : reading.problems)
    std::fprintf(stderr, "omnihil compare: %s\n", p.text().c_str());
  if (!reading.dataset) return kExitBadInput;
  const FirmwareMeter meter(*reading.dataset);
  const Dataset dataset = heard_commands(*reading.dataset, *reading.nominal, {}).dataset;
  const auto predictor = make_predictor(dataset, *reading.nominal, {});
  const std::vector<std::string> names = compared_names(*predictor);
  std::vector<std::string> faults;
  const std::vector<Tube> tubes = read_tubes(a, names, faults);
  for (const std::string& fault : faults) std::fprintf(stderr, "omnihil compare: %s\n", fault.c_str());
  if (!faults.empty()) return kExitBadInput;

  std::vector<Prediction> predictions;
  for (int r = 0; r < predictor->run_count(); ++r)
    predictions.push_back(predictor->predict(*reading.nominal, r));
  CompareReport report;
  report.dataset = a.dataset;
  report.model = a.model;
  report.method = predictor->method();
  report.notes = dataset.notes;
  report.findings = check_data(*reading.dataset, *reading.nominal);
  for (const Run& r : reading.dataset->runs) report.run_files.push_back(r.file);
  report.comparison = compare(*predictor, *reading.nominal, predictions);
  report.per_run = a.runs;
  add_left_out(*predictor, report.left_out);
  for (const std::string& name : names) {
    if (const auto offset = clock_offset(*predictor, predictions, name))
      report.offsets.emplace_back(name, *offset);
  }
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation}) {
    if (const auto error = force_error(*predictor, predictions, split))
      report.force_errors.emplace_back(split, *error);
  }
  for (const Tube& tube : tubes) report.tubes.emplace_back(tube, hold_in_tube(*predictor, predictions, tube));
  if (a.json == "-") {
    std::fputs(compare_json(report).c_str(), stdout);
  } else {
    std::fputs(compare_text(report).c_str(), stdout);
    if (!a.json.empty()) replace_file(a.json, compare_json(report));
  }
  say_firmware_cost("compare", meter);
  if (!report.comparison.diverged.empty()) return kExitDiverged;
  return report.outside() ? kExitDiffers : kExitOk;
}

}  // namespace

void add_verb_compare(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb =
      program.add_subcommand("compare", "how far a model is from a measurement, and where it is worst");
  verb.add_option("DATASET", a->dataset, "folder of a measurement, or its dataset.toml").required();
  verb.add_option("--model", a->model, "model file in place of the dataset's own");
  add_dataset_firmware_options(verb, a->firmware);
  verb.add_option(
      "--tube", a->tubes,
      "SIGNAL=TOLERANCE[%][/SECONDS]: exit with 1 when a sample is farther from the model (%: of the "
      "measured range; seconds: and not met within that time either)");
  verb.add_flag("--runs", a->runs, "errors of every run as well");
  verb.add_option("--json", a->json, "write the result as JSON; - for standard output in place of the table");
  verb.callback([a, &result] { result.exit_code = guarded("compare", [&] { return run(*a); }); });
}

}  // namespace omnihil
