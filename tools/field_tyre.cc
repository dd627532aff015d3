// `omnihil field tyre`: the tyre's curve of a recorded robot, by the seed paper's way and by a forward fit.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/field_view/tyre_picture.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "hil/text/json_text.h"
#include "identify/tyre/tyre_identification.h"
#include "tools/exit_codes.h"
#include "tools/field_verbs.h"
#include "tools/guarded.h"

namespace omnihil {
namespace {

struct TyreArguments {
  std::string dataset, model, picture, json;
  int jobs = 1;
};

constexpr const char* kOutcome[] = {"curve", "grip alone", "no peak", "nothing"};

std::string text_of(const TyreIdentification& t) {
  std::string text = fmt::format(
      "{} points of force over slip, force by {}; wheels roll at R = {:.3f} mm +- {:.3f} mm\n{}\n",
      t.points.all.size(), t.points.measured_current ? "the measured currents" : "eq. (7)",
      1e3 * t.points.radius_m, 1e3 * t.points.radius_sigma_m, t.sentence);
  text += fmt::format("by the points alone: grip {:.3g} at slip {:.3g}, {:.3g} from {:.3g} on\n",
                      t.by_points.curve.extremum_value, t.by_points.curve.extremum_slip,
                      t.by_points.curve.asymptote_value, t.by_points.curve.asymptote_slip);
  if (t.outcome != TyreOutcome::kCurve) return text;
  text += fmt::format(
      "# goes into the robot's model; the forward fit leaves {:.2f} times the noise\n"
      "[tyre.longitudinal]\n",
      t.pooled_sigmas);
  for (const TyreNumber& n : t.numbers) {
    const std::string key = n.path.substr(n.path.rfind('.') + 1);
    if (n.determined)
      text += fmt::format("{:<16} = {{ value = {:.5g}, tolerance = {:.2g} }}   # 90 %: {:.4g} .. {:.4g}\n",
                          key, n.value, n.sigma / n.value, n.from, n.to);
    else
      text += fmt::format("# {}: not determined by these data\n", key);
  }
  return text;
}

std::string json_of_tyre(const TyreIdentification& t) {
  nlohmann::ordered_json json;
  json["format"] = "omnihil-tyre/1";
  json["outcome"] = kOutcome[static_cast<std::size_t>(t.outcome)];
  json["sentence"] = t.sentence;
  json["points"] = t.points.all.size();
  json["radius_m"] = t.points.radius_m;
  json["pooled_sigmas"] = t.pooled_sigmas;
  json["sticking"] = {{"grip", t.sticking.most_ratio}, {"slip_bound_95", t.sticking.slip_bound_95}};
  if (t.outcome == TyreOutcome::kCurve)
    for (const TyreNumber& n : t.numbers)
      json["numbers"][n.path] = {{"value", n.value}, {"sigma", n.sigma}, {"determined", n.determined}};
  for (const TyreBin& b : tyre_bins(t.points.all))
    json["diagram"].push_back({{"slip", b.slip}, {"ratio", b.ratio}, {"ratio_error", b.ratio_error}});
  return json_text(json, 1) + "\n";
}

int run_tyre(const TyreArguments& a) {
  const DatasetReading reading = read_dataset(a.dataset, a.model);
  for (const ModelProblem& p : reading.problems) fmt::print(stderr, "omnihil field tyre: {}\n", p.text());
  if (!reading.dataset) return kExitBadInput;
  StopSignals stop;
  FitOptions options;
  options.jobs = a.jobs;
  options.stop = [] { return StopSignals::requested(); };
  const TyreIdentification found = identify_tyre(*reading.dataset, *reading.nominal, options);
  for (const std::string& fault : found.faults) fmt::print(stderr, "omnihil field tyre: {}\n", fault);
  if (found.outcome == TyreOutcome::kNothing) return kExitBadInput;
  if (found.fit.stopped) return kExitInterrupted;
  fmt::print("{}", text_of(found));
  if (!a.picture.empty()) replace_file(a.picture, tyre_picture(found, reading.dataset->title));
  if (!a.json.empty()) replace_file(a.json, json_of_tyre(found));
  return kExitOk;
}

}  // namespace

void add_field_tyre(Verb& field, VerbResult& result) {
  auto a = std::make_shared<TyreArguments>();
  Verb verb =
      field.add_subcommand("tyre", "the tyre's curve of a recorded robot, with what the record cannot tell");
  verb.add_option("DATASET", a->dataset,
                  "folder of a measurement of rig robot: straight pushes at several levels")
      .required();
  verb.add_option("--model", a->model, "model to start from, in place of the dataset's own");
  verb.add_option("--picture", a->picture, "force over slip to this file, as SVG");
  verb.add_option("--json", a->json, "result to this file (omnihil-tyre/1)");
  verb.add_option("--jobs", a->jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.callback([a, &result] { result.exit_code = guarded("field tyre", [&] { return run_tyre(*a); }); });
}

}  // namespace omnihil
