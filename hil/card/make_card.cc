#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "hil/card/card_numbers.h"
#include "hil/card/model_card.h"
#include "hil/card/provenance.h"
#include "hil/dataset/dataset_fingerprint.h"
#include "hil/dataset/dataset_reader.h"
#include "identify/estimate/heard_commands.h"
#include "identify/select/add_effect.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

double pooled_or_none(const Comparison& c, Split split) {
  const bool any = std::any_of(c.errors.begin(), c.errors.end(),
                               [&](const SignalError& e) { return e.split == split && e.samples > 0; });
  return any ? c.pooled(split) : std::nan("");
}

fs::path folder_of(const std::string& dataset) {
  return fs::is_directory(dataset) ? fs::path(dataset) : fs::path(dataset).parent_path();
}

std::string shown_name(const std::string& dataset) {
  const fs::path folder =
      fs::weakly_canonical(folder_of(dataset).empty() ? fs::path(".") : folder_of(dataset));
  return folder.filename().string();
}

bool fitted_to(const ModelCard& card, const std::string& fingerprint) {
  const auto same = [&](const CardNumber& n) { return n.data == fingerprint; };
  if (std::any_of(card.numbers.begin(), card.numbers.end(), same)) return true;
  return std::any_of(card.effects.begin(), card.effects.end(), [&](const CardEffect& e) {
    return std::any_of(e.numbers.begin(), e.numbers.end(), same);
  });
}

// Throws std::invalid_argument when the user's axes are not among those of these data.
void check_axes(const std::array<std::string, 2>& axes, const Predictor& predictor, const Candidate& model) {
  if (axes[0].empty()) return;
  std::vector<std::string> names;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const RegimeTrack& track : predictor.regimes(model, r)) {
      if (std::find(names.begin(), names.end(), track.name) == names.end()) names.push_back(track.name);
    }
  }
  for (const std::string& axis : axes) {
    if (std::find(names.begin(), names.end(), axis) == names.end())
      throw std::invalid_argument(
          fmt::format("--axes {}: these data have no such axis; allowed: {}", axis, fmt::join(names, ", ")));
  }
}

CardData data_of(const CardRequest& request, const std::string& path, const DatasetReading& reading,
                 const Dataset& heard, const ModelCard& card) {
  CardData out;
  const Dataset& dataset = *reading.dataset;
  out.name = shown_name(path);
  out.title = dataset.title;
  out.fingerprint = dataset_fingerprint(path, dataset);
  out.fitted_to = fitted_to(card, out.fingerprint);
  const fs::path folder = folder_of(path);
  Provenance stated = provenance_of(folder);
  out.licence = std::move(stated.licence);
  out.source = std::move(stated.source);
  out.readme = std::move(stated.readme);
  for (const Run& run : dataset.runs) {
    CardRun& shown = out.runs.emplace_back();
    shown.file = hash_file((folder / run.file).string());
    shown.file.name = run.file;
    shown.use = run.split;
    shown.duration_s = run.duration_s();
  }
  const auto predictor = make_predictor(heard, *reading.nominal, {});
  std::vector<Prediction> predictions;
  for (int r = 0; r < predictor->run_count(); ++r)
    predictions.push_back(predictor->predict(*reading.nominal, r));
  out.comparison = compare(*predictor, *reading.nominal, predictions, false);
  out.findings = check_data(dataset, *reading.nominal);
  out.notes = heard.notes;
  const auto axes = request.axes[0].empty() ? validity_axes(*predictor, *reading.nominal) : request.axes;
  check_axes(request.axes, *predictor, *reading.nominal);
  std::vector<std::string> signals;
  for (const SignalError& e : out.comparison.errors) {
    if (std::find(signals.begin(), signals.end(), e.signal) == signals.end()) signals.push_back(e.signal);
  }
  for (const std::string& signal : signals) {
    ValidityMap map = validity_map(*predictor, *reading.nominal, predictions, signal, axes);
    if (!map.cells.empty()) out.maps.push_back(std::move(map));
  }
  return out;
}

EffectEvidence evidence_of(const CardRequest& request, const CardData& data, const Dataset& heard,
                           const Candidate& model, const EffectUse& use, bool& interrupted) {
  EffectEvidence out;
  out.dataset = data.name;
  const std::string name = effect_name(use);
  AddOptions options;
  options.seed = request.seed;
  options.jobs = request.jobs;
  if (request.progress) {
    options.progress = [&](const Progress& p) {
      Progress named = p;
      named.doing = name + " on " + data.name + ": " + p.doing;
      interrupted = interrupted || !request.progress(named);
      return !interrupted;
    };
  }
  const Addition addition = add_effect(heard, without_effect(model, name), use, options);
  out.why = addition.why;
  out.tested = addition.applies && !addition.after.errors.empty();
  if (!out.tested) return out;
  out.earns = addition.useful;
  out.holdout_without = pooled_or_none(addition.before, kValidation);
  out.holdout_with = pooled_or_none(addition.after, kValidation);
  out.extrapolation_without = pooled_or_none(addition.before, kExtrapolation);
  out.extrapolation_with = pooled_or_none(addition.after, kExtrapolation);
  return out;
}

// The model's file and that of its motor: what the card is true of.
std::vector<HashedFile> files_of(const std::string& model, const ModelFile& file) {
  std::vector<HashedFile> out = {hash_file(model)};
  if (!file.motor_file.empty()) {
    out.push_back(hash_file((fs::path(model).parent_path() / file.motor_file).string()));
    out.back().name = file.motor_file;
  }
  return out;
}

}  // namespace

CardOutcome make_card(const CardRequest& request) {
  CardOutcome out;
  CandidateReading model = read_candidate(request.model);
  out.problems = std::move(model.problems);
  std::vector<DatasetReading> readings;
  for (const std::string& dataset : request.datasets) {
    if (!out.problems.empty()) break;  // a faulty model makes every dataset faulty
    readings.push_back(read_dataset(dataset, request.model));
    for (ModelProblem& p : readings.back().problems) out.problems.push_back(std::move(p));
  }
  if (!out.problems.empty() || !model.candidate) return out;
  ModelCard card;
  card.name = fs::path(request.model).stem().string();
  card.title = model.candidate->file.name;
  card.rig = model.candidate->file.linear ? "linear axis" : model.candidate->file.rig;
  card.source = model.candidate->file.source;
  card.program = request.program;
  card.date = request.date;
  card.files = files_of(request.model, model.candidate->file);
  card.numbers = card_numbers(*model.candidate);
  card.effects = card_effects(*model.candidate);
  std::vector<Dataset> heard;
  for (std::size_t d = 0; d < readings.size(); ++d) {
    heard.push_back(
        heard_commands(*readings[d].dataset, *readings[d].nominal, {.jobs = request.jobs}).dataset);
    card.data.push_back(data_of(request, request.datasets[d], readings[d], heard[d], card));
  }
  for (std::size_t e = 0; request.evidence && e < card.effects.size(); ++e) {
    for (std::size_t d = 0; d < readings.size(); ++d) {
      const EffectUse& use = readings[d].nominal->effects[e];
      card.effects[e].evidence.push_back(
          evidence_of(request, card.data[d], heard[d], *readings[d].nominal, use, out.interrupted));
      if (out.interrupted) return out;
    }
  }
  out.card = std::move(card);
  return out;
}

}  // namespace omnihil
