// omnihil diagnose DATASET: which physical effect is the model missing.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/report/diagnosis_json.h"
#include "hil/report/report_html.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "tools/command_line.h"
#include "tools/diagnosis_text.h"
#include "tools/exit_codes.h"
#include "tools/fitted_model.h"
#include "tools/guarded.h"
#include "tools/options/dataset_options.h"
#include "tools/options/firmware_cost.h"
#include "tools/program_commit.h"
#include "tools/progress_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string dataset;
  std::string model;
  OtherFirmware firmware;
  std::string json;
  std::string report;
  std::string write;
  DiagnoseOptions options;
  bool quick = false;
  bool progress = false;

  Arguments() { options.jobs = 2; }
};

void write_report(const Arguments& a, const DatasetReading& reading, const Diagnosis& diagnosis,
                  double elapsed_s) {
  const std::unique_ptr<Predictor> predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  ReportInput input = report_input(*reading.dataset, *predictor, diagnosis, {.jobs = a.options.jobs});
  input.model = a.model.empty() ? "the dataset's own" : a.model;
  input.command = "omnihil diagnose " + a.dataset;
  input.program = fmt::format("omnihil {} ({})", OMNIHIL_VERSION, program_commit());
  input.elapsed_s = elapsed_s;
  replace_file(a.report, report_html(input));
}

int run(const Arguments& a) {
  DatasetReading reading = read_dataset(a.dataset, a.model, a.firmware);
  for (const ModelProblem& p : reading.problems)
    std::fprintf(stderr, "omnihil diagnose: %s\n", p.text().c_str());
  if (!reading.dataset) return kExitBadInput;
  const FirmwareMeter meter(*reading.dataset);
  if (reading.dataset->firmware)
    say_firmware_ahead("diagnose", meter, *make_predictor(*reading.dataset, *reading.nominal, {}),
                       *reading.nominal, unknowns_of(*reading.nominal).size());
  StopSignals stop;
  Diagnosis diagnosis;
  double elapsed_s = 0.0;
  {
    ProgressLine line(a.progress);
    DiagnoseOptions options = a.options;
    if (a.quick) options.max_effects = 1;
    options.progress = [&](const Progress& p) {
      line.show(p.doing, p.share);
      return !StopSignals::requested();
    };
    options.stop = [] { return StopSignals::requested(); };
    diagnosis = diagnose(*reading.dataset, *reading.nominal, options);
    elapsed_s = line.elapsed_s();
  }
  say_firmware_cost("diagnose", meter);
  const std::string model_text =
      diagnosis.final_fit.model.effects.empty() && diagnosis.final_fit.parameters.empty()
          ? reading.model_text
          : fitted_model_text(diagnosis.final_fit, a.dataset, *reading.dataset);
  if (!a.write.empty() && diagnosis.complete) replace_file_keeping_old(a.write, model_text);
  const std::string json = a.json.empty()
                               ? ""
                               : diagnosis_json(diagnosis, {.elapsed_s = elapsed_s,
                                                            .model = a.write.empty() ? model_text : a.write});
  if (a.json == "-") {
    std::fputs(json.c_str(), stdout);
  } else {
    if (!a.json.empty()) replace_file(a.json, json);
    std::fputs(diagnosis_text(diagnosis).c_str(), stdout);
  }
  if (!a.report.empty()) write_report(a, reading, diagnosis, elapsed_s);
  return diagnosis.complete ? kExitOk : kExitInterrupted;
}

}  // namespace

void add_verb_diagnose(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb =
      program.add_subcommand("diagnose", "which physical effect a model lacks, and what to measure next");
  verb.add_option("DATASET", a->dataset, "folder of a measurement, or its dataset.toml").required();
  verb.add_option("--model", a->model, "model to start from, in place of the dataset's own");
  add_dataset_firmware_options(verb, a->firmware);
  verb.add_option("--json", a->json,
                  "diagnosis as JSON (omnihil-diagnosis/1); - : to stdout, in place of the text");
  verb.add_option("--report", a->report, "diagnosis as one HTML file");
  verb.add_option("--write", a->write, "the mended model; a file that is there is kept as FILE.1");
  verb.add_option("--seed", a->options.seed, "of the simulated null and of the bootstrap")
      .capture_default_str();
  verb.add_option("--jobs", a->options.jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.add_flag("--quick", a->quick, "the first effect only");
  verb.add_flag(
      "--pairs", a->options.pairs,
      "search two effects that mask each other also where others have been found: two further iterations");
  verb.add_flag("--anyway", a->options.despite_faults,
                "search for effects although the data have a fault that can be taken for one");
  verb.add_flag("--progress", a->progress,
                "what is being done, line by line with its time, on stderr; first ranking: the first answer");
  verb.footer(
      "A verdict is no failure: exit code 0 whatever it is. Ctrl-C says what is known by then and ends with "
      "130;\n"
      "no model is written then.");
  verb.callback([a, &result] { result.exit_code = guarded("diagnose", [&] { return run(*a); }); });
}

}  // namespace omnihil
