// `omnihil field rectangle`: a recorded drive and the model's, from the same duties (the seed paper's Fig. 9).
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <string>

#include "hil/dataset/dataset_reader.h"
#include "hil/field_play/path_test.h"
#include "hil/text/dataset_files.h"
#include "identify/record/rig.h"
#include "sim/model/params.h"
#include "tools/exit_codes.h"
#include "tools/field_verbs.h"
#include "tools/guarded.h"

namespace omnihil {
namespace {

struct RectangleArguments {
  std::string dataset, model, run, picture;
};

int run_rectangle(const RectangleArguments& a) {
  const DatasetReading reading = read_dataset(a.dataset, a.model);
  for (const ModelProblem& p : reading.problems)
    fmt::print(stderr, "omnihil field rectangle: {}\n", p.text());
  if (!reading.dataset) return kExitBadInput;
  if (!reading.dataset->rig->whole_robot) {
    fmt::print(stderr, "omnihil field rectangle: needs a dataset of rig \"robot\"\n");
    return kExitBadInput;
  }
  const auto& runs = reading.dataset->runs;
  const auto found =
      std::ranges::find_if(runs, [&](const Run& r) { return a.run.empty() || r.file == a.run; });
  if (found == runs.end()) {
    std::string names;
    for (const Run& r : runs) names += (names.empty() ? "" : ", ") + r.file;
    fmt::print(stderr, "omnihil field rectangle: --run {}: allowed: {}\n", a.run, names);
    return kExitBadInput;
  }
  std::vector<std::string> faults;
  RobotModel model = reading.nominal->file.robot ? *reading.nominal->file.robot
                                                 : robot_model_of(reading.nominal->file.parameters);
  if (!model.effects && !reading.nominal->effects.empty())
    model.effects = std::make_shared<const std::vector<EffectUse>>(reading.nominal->effects);
  const PathTest t = path_test(*found, model, faults);
  for (const std::string& fault : faults) fmt::print(stderr, "omnihil field rectangle: {}\n", fault);
  if (!faults.empty()) return kExitBadInput;
  constexpr double kDegree = 180.0 / std::numbers::pi;
  fmt::print("{}: {} frames, {:.2f} m of way in {:.1f} s\n", found->file, t.real.size(), t.way_m,
             t.real.back().time_s - t.real.front().time_s);
  fmt::print("path   {:.4f} m rms, {:.4f} m at most, {:.4f} m at the end ({:.2f} % of the way)\n", t.rms_m,
             t.most_m, t.end_m, 100.0 * t.end_m / std::max(1e-9, t.way_m));
  fmt::print("yaw    {:.2f} deg rms, {:+.2f} deg at the end\n", kDegree * t.rms_rad, kDegree * t.end_rad);
  for (std::size_t i = 0; i < t.legs.size(); ++i)
    fmt::print("leg {:<2} {:6.2f} to {:6.2f} s, {:.2f} m: {:.4f} m rms\n", i + 1, t.legs[i].from_s,
               t.legs[i].to_s, t.legs[i].length_m, t.legs[i].rms_m);
  if (!a.picture.empty()) replace_file(a.picture, path_picture(t, reading.dataset->title));
  return kExitOk;
}

}  // namespace

void add_field_rectangle(Verb& field, VerbResult& result) {
  auto a = std::make_shared<RectangleArguments>();
  Verb verb = field.add_subcommand("rectangle", "a recorded drive and the model's, from the same duties");
  verb.add_option("DATASET", a->dataset, "folder of a measurement of rig robot, with duties and camera")
      .required();
  verb.add_option("--model", a->model, "model, in place of the dataset's own");
  verb.add_option("--run", a->run, "which of its runs, by file (default: the first)");
  verb.add_option("--picture", a->picture, "both paths to this file, as SVG");
  verb.callback(
      [a, &result] { result.exit_code = guarded("field rectangle", [&] { return run_rectangle(*a); }); });
}

}  // namespace omnihil
