#include "tools/options/field_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "hil/loop/effect_overrides.h"
#include "hil/loop/model_store.h"
#include "hil/recording/snapshot_file.h"
#include "hil/scenario/scenario.h"
#include "hil/text/program_files.h"

namespace omnihil {
namespace {

constexpr double kFarthest_m = 20.0;  // as in scenarios

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

// Of "IDS=VALUE", the robots' keys.
std::vector<int> keys_of(const char* option, std::string_view text, const char* allowed,
                         const SessionSetup& setup, std::string_view& value,
                         std::vector<std::string>& problems) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    problems.push_back(fmt::format("{}: found \"{}\", allowed: {}", option, text, allowed));
    return {};
  }
  value = text.substr(equals + 1);
  std::vector<std::string> wrong;
  std::vector<int> keys = parse_robot_keys(text.substr(0, equals), setup, wrong);
  for (const std::string& problem : wrong) problems.push_back(fmt::format("{}: {}", option, problem));
  if (!wrong.empty()) keys.clear();
  return keys;
}

// Robots of the other team that have no model of their own.
void read_opponents_model(const FieldWords& words, const std::vector<std::string>& effects,
                          SessionSetup& setup, std::vector<std::string>& problems) {
  if (setup.opponent_ids.empty()) problems.push_back("--opponents-robot: needs --opponents");
  std::vector<int> keys;
  for (const int id : setup.opponent_ids) {
    const int key = kOpponentKey + id;
    const bool named = std::ranges::any_of(
        setup.others, [key](const OtherModel& other) { return std::ranges::binary_search(other.keys, key); });
    if (!named) keys.push_back(key);
  }
  if (!keys.empty()) read_model(words.opponents_robot, effects, std::move(keys), setup, problems);
}

// The robot gets a model of its own: the one it has, with the effect.
void add_effect_of(int key, const std::string& effect, SessionSetup& setup,
                   std::vector<std::string>& problems) {
  OtherModel own{{key}, setup.model};
  for (OtherModel& other : setup.others) {
    if (!std::ranges::binary_search(other.keys, key)) continue;
    own.model = other.model;
    std::erase(other.keys, key);
  }
  std::erase_if(setup.others, [](const OtherModel& other) { return other.keys.empty(); });
  add_effects(own.model, {effect}, problems);
  setup.others.push_back(std::move(own));
}

void read_faults(const FieldWords& words, SessionSetup& setup, std::vector<std::string>& problems) {
  for (const std::string& text : words.fault) {
    // "opponents:" has a colon of its own
    const std::size_t from = text.starts_with("opponents:") ? 10 : 0;
    const std::size_t colon = text.find(':', from);
    std::vector<std::string> wrong;
    std::vector<int> keys;
    std::optional<ScenarioStep> step;
    if (colon == std::string::npos) {
      wrong.push_back(
          "allowed: IDS: at_s = S, do = \"WORD\" and its keys, such as 3: at_s = 1.0, for_s = 0.2, do = "
          "\"wheel_blocked\", wheels = [0]");
    } else {
      keys = parse_robot_keys(std::string_view(text).substr(0, colon), setup, wrong);
      step = read_fault(std::string_view(text).substr(colon + 1), wrong);
    }
    for (const std::string& problem : wrong)
      problems.push_back(fmt::format("--fault: \"{}\": {}", text, problem));
    if (!step) continue;
    TimedFault fault{.from_ns = std::llround(step->at_s * 1e9),
                     .silent = step->kind == StepKind::kRadioSilence,
                     .faults = faults_of(*step)};
    if (std::isfinite(step->until_s)) fault.until_ns = std::llround(step->until_s * 1e9);
    for (const int key : keys) {
      fault.key = key;
      setup.faults.push_back(fault);
    }
  }
}

void read_models(const FieldWords& words, const std::vector<std::string>& effects, SessionSetup& setup,
                 std::vector<std::string>& problems) {
  for (const std::string& text : words.robot_of) {
    std::string_view value;
    std::vector<int> keys =
        keys_of("--robot-of", text, "IDS=MODEL such as 3,4=ulaval_2024", setup, value, problems);
    if (!keys.empty()) read_model(std::string(value), effects, std::move(keys), setup, problems);
  }
  if (!words.opponents_robot.empty()) read_opponents_model(words, effects, setup, problems);
  for (const std::string& text : words.with_of) {
    std::string_view value;
    for (const int key :
         keys_of("--with-of", text, "IDS=EFFECT such as 3,4=battery_sag", setup, value, problems))
      add_effect_of(key, std::string(value), setup, problems);
  }
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
  verb.add_option(
      "--robot-of", w.robot_of,
      "IDS=MODEL: robots that are of another model, such as 3,4=ulaval_2024 or opponents:0=my.toml; "
      "several allowed");
  verb.add_option("--with-of", w.with_of,
                  "IDS=EFFECT: an effect of these robots alone, such as 3,4=battery_sag; several allowed");
  verb.add_option(
      "--start", w.start,
      "IDS=X,Y,DEG: where a robot stands at the start, in m and degrees from the field's x; several "
      "allowed");
  verb.add_option("--fault", w.fault,
                  "IDS: at_s = S, do = \"WORD\" and its keys: a fault by time in the words of scenarios "
                  "(scenario list), such "
                  "as '3: at_s = 5.0, for_s = 0.5, do = \"wheel_blocked\", wheels = [0]'; several allowed");
  verb.add_option("--opponents", w.opponents, "ids of the other team's robots: 0-5");
  verb.add_option("--opponents-robot", w.opponents_robot, "their model (default: as --robot)");
  verb.add_option("--opponents-radio", w.opponents_radio,
                  "radio format of their dongle (default: as --radio)");
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
  read_faults(words, setup, problems);
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

std::vector<StartPose> start_poses(const FieldWords& words, const SessionSetup& setup,
                                   std::vector<std::string>& problems) {
  std::vector<StartPose> poses;
  for (const std::string& text : words.start) {
    std::string_view value;
    const auto keys = keys_of("--start", text, "IDS=X,Y,DEG such as 3=1.5,-0.5,90", setup, value, problems);
    std::array<double, 3> at{};
    const bool good = read_numbers(std::string(value), at) && std::abs(at[0]) <= kFarthest_m &&
                      std::abs(at[1]) <= kFarthest_m && std::abs(at[2]) <= 360.0;
    if (!keys.empty() && !good)
      problems.push_back(
          fmt::format("--start: found \"{}\", allowed: X,Y up to {:g} m, DEG up to 360", text, kFarthest_m));
    for (const int key : keys) poses.push_back({key, at[0], at[1], at[2] * std::numbers::pi / 180.0});
  }
  if (!poses.empty() && !words.from.empty()) problems.push_back("--start: --from says where robots are");
  return poses;
}

}  // namespace omnihil
