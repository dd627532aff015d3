// A model's passport: its numbers with origin and interval, its effects with their evidence, its error on data that it
// was not fitted to, where it was tested, and which files all that is true of.
//
//   CardOutcome made = make_card({.model = "bench/model.toml", .datasets = {"bench"}});
//   for (const ModelProblem& p : made.problems) std::cerr << p.text() << "\n";
//   if (made.card) write_new_file("model.card.html", card_html(*made.card));
//
// The errors are those of the model exactly as its file has it: nothing is fitted for them. The evidence of an effect
// is the test of `omnihil add`: the model without it and with it, the base parameters refitted in both, held against
// runs that neither was fitted to. Cannot: vouch for regimes without data; say more of an effect than these data can.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hil/text/hashed_file.h"
#include "identify/checks/check_data.h"
#include "identify/compare/comparison.h"
#include "identify/compare/validity_map.h"
#include "identify/record/progress.h"
#include "sim/model/model_file.h"

namespace omnihil {

// One number of the model. The interval is 95 % in the number's unit: 1.96 sigma of the fit, or of the belief.
struct CardNumber {
  std::string path;            // "motor.resistance_ohm"
  std::string unit;            // "ohm"; "1": a ratio; empty: a word
  std::vector<double> values;  // one, or one a wheel; none: a word
  std::string text;            // the word
  std::string what;            // one line
  std::string kind;            // "fitted", "believed", "exact" (no tolerance is given), "default"
  std::string
      source;  // "data sheet p. 7"; of a fitted number that of its belief; empty: the file does not say
  std::string data, date;  // of a fit: fingerprint of what it was fitted to, and when
  std::optional<std::pair<double, double>> interval;  // none: none is known
};

// What one dataset says of one effect: without it -> with it, both refitted on its fit runs. Errors are pooled over the
// signals, in multiples of the sensors' noise; NaN: no such run.
struct EffectEvidence {
  std::string dataset;
  bool tested = false;  // false: `why` says why not
  bool earns = false;   // passes the acceptance test of an addition
  std::string why;
  double holdout_without = 0.0, holdout_with = 0.0;
  double extrapolation_without = 0.0, extrapolation_with = 0.0;
};

struct CardEffect {
  std::string name;   // id, or "expression.NAME"
  std::string title;  // of the catalogue
  std::vector<CardNumber> numbers;
  std::vector<EffectEvidence> evidence;  // one a dataset
};

struct CardRun {
  HashedFile file;
  Split use = Split::kTraining;
  double duration_s = 0.0;
};

struct CardData {
  std::string name;                     // last part of the path
  std::string title;                    // of its dataset.toml
  std::string fingerprint;              // dataset_fingerprint.h
  bool fitted_to = false;               // a number of the model says that it was fitted to these data
  std::string licence, source, readme;  // from README.md and LICENSE of its folder; empty: not stated
  std::vector<CardRun> runs;
  Comparison comparison;  // without regimes
  std::vector<DataFinding> findings;
  std::vector<std::string> notes;
  std::vector<ValidityMap> maps;  // one a signal
};

struct ModelCard {
  std::string name;   // of the model file, without .toml
  std::string title;  // what it calls itself
  std::string rig, source, program, date;
  std::vector<HashedFile> files;  // the model's own, then its motor's
  std::vector<CardNumber> numbers;
  std::vector<CardEffect> effects;
  std::vector<CardData> data;
};

struct CardRequest {
  std::string model;  // a file
  std::vector<std::string> datasets;
  std::array<std::string, 2> axes{};  // of the maps; empty: validity_axes()
  bool evidence = true;               // false: the effects are listed, not tested
  std::uint64_t seed = 1;
  int jobs = 1;
  std::string program;  // name and version
  std::string date;
  std::function<bool(const Progress&)> progress{};  // false: give up
};

struct CardOutcome {
  std::optional<ModelCard> card;
  std::vector<ModelProblem> problems;
  bool interrupted = false;
};

// Throws std::invalid_argument where `axes` are none of these data's.
CardOutcome make_card(const CardRequest& request);

std::string card_html(const ModelCard& card);  // one file, no script, nothing from outside
std::string card_json(const ModelCard& card);  // "omnihil-card/1"

// "On runs that it was not fitted to, velocity is off by 0.5 rad/s (2.1 % of its spread)": the worst signal of the
// strictest use there is.
std::string card_sentence(const ModelCard& card);

}  // namespace omnihil
