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

std::vector<int> parse_robot_keys(std::string_view text, const SessionSetup& setup,
                                  std::vector<std::string>& problems) {
  constexpr std::string_view kOther = "opponents:";
  const bool other = text.starts_with(kOther);
  std::vector<int> keys = parse_robot_list(other ? text.substr(kOther.size()) : text, problems);
  const std::vector<int>& ids = other ? setup.opponent_ids : setup.robot_ids;
  for (int& key : keys) {
    if (!std::ranges::binary_search(ids, key))
      problems.push_back(fmt::format("{}robot {} is not on the floor", other ? kOther : "", key));
    if (other) key += kOpponentKey;
  }
  return keys;
}

SessionConfig session_config(const SessionSetup& setup) {
  std::vector<std::string> problems;
  SessionConfig config;
  const auto robot_of = [&](const ModelBundle& bundle) -> std::optional<ModelFile> {
    ModelReading reading = read_bundle(bundle);
    for (const ModelProblem& problem : reading.problems) problems.push_back(problem.text());
    if (!reading.model) return std::nullopt;
    if (!reading.model->robot) {
      problems.push_back(
          fmt::format("{}: a model of rig \"{}\", not of a robot", bundle.robot_file, reading.model->rig));
      return std::nullopt;
    }
    return std::move(*reading.model);
  };
  const std::optional<ModelFile> usual = robot_of(setup.model);
  std::vector<std::pair<const OtherModel*, std::optional<ModelFile>>> others;
  for (const OtherModel& other : setup.others) others.emplace_back(&other, robot_of(other.model));
  std::size_t known = 0, asked = 0;
  for (const OtherModel& other : setup.others) asked += other.keys.size();
  const auto fill = [&](std::vector<RobotModel>& robots, const std::vector<int>& ids, int first_key) {
    robots.resize(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const int key = first_key + ids[i];
      const std::optional<ModelFile>* model = &usual;
      for (const auto& [other, file] : others) {
        if (!std::ranges::binary_search(other->keys, key)) continue;
        model = &file;
        ++known;
      }
      if (!*model) continue;
      robots[i] = setup.spread > 0.0 ? spread_robot(**model, setup.spread, setup.plant.seed, key, setup.plant)
                                     : *(*model)->robot;
    }
  };
  fill(config.robots, setup.robot_ids, 0);
  fill(config.opponents.robots, setup.opponent_ids, kOpponentKey);
  if (known != asked) problems.push_back("a robot of another model is not on the floor, or has two of them");
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
  config.faults = setup.faults;
  config.from = setup.from;
  for (std::string& problem : session_problems(config)) problems.push_back(std::move(problem));
  throw_problems(problems);
  return config;
}

void set_model(RecordingHeader& header, const ModelBundle& model) {
  header.robot_model = model.name;
  header.robot_model_text = model.robot_text;
  header.included_models.clear();
  if (!model.motor_file.empty()) header.included_models.push_back({model.motor_file, model.motor_text});
  header.other_robots.clear();
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
  header.faults = setup.faults;
  header.from = setup.from;
  for (const OtherModel& other : setup.others) {
    OtherRobots& robots = header.other_robots.emplace_back();
    robots.keys = other.keys;
    robots.robot_model = other.model.name;
    robots.robot_model_text = other.model.robot_text;
    if (!other.model.motor_file.empty())
      robots.included_models.push_back({other.model.motor_file, other.model.motor_text});
  }
  header.seed = setup.plant.seed;
  return header;
}

namespace {
ModelBundle bundle_of(const std::string& name, const std::string& text,
                      const std::vector<ModelText>& included) {
  ModelBundle bundle;
  bundle.name = name;
  bundle.robot_file = name + ".toml";
  bundle.robot_text = text;
  if (!included.empty()) {
    bundle.motor_file = included.front().name;
    bundle.motor_text = included.front().text;
  }
  return bundle;
}
}  // namespace

SessionSetup session_setup(const RecordingHeader& header) {
  SessionSetup setup;
  setup.model = bundle_of(header.robot_model, header.robot_model_text, header.included_models);
  for (const OtherRobots& other : header.other_robots)
    setup.others.push_back(
        {other.keys, bundle_of(other.robot_model, other.robot_model_text, other.included_models)});
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
  setup.faults = header.faults;
  setup.from = header.from;
  return setup;
}

}  // namespace omnihil
