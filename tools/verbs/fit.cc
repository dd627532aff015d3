// omnihil fit DATASET: the numbers of a model that explain a measurement best, and how well it tells them.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "identify/estimate/heard_commands.h"
#include "identify/select/angle_resolution.h"
#include "sim/law/effect_registry.h"
#include "sim/model/params.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/fit_text.h"
#include "tools/fitted_model.h"
#include "tools/guarded.h"
#include "tools/options/dataset_options.h"
#include "tools/options/firmware_cost.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string dataset, model, write, json;
  OtherFirmware firmware;
  std::vector<std::string> free, freeze, with;
  FitOptions options;
};

// Adds the effects asked for, all at their neutral value.
Candidate with_effects(Candidate c, const std::vector<std::string>& ids, std::vector<std::string>& faults) {
  for (const std::string& id : ids) {
    const EffectEntry* entry = find_effect(id);
    if (entry == nullptr) {
      const std::string_view near = nearest_effect(id);
      faults.push_back(fmt::format(
          "--with {}: there is no such effect; {}", id,
          near.empty() ? "`omnihil effects` lists them" : fmt::format("did you mean \"{}\"?", near)));
    } else if (is_formula(*entry->info)) {
      faults.push_back(
          "--with expression: a formula is written into the model file, [effects.expression.NAME]");
    } else if (std::none_of(c.effects.begin(), c.effects.end(),
                            [&](const auto& u) { return effect_name(u) == id; })) {
      c = with_effect(c, *entry);
    }
  }
  return c;
}

// Unknowns by path: only those of --free, none of --freeze. A word may be an effect's or a section's name.
std::vector<Unknown> chosen(const Candidate& c, const Arguments& a, std::vector<std::string>& faults) {
  const std::vector<Unknown> all = unknowns_of(c);
  std::vector<std::string_view> paths;
  for (const Unknown& u : all) paths.push_back(u.path);
  const auto meant = [](const std::string& word, const Unknown& u) {
    return u.path == word || u.path.starts_with(word + ".");
  };
  for (const auto* words : {&a.free, &a.freeze}) {
    for (const std::string& word : *words) {
      if (std::any_of(all.begin(), all.end(), [&](const Unknown& u) { return meant(word, u); })) continue;
      const std::string_view near = nearest_spelling(word, paths);
      const char* option = words == &a.free ? "--free" : "--freeze";
      faults.push_back(fmt::format("{} {}: no parameter of this model that could move; {}", option, word,
                                   near.empty() ? "a number with a tolerance, or one of an effect, can"
                                                : fmt::format("did you mean \"{}\"?", near)));
    }
  }
  std::vector<Unknown> out;
  for (const Unknown& u : all) {
    const auto named = [&](const std::vector<std::string>& words) {
      return std::any_of(words.begin(), words.end(), [&](const std::string& w) { return meant(w, u); });
    };
    if ((a.free.empty() || named(a.free)) && !named(a.freeze)) out.push_back(u);
  }
  return out;
}

int run(const Arguments& a) {
  DatasetReading reading = read_dataset(a.dataset, a.model, a.firmware);
  for (const ModelProblem& p : reading.problems) std::fprintf(stderr, "omnihil fit: %s\n", p.text().c_str());
  if (!reading.dataset) return kExitBadInput;
  std::vector<std::string> faults;
  const Candidate start = with_effects(*reading.nominal, a.with, faults);
  const std::vector<Unknown> unknowns = chosen(start, a, faults);
  const FirmwareMeter meter(*reading.dataset);
  const Dataset dataset =
      heard_commands(*reading.dataset, *reading.nominal, {.jobs = a.options.jobs}).dataset;
  for (std::size_t n = reading.dataset->notes.size(); n < dataset.notes.size(); ++n)
    std::fprintf(stderr, "omnihil fit: %s\n", dataset.notes[n].c_str());
  const auto predictor = make_predictor(dataset, *reading.nominal, {});
  for (const EffectUse& use : start.effects) {
    const std::string why = faults.empty() ? why_not(*use.entry, *predictor, dataset) : "";
    const bool asked = std::find(a.with.begin(), a.with.end(), effect_name(use)) != a.with.end();
    if (!why.empty() && asked) faults.push_back(fmt::format("--with {}: {}", effect_name(use), why));
  }
  for (const std::string& fault : faults) std::fprintf(stderr, "omnihil fit: %s\n", fault.c_str());
  if (!faults.empty()) return kExitBadInput;
  StopSignals stop;
  FitOptions options = a.options;
  options.profile = true;
  options.stop = [] { return StopSignals::requested(); };
  say_firmware_ahead("fit", meter, *predictor, start, unknowns.size());
  const auto began = std::chrono::steady_clock::now();
  FitReport report{.dataset = a.dataset, .model = a.model, .fit = {}, .before = {}, .after = {}};
  report.before = compare(*predictor, *reading.nominal);
  report.fit = fit(*predictor, start, unknowns, options);
  report.after = compare(*predictor, report.fit.model);
  report.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  say_firmware_cost("fit", meter);
  if (a.json == "-") {
    std::fputs(fit_json(report).c_str(), stdout);
  } else {
    std::fputs(fit_text(report).c_str(), stdout);
    if (!a.json.empty()) replace_file(a.json, fit_json(report));
  }
  if (report.fit.stopped) return kExitInterrupted;
  if (!report.after.diverged.empty()) return kExitDiverged;
  if (!a.write.empty())
    replace_file_keeping_old(a.write, fitted_model_text(report.fit, a.dataset, *reading.dataset));
  return kExitOk;
}

}  // namespace

void add_verb_fit(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("fit", "the numbers of a model that explain a measurement best");
  verb.add_option("DATASET", a->dataset, "folder of a measurement, or its dataset.toml").required();
  verb.add_option("--model", a->model, "model to start from, in place of the dataset's own");
  add_dataset_firmware_options(verb, a->firmware);
  verb.add_option("--with", a->with, "add this effect, starting without influence (several)")
      .type_name("EFFECT");
  verb.add_option("--free", a->free, "move only these: a path, an effect, a section (several)")
      .type_name("PATH");
  verb.add_option("--freeze", a->freeze, "leave these as they are (several)").type_name("PATH");
  verb.add_option("--write", a->write, "the fitted model; a file that is there is kept as FILE.1")
      .type_name("MODEL");
  verb.add_option("--json", a->json, "result as JSON (omnihil-fit/1); - : to stdout, in place of the text")
      .type_name("OUT");
  verb.add_flag(
      "--robust", a->options.robust,
      "large residuals pull linearly, not squared: a few runs that the model cannot explain count less");
  verb.add_option("--starts", a->options.starts,
                  "starts; all but the first are drawn from the beliefs of the model file")
      .range(1, 100)
      .capture_default_str();
  verb.add_option("--seed", a->options.seed, "of those starts").capture_default_str();
  verb.add_option("--jobs", a->options.jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.footer(
      "Numbers with a tolerance in the model file move, and those of its effects; bare base numbers are "
      "exact.\n"
      "Only runs of use \"fit\" are fitted; the table shows the error on the others as well.\n"
      "A model that was fitted before starts from its values; its priors are what was believed before the "
      "first fit.");
  verb.callback([a, &result] { result.exit_code = guarded("fit", [&] { return run(*a); }); });
}

}  // namespace omnihil
