#include "tools/options/field_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <sstream>

#include "hil/loop/effect_overrides.h"
#include "hil/loop/model_store.h"
#include "hil/recording/snapshot_file.h"
#include "hil/text/program_files.h"

namespace omnihil {
namespace {

// "1,2.5,-3": exactly N numbers.
template <std::size_t N>
bool read_numbers(const std::string& text, std::array<double, N>& values) {
  std::istringstream in(text);
  for (std::size_t i = 0; i < N; ++i) {
    char comma = 0;
    if (i > 0 && !(in >> comma && comma == ',')) return false;
    if (!(in >> values[i])) return false;
  }
  return in.peek() == std::istringstream::traits_type::eof();
}

void read_model(const std::string& name, const std::vector<std::string>& effects, std::vector<int> keys,
                SessionSetup& setup, std::vector<std::string>& problems) {
  const StoredModel stored = load_robot_model(name, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) problems.push_back(problem.text());
  OtherModel other{std::move(keys), stored.bundle};
  if (!stored.problems.empty()) return;
  add_effects(other.model, effects, problems);
  setup.others.push_back(std::move(other));
}

void read_models(const FieldWords& words, const std::vector<std::string>& effects, SessionSetup& setup,
                 std::vector<std::string>& problems) {
  for (const std::string& text : words.robot_of) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      problems.push_back(
          fmt::format("--robot-of: found \"{}\", allowed: IDS=MODEL such as 3,4=ulaval_2024", text));
      continue;
    }
    std::vector<int> ids = parse_robot_list(std::string_view(text).substr(0, equals), problems);
    for (const int id : ids)
      if (!std::ranges::binary_search(setup.robot_ids, id))
        problems.push_back(fmt::format("--robot-of: robot {} is not on the floor", id));
    read_model(text.substr(equals + 1), effects, std::move(ids), setup, problems);
  }
  if (words.opponents_robot.empty()) return;
  if (setup.opponent_ids.empty()) problems.push_back("--opponents-robot: needs --opponents");
  std::vector<int> keys = setup.opponent_ids;
  for (int& key : keys) key += kOpponentKey;
  if (!keys.empty()) read_model(words.opponents_robot, effects, std::move(keys), setup, problems);
}

void read_carpet(const FieldWords& words, SessionSetup& setup, std::vector<std::string>& problems) {
  Carpet& carpet = setup.field.carpet;
  carpet.nap_rad = words.nap_deg * std::numbers::pi / 180.0;
  for (const std::string& text : words.patches) {
    std::array<double, 6> v{};
    if (read_numbers(text, v))
      carpet.patches.push_back({v[0], v[1], v[2], v[3], v[4], v[5]});
    else
      problems.push_back(fmt::format(
          "--carpet-patch: found \"{}\", allowed: X1,X2,Y1,Y2 in m and two ratios, such as 0,1,-1,1,0.5,2",
          text));
  }
  for (const std::string& problem : carpet_problems(carpet)) problems.push_back(problem);
}

}  // namespace

void add_field_options(Verb& verb, FieldWords& w) {
  verb.add_option(
          "--field", w.size,
          "boards and goals of this field, and vision's geometry (default: an open floor; vision tells of "
          "division-b)")
      .one_of({"division-a", "division-b", "seed-paper"});
  verb.add_option(
      "--ball", w.ball,
      "X,Y in m where a ball lies at the start (default: none until the league's control puts one)");
  verb.add_option("--robot-of", w.robot_of,
                  "IDS=MODEL: robots of the first team that are of another model, such as 3,4=ulaval_2024; "
                  "several allowed");
  verb.add_option("--opponents", w.opponents, "ids of the other team's robots: 0-5");
  verb.add_option("--opponents-robot", w.opponents_robot, "their model (default: as --robot)");
  verb.add_option(
          "--spread", w.spread,
          "each robot's numbers drawn about the model's, in its tolerances: 1 as they are said; from --seed")
      .range(0.0, 10.0);
  verb.add_option(
      "--from", w.from,
      "begin as this snapshot was (replay --snapshot): robots, motors, ball; radio and firmware start "
      "anew");
  verb.add_option("--carpet-sliding", w.floor.carpet.sliding_friction, "friction of a ball that slides")
      .range(0.0, 2.0)
      .capture_default_str();
  verb.add_option("--carpet-rolling", w.floor.carpet.rolling_resistance, "resistance of a ball that rolls")
      .range(0.0, 1.0)
      .capture_default_str();
  verb.add_option("--carpet-restitution", w.floor.carpet.restitution, "of a ball that lands")
      .range(0.0, 1.0)
      .capture_default_str();
  verb.add_option("--carpet-nap", w.floor.carpet.nap_ratio,
                  "the pile's pull on a rolling ball, of its rolling resistance")
      .range(0.0, 0.95)
      .capture_default_str();
  verb.add_option("--carpet-nap-deg", w.nap_deg, "where the pile points, from the field's x towards y")
      .range(-360.0, 360.0)
      .capture_default_str();
  verb.add_option(
      "--carpet-patch", w.patches,
      "X1,X2,Y1,Y2,SLIDING,ROLLING: a rectangle (m) whose friction is that many times the carpet's; "
      "several allowed");
  verb.add_option("--ball-lift", w.floor.ball_lift_coefficient, "Magnus lift of a spinning ball in the air")
      .range(0.0, 2.0)
      .capture_default_str();
  verb.add_flag("--ghosts", w.ghosts, "robots pass through each other and have no kicker, dribbler and beam");
}

void understand_field(const FieldWords& words, const std::vector<std::string>& effects, SessionSetup& setup,
                      std::vector<std::string>& problems) {
  setup.spread = words.spread;
  setup.field = words.floor;
  setup.field.contacts = !words.ghosts;
  if (!words.size.empty()) setup.field.size = find_field(words.size);
  if (!words.opponents.empty()) setup.opponent_ids = parse_robot_list(words.opponents, problems);
  read_models(words, effects, setup, problems);
  read_carpet(words, setup, problems);
  if (words.ghosts && (!words.size.empty() || !words.ball.empty()))
    problems.push_back("--ghosts: touches nothing, neither boards (--field) nor a ball (--ball)");
  if (!words.from.empty()) {
    const Snapshot snapshot = load_snapshot(words.from, problems);
    setup.from = snapshot.world;
    if (!words.ball.empty()) problems.push_back("--ball: --from says where the ball is");
  }
  if (words.ball.empty()) return;
  std::array<double, 2> at{};
  if (read_numbers(words.ball, at))
    setup.field.ball_m = at;
  else
    problems.push_back("--ball: found \"" + words.ball + "\", allowed: X,Y in m such as 0.5,0");
}

}  // namespace omnihil
