// omnihil models [NAME|PATH] [--check FILE…] [--export FORMAT] [--keys]: lists, explains, checks or exports model files.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "hil/card/card_gallery.h"
#include "hil/loop/model_store.h"
#include "hil/model_export/model_export.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "sim/model/model_figures.h"
#include "sim/model/model_keys.h"
#include "sim/robot/validate.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

const std::vector<std::string>& folders() {
  static const std::vector<std::string> kFolders = {data_folder("models")};
  return kFolders;
}

struct Arguments {
  std::string model;
  std::vector<std::string> check;
  std::string format, out;  // of --export
  bool keys = false;
};

void print_problems(const StoredModel& stored) {
  for (const ModelProblem& problem : stored.problems) std::fprintf(stderr, "%s\n", problem.text().c_str());
}

int list() {
  for (const ModelListing& listed : list_models(folders())) {
    const StoredModel stored = load_model(listed.path, {});
    const std::string what = stored.model ? stored.model->name
                                          : fmt::format("unusable: {} (omnihil models --check {})",
                                                        stored.problems.size(), listed.path);
    const char* rig = stored.model ? stored.model->rig.c_str() : "?";
    std::printf("%-22s %-6s %s\n", listed.name.c_str(), rig, what.c_str());
  }
  std::printf("\n`omnihil models NAME` explains one. A path works wherever a name does.\n");
  return kExitOk;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

std::string value_text(const Parameter& p) {
  if (is_text(*p.row)) return fmt::format("\"{}\"", p.text);
  if (p.row->kind == ParameterKind::kTruth) return p.value() != 0.0 ? "true" : "false";
  std::string out;
  for (const double v : p.values) out += (out.empty() ? "" : ", ") + number(v);
  if (p.row->unit != "1") out += fmt::format(" {}", p.row->unit);
  return out;
}

std::string fitted_text(const FittedNumber& fit) {
  return fit.sigma ? fmt::format("+-{:.2g}", *fit.sigma) : "fitted";
}

// "data sheet"; of a fitted number "fitted to sha256:9f86d081884c on 2026-11-23; believed 0.464 +-10 %, data sheet"
std::string origin_text(const Parameter& p) {
  if (p.origin == Origin::kDefault) return "default";
  std::string out = p.source;
  if (p.fitted) {
    out = "fitted";
    if (!p.fitted->data.empty()) out += " to " + p.fitted->data;
    if (!p.fitted->date.empty()) out += " on " + p.fitted->date;
    if (p.fitted->believed) out += "; believed " + number(*p.fitted->believed);
    if (p.fitted->believed && p.tolerance) out += fmt::format(" +-{:g} %", 100.0 * *p.tolerance);
    if (p.fitted->believed && !p.source.empty()) out += ", " + p.source;
  }
  if (p.origin == Origin::kMotorFile) out += out.empty() ? "motor file" : " (motor file)";
  return out;
}

void print_parameters(const ModelFile& model) {
  std::string_view section;
  for (const Parameter& p : model.parameters.parameters) {
    if (p.row->section.empty()) continue;
    if (p.row->section != section) {
      section = p.row->section;
      std::printf("\n[%s]\n", std::string(section).c_str());
    }
    const std::string known = is_text(*p.row) || p.origin == Origin::kDefault ? ""
                              : p.fitted                                      ? fitted_text(*p.fitted)
                              : p.tolerance ? fmt::format("+-{:g} %", 100.0 * *p.tolerance)
                                            : "exact";
    std::printf("  %-30s %-26s %-8s %s\n", std::string(p.row->key).c_str(), value_text(p).c_str(),
                known.c_str(), origin_text(p).c_str());
    std::printf("  %-30s %s\n", "", std::string(p.row->what).c_str());
  }
}

int explain(const std::string& path_or_name) {
  const StoredModel stored = load_model(path_or_name, folders());
  print_problems(stored);
  if (!stored.model) return kExitBadInput;
  const ModelFile& model = *stored.model;
  std::printf("%s: %s\n", stored.bundle.name.c_str(), model.name.empty() ? "(no name)" : model.name.c_str());
  std::printf("  file    %s\n", stored.bundle.robot_file.c_str());
  std::printf("  rig     %s%s\n", model.rig.c_str(), model.linear ? ", linear" : "");
  if (!model.source.empty()) std::printf("  source  %s\n", model.source.c_str());
  if (!model.motor_file.empty()) {
    std::printf("  motor   %s, from %s\n", model.motor_name.c_str(), model.motor_file.c_str());
  }
  print_parameters(model);
  const std::vector<ModelFigure> figures = model_figures(model);
  if (!figures.empty()) std::printf("\nWhat follows from these numbers\n");
  for (const ModelFigure& f : figures) {
    std::printf("  %-32s %10.4g %-7s %s\n", f.name.c_str(), f.value, f.unit.c_str(), f.formula.c_str());
  }
  for (const std::string& note : stored.notes) std::printf("\nnote: %s\n", note.c_str());
  return kExitOk;
}

// What a bench at its usual settings would refuse: too light a wheel for its steps, a wheel without load.
std::vector<std::string> plant_problems_of(const StoredModel& stored) {
  if (!stored.model || !stored.model->robot) return {};
  return plant_problems({&*stored.model->robot, 1}, PlantOptions{});
}

int check(const std::vector<std::string>& files) {
  std::size_t problems = 0, stale = 0;
  for (const std::string& file : files) {
    const StoredModel stored = load_model(file, folders());
    print_problems(stored);
    const std::vector<std::string> refused = plant_problems_of(stored);
    for (const std::string& problem : refused)
      std::fprintf(stderr, "%s: %s\n", file.c_str(), problem.c_str());
    problems += stored.problems.size() + refused.size();
    if (stored.model && refused.empty())
      std::printf("%s: good (%s)\n", file.c_str(), stored.model->rig.c_str());
    for (const std::string& note : stored.notes) std::printf("note: %s\n", note.c_str());
    for (const std::string& note : stale_card_notes(stored.bundle.robot_file)) {
      std::printf("stale card: %s\n", note.c_str());
      ++stale;
    }
  }
  if (problems == 0) return stale == 0 ? kExitOk : kExitDiffers;
  std::fprintf(stderr, "%zu problem%s\n", problems, problems == 1 ? "" : "s");
  return kExitBadInput;
}

int print_keys() {
  std::fputs(model_keys_markdown().c_str(), stdout);
  return kExitOk;
}

int write_export(const Arguments& a) {
  if (a.model.empty()) throw std::invalid_argument("--export: needs MODEL, a robot's name or file");
  const StoredModel stored = load_robot_model(a.model, folders());
  print_problems(stored);
  if (!stored.model) return kExitBadInput;
  const ExportFormat format = a.format == "mjcf"   ? ExportFormat::kMjcf
                              : a.format == "urdf" ? ExportFormat::kUrdf
                                                   : ExportFormat::kC;
  const ModelExport made = export_robot(*stored.model, format, stored.bundle.name);
  if (!made.problem.empty()) {
    std::fprintf(stderr, "omnihil models: %s: %s\n", stored.bundle.robot_file.c_str(), made.problem.c_str());
    return kExitBadInput;
  }
  if (a.out.empty()) {
    std::fputs(made.text.c_str(), stdout);
  } else {
    replace_file(a.out, made.text);
  }
  std::FILE* to = a.out.empty() ? stderr : stdout;  // the file itself has standard output
  for (const std::string& line : made.lost) std::fprintf(to, "does not survive: %s\n", line.c_str());
  for (const std::string& line : made.assumed) std::fprintf(to, "assumed: %s\n", line.c_str());
  if (!a.out.empty()) std::printf("%s written\n", a.out.c_str());
  return kExitOk;
}

int run(const Arguments& a) {
  if (!a.out.empty() && a.format.empty()) throw std::invalid_argument("--out: goes with --export only");
  if (!a.format.empty()) return write_export(a);
  if (a.keys) return print_keys();
  if (!a.check.empty()) return check(a.check);
  return a.model.empty() ? list() : explain(a.model);
}

}  // namespace

void add_verb_models(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("models", "list robots and motors, explain one, or check model files");
  const Option model = verb.add_option("MODEL", arguments->model,
                                       "explain this model: every number, its tolerance and source");
  const Option files =
      verb.add_option("--check", arguments->check, "check these files; all problems with line and column")
          .type_name("FILE")
          .excludes(model);
  verb.add_flag("--keys", arguments->keys, "print every key a model file may have (Markdown)")
      .excludes(files);
  verb.add_option("--export", arguments->format,
                  "write MODEL, a robot, for another program, and say what is lost")
      .one_of({"mjcf", "urdf", "c"})
      .excludes(files);
  verb.add_option("--out", arguments->out, "file of --export (default: standard output)");
  verb.footer(
      "A name is looked for in $OMNIHIL_MODELS, then among the models that come with the program.\n"
      "Exit code 1 of --check: good, but edited since the card beside it was made (omnihil card).");
  verb.callback(
      [arguments, &result] { result.exit_code = guarded("models", [&] { return run(*arguments); }); });
}

}  // namespace omnihil
