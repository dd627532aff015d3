// `omnihil field`: the systems of a match one by one (seed), and a team's own kick tables made into numbers (kick, chip).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "hil/field_view/seed_pictures.h"
#include "hil/field_view/seed_tour.h"
#include "hil/loop/model_store.h"
#include "hil/text/csv_table.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "sim/field/chip_kick.h"
#include "sim/field/kicker.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/field_verbs.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string robot = "omni_default";
  std::string table, pictures;
  double pulse_unit_ms = 1.0;
  std::uint64_t seed = 1;
};

// Columns of a table, each of its rows whole.
std::vector<std::vector<double>> rows_of(const std::string& file, const std::vector<std::string>& wanted) {
  std::vector<ModelProblem> problems;
  const CsvTable table = read_csv(file, wanted, problems);
  std::string text = lines_of(problems);
  for (std::size_t i = 0; text.empty() && i < wanted.size(); ++i)
    if (!table.columns[i]) text += fmt::format("{}: needs a column {}", file, wanted[i]);
  if (!text.empty()) throw std::invalid_argument(text);
  std::vector<std::vector<double>> rows(table.line.size(), std::vector<double>(wanted.size()));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < wanted.size(); ++c) rows[r][c] = (*table.columns[c])[r];
  return rows;
}

int run_seed(const Arguments& a) {
  const StoredModel stored = load_robot_model(a.robot, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) fmt::print(stderr, "{}\n", problem.text());
  if (!stored.model || !stored.model->robot) return kExitBadInput;
  if (!a.pictures.empty()) {
    std::filesystem::create_directories(a.pictures);
    for (const SeedPicture& p : seed_pictures(*stored.model->robot))
      replace_file(std::filesystem::path(a.pictures) / (p.name + ".svg"), p.svg);
    return kExitOk;
  }
  for (const TourRow& row : seed_tour(*stored.model->robot)) fmt::print("{}", row.text());
  return kExitOk;
}

int run_kick(const Arguments& a) {
  std::vector<KickPoint> points;
  for (const auto& row : rows_of(a.table, {"k", "speed_m_s"})) points.push_back({row[0], row[1]});
  const KickFit fit = fit_kick(points, a.pulse_unit_ms * 1e-3);
  fmt::print("# {} points, {:.3f} m/s rms about the cubic; goes into a robot's model\n[kicker]\n",
             points.size(), fit.rms_m_s);
  fmt::print("pulse_unit_s = {:g}\n", fit.law.pulse_unit_s);
  for (std::size_t i = 0; i < 4; ++i) fmt::print("c{}_m_s = {:.9g}\n", i, fit.law.c[i]);
  fmt::print("k_least = {:g}\nk_most = {:g}\n", fit.law.k_least, fit.law.k_most);
  return kExitOk;
}

int run_chip(const Arguments& a) {
  std::vector<ChipPoint> points;
  for (const auto& row : rows_of(a.table, {"k", "y_m", "speed_m_s", "angle_deg"}))
    points.push_back({row[0], row[1], row[2], row[3] * std::numbers::pi / 180.0});
  // Every fifth point is held out, so that the figure is of points that the training has not seen.
  std::vector<ChipPoint> train, held;
  for (std::size_t i = 0; i < points.size(); ++i) (i % 5 == 4 ? held : train).push_back(points[i]);
  const ChipTraining training = train_chip(train, {.seed = a.seed});
  double speed2 = 0.0, angle2 = 0.0;
  for (const ChipPoint& p : held) {
    const ChipKick found = chip_kick(training.network, p.k, p.y_m);
    speed2 += (found.speed_m_s - p.speed_m_s) * (found.speed_m_s - p.speed_m_s);
    angle2 += (found.angle_rad - p.angle_rad) * (found.angle_rad - p.angle_rad);
  }
  const double n = std::max<double>(1.0, static_cast<double>(held.size()));
  const double degree = 180.0 / std::numbers::pi;
  fmt::print(
      "{} points: trained on {}, {:.3f} m/s and {:.2f} deg rms; {} held out, {:.3f} m/s and {:.2f} deg rms\n",
      points.size(), train.size(), training.speed_rms_m_s, training.angle_rms_rad * degree, held.size(),
      std::sqrt(speed2 / n), std::sqrt(angle2 / n) * degree);
  fmt::print("{:>8} {:>8} {:>10} {:>10} {:>8} {:>8}\n", "k", "y_m", "speed_m_s", "angle_deg", "high_m",
             "far_m");
  const ChipNetwork& net = training.network;
  for (int i = 0; i <= 5; ++i) {
    const double k = net.in_least[0] + 0.2 * i * (net.in_most[0] - net.in_least[0]);
    const ChipKick kick = chip_kick(net, k, 0.0);
    fmt::print("{:>8.2f} {:>8.3f} {:>10.2f} {:>10.1f} {:>8.2f} {:>8.2f}\n", k, 0.0, kick.speed_m_s,
               kick.angle_rad * degree, chip_apex_m(kick), chip_distance_m(kick, 0.0));
  }
  fmt::print("# goes into the robot's model\n[kicker]\nchip_network = \"{}\"\n", chip_text(net));
  return kExitOk;
}

}  // namespace

void add_verb_field(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("field", "ball, kicker, dribbler and the rest of a match, one by one");
  verb.require_subcommand(1);
  Verb seed = verb.add_subcommand("seed", "the seed paper's systems, each with the figure it gives here");
  seed.add_option("--robot", a->robot, "robot model: a name or a .toml file").capture_default_str();
  seed.add_option("--pictures", a->pictures, "folder: a picture of each system, as SVG, instead");
  seed.callback([a, &result] { result.exit_code = guarded("field seed", [&] { return run_seed(*a); }); });
  Verb kick =
      verb.add_subcommand("kick", "a cubic through a team's own table of kicks, for its robot's model");
  kick.add_option("TABLE", a->table, "CSV with the columns k, speed_m_s").required();
  kick.add_option("--pulse-unit", a->pulse_unit_ms, "ms of pulse for k = 1")
      .range(1e-3, 1000.0)
      .capture_default_str();
  kick.callback([a, &result] { result.exit_code = guarded("field kick", [&] { return run_kick(*a); }); });
  add_field_tyre(verb, result);
  add_field_wheel(verb, result);
  add_field_pass(verb, result);
  add_field_rectangle(verb, result);
  Verb chip = verb.add_subcommand("chip", "the seed paper's network trained on a team's own table of chips");
  chip.add_option("TABLE", a->table, "CSV with the columns k, y_m, speed_m_s, angle_deg").required();
  chip.add_option("--seed", a->seed, "of the first weights").capture_default_str();
  chip.callback([a, &result] { result.exit_code = guarded("field chip", [&] { return run_chip(*a); }); });
}

}  // namespace omnihil
