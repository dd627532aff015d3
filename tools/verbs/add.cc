// omnihil add DATASET EFFECT: one effect added by hand, and what it changes.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "identify/select/add_effect.h"
#include "sim/law/expression.h"
#include "sim/model/effect_reader.h"
#include "tools/command_line.h"
#include "tools/diagnosis_text.h"
#include "tools/exit_codes.h"
#include "tools/fitted_model.h"
#include "tools/formula_argument.h"
#include "tools/guarded.h"
#include "tools/options/dataset_options.h"
#include "tools/options/firmware_cost.h"
#include "tools/progress_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string dataset;
  std::string effect;
  std::string model;
  OtherFirmware firmware;
  std::string write;
  std::uint64_t seed = 1;
  int jobs = 2;
  bool force = false;
};

// The effect by id (with a value, if one is given), or a formula. Faults are said; empty entry: none made.
EffectUse use_of(const Arguments& a, const Candidate& nominal) {
  if (a.effect.find("+=") != std::string::npos) {
    std::vector<std::string> faults;
    EffectUse use = formula_argument(a.effect, nominal.file.linear, faults);
    for (const std::string& f : faults) std::fprintf(stderr, "omnihil add: %s\n", f.c_str());
    return use;
  }
  const DriveParams<double> drive = drive_of(nominal);
  std::vector<EffectUse> uses;
  const EffectContext context{.drive = &drive, .linear = nominal.file.linear, .wheels = wheels_of(nominal)};
  const std::string fault = add_override(a.effect, context, uses);
  if (!fault.empty()) std::fprintf(stderr, "omnihil add: %s\n", fault.c_str());
  return uses.empty() ? EffectUse{} : uses.front();
}

std::string drift_text(const Addition& addition) {
  std::string out;
  for (const ParameterEstimate& p : addition.fit_after.parameters) {
    for (const ParameterEstimate& q : addition.fit_before.parameters) {
      if (q.path != p.path || q.value == 0.0) continue;
      out += fmt::format("  {:40} {:.5g} -> {:.5g} {}  ({:+.1f} %)\n", p.path, q.value, p.value, p.unit,
                         100.0 * (p.value / q.value - 1.0));
    }
  }
  return out;
}

int report(const Arguments& a, const Dataset& dataset, const Addition& addition, const std::string& name) {
  std::printf("Errors without -> with %s\n%s\n", name.c_str(),
              errors_change_text(addition.before, addition.after).c_str());
  std::printf("Base parameters, both refitted\n%s\n", drift_text(addition).c_str());
  std::string own;
  for (const ParameterEstimate& p : addition.fit_after.parameters) {
    if (p.path.starts_with(name + ".")) own += parameters_text({p}, {});
  }
  std::printf("Its numbers\n%s\n", own.c_str());
  std::printf("%s: %s\n", addition.useful ? "Useful" : "Not useful", addition.why.c_str());
  if (a.write.empty()) return addition.useful ? kExitOk : kExitDiffers;
  if (!addition.useful && !a.force) {
    std::printf("%s was not written; --force writes it all the same\n", a.write.c_str());
    return kExitDiffers;
  }
  replace_file_keeping_old(a.write, fitted_model_text(addition.fit_after, a.dataset, dataset));
  std::printf("%s written; what was there before is %s.1\n", a.write.c_str(), a.write.c_str());
  return addition.useful ? kExitOk : kExitDiffers;
}

int run(const Arguments& a) {
  DatasetReading reading = read_dataset(a.dataset, a.model, a.firmware);
  for (const ModelProblem& p : reading.problems) std::fprintf(stderr, "omnihil add: %s\n", p.text().c_str());
  if (!reading.dataset) return kExitBadInput;
  const EffectUse use = use_of(a, *reading.nominal);
  if (use.entry == nullptr) return kExitBadInput;
  const std::string name = effect_name(use);
  for (const EffectUse& has : reading.nominal->effects) {
    if (effect_name(has) != name) continue;
    std::fprintf(stderr, "omnihil add: the model has %s already\n", name.c_str());
    return kExitBadInput;
  }
  const FirmwareMeter meter(*reading.dataset);
  StopSignals stop;
  AddOptions options;
  options.seed = a.seed;
  options.jobs = a.jobs;
  Addition addition;
  {
    ProgressLine line;
    options.progress = [&](const Progress& p) {
      line.show(p.doing, p.share);
      return !StopSignals::requested();
    };
    addition = add_effect(*reading.dataset, *reading.nominal, use, options);
  }
  say_firmware_cost("add", meter);
  if (StopSignals::requested()) return kExitInterrupted;
  if (!addition.applies || addition.after.errors.empty()) {
    std::fprintf(stderr, "omnihil add: %s: %s\n", name.c_str(), addition.why.c_str());
    return kExitBadInput;
  }
  return report(a, *reading.dataset, addition, name);
}

}  // namespace

void add_verb_add(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("add", "add one effect to a model, and see what it changes");
  verb.add_option("DATASET", a->dataset, "folder of a measurement, or its dataset.toml").required();
  verb.add_option("EFFECT", a->effect,
                  "id of an effect, or a formula: \"torque_Nm += -a*omega_rotor_rad_s; a = 2e-6\"")
      .required();
  verb.add_option("--model", a->model, "model to start from, in place of the dataset's own");
  add_dataset_firmware_options(verb, a->firmware);
  verb.add_option("--write", a->write, "the model with it; a file that is there is kept as FILE.1");
  verb.add_flag("--force", a->force, "write it even when it is not useful");
  verb.add_option("--seed", a->seed, "of the simulated null and of the bootstrap").capture_default_str();
  verb.add_option("--jobs", a->jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.footer(
      "Exit code 1: it earns no place in the model, for the reason that is printed; nothing was written (but "
      "with\n"
      "--force). To undo an addition, take FILE.1.");
  verb.callback([a, &result] { result.exit_code = guarded("add", [&] { return run(*a); }); });
}

}  // namespace omnihil
