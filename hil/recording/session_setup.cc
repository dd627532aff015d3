#include "hil/recording/session_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "hil/loop/session_checks.h"
#include "sim/model/model_spread.h"

namespace omnihil {
namespace {

constexpr int kMaxRobotId = 15;  // four bits in every radio format served

std::optional<int> parse_id(std::string_view text) {
  int id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (id < 0 || id > kMaxRobotId) return std::nullopt;
  return id;
}

}  // namespace

std::vector<int> parse_robot_list(std::string_view text, std::vector<std::string>& problems) {
  std::vector<int> ids;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    const std::string_view part = text.substr(from, comma - from);
    from = comma + 1;
    const std::size_t dash = part.find('-');
    const auto first = parse_id(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : parse_id(part.substr(dash + 1));
    if (!first || !last || *first > *last) {
      problems.push_back(fmt::format("robots: \"{}\" in \"{}\": allowed are ids 0 to {} such as 0-5 or 0,2,7",
                                     part, text, kMaxRobotId));
      continue;
    }
    for (int id = *first; id <= *last; ++id) {
      if (std::find(ids.begin(), ids.end(), id) != ids.end()) {
        problems.push_back(fmt::format("robots: id {} stands twice in \"{}\"", id, text));
      } else {
        ids.push_back(id);
      }
    }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

SessionConfig session_config(const SessionSetup& setup) {
  std::vector<std::string> problems;
  SessionConfig config;
  const ModelReading reading = read_bundle(setup.model);
  for (const ModelProblem& problem : reading.problems) problems.push_back(problem.text());
  if (reading.model && !reading.model->robot) {
    problems.push_back(
        fmt::format("{}: a model of rig \"{}\", not of a robot", setup.model.robot_file, reading.model->rig));
  }
  if (reading.model && reading.model->robot) {
    config.robots.assign(setup.robot_ids.size(), *reading.model->robot);
    config.opponents.robots.assign(setup.opponent_ids.size(), *reading.model->robot);
  } else {
    config.robots.resize(setup.robot_ids.size());
    config.opponents.robots.resize(setup.opponent_ids.size());
  }
  if (setup.spread > 0.0 && reading.model && reading.model->robot) {
    const auto draw = [&](std::vector<RobotModel>& robots, const std::vector<int>& ids, int first_key) {
      for (std::size_t i = 0; i < robots.size(); ++i)
        robots[i] =
            spread_robot(*reading.model, setup.spread, setup.plant.seed, first_key + ids[i], setup.plant);
    };
    draw(config.robots, setup.robot_ids, 0);
    draw(config.opponents.robots, setup.opponent_ids, kOpponentKey);
  }
  config.radio_format = setup.radio_format;
  config.robot_ids = setup.robot_ids;
  config.team = setup.team;
  config.plant = setup.plant;
  config.step_ns = setup.step_ns;
  config.epoch_ms = setup.epoch_ms;
  config.air = setup.air;
  config.field = setup.field;
  config.opponents.robot_ids = setup.opponent_ids;
  config.opponents.radio_format = setup.opponents_radio;
  for (std::string& problem : session_problems(config)) problems.push_back(std::move(problem));
  throw_problems(problems);
  return config;
}

void set_model(RecordingHeader& header, const ModelBundle& model) {
  header.robot_model = model.name;
  header.robot_model_text = model.robot_text;
  header.included_models.clear();
  if (!model.motor_file.empty()) header.included_models.push_back({model.motor_file, model.motor_text});
}

RecordingHeader recording_header(const SessionSetup& setup, const std::string& commit) {
  RecordingHeader header;
  header.commit = commit;
  set_model(header, setup.model);
  header.radio_format = setup.radio_format;
  header.robot_ids = setup.robot_ids;
  header.team = setup.team;
  header.plant = setup.plant;
  header.step_ns = setup.step_ns;
  header.epoch_ms = setup.epoch_ms;
  header.air = setup.air;
  header.field = setup.field;
  header.opponent_ids = setup.opponent_ids;
  header.opponents_radio = setup.opponents_radio;
  header.spread = setup.spread;
  header.seed = setup.plant.seed;
  return header;
}

SessionSetup session_setup(const RecordingHeader& header) {
  SessionSetup setup;
  setup.model.name = header.robot_model;
  setup.model.robot_file = header.robot_model + ".toml";
  setup.model.robot_text = header.robot_model_text;
  if (!header.included_models.empty()) {
    setup.model.motor_file = header.included_models.front().name;
    setup.model.motor_text = header.included_models.front().text;
  }
  setup.radio_format = header.radio_format;
  setup.robot_ids = header.robot_ids;
  setup.team = header.team;
  setup.plant = header.plant;
  setup.plant.seed = header.seed;
  setup.step_ns = header.step_ns;
  setup.epoch_ms = header.epoch_ms;
  setup.air = header.air;
  setup.field = header.field;
  setup.opponent_ids = header.opponent_ids;
  setup.opponents_radio = header.opponents_radio;
  setup.spread = header.spread;
  return setup;
}

}  // namespace omnihil
