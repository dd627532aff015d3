#include "tools/options/twin_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "hil/dataset/dataset_reader.h"
#include "hil/text/dataset_files.h"

namespace omnihil {

void add_twin_options(Verb& verb, TwinWords& words) {
  verb.add_option("--twin-robot", words.robot, "robot to be watched (default: the only one)");
  verb.add_option("--twin-learn", words.learn_s,
                  "seconds of driving, healthy, from which it learns what to expect")
      .capture_default_str();
  verb.add_option("--twin-false-alarms", words.false_alarms_per_hour,
                  "false alarms that are accepted, per hour")
      .capture_default_str();
  verb.add_option("--twin-log", words.log,
                  "file for events, a line of JSON each; what is there is never overwritten");
}

TwinOptions twin_options(const TwinWords& words) {
  if (!(words.learn_s >= 10.0)) throw std::invalid_argument("--twin-learn: allowed: 10 and more");
  if (!(words.false_alarms_per_hour > 0.0) || words.false_alarms_per_hour > 10.0)
    throw std::invalid_argument("--twin-false-alarms: allowed: above 0, up to 10");
  return {.learn_s = words.learn_s, .false_alarms_per_hour = words.false_alarms_per_hour};
}

Candidate twin_model(const TwinWords& words) {
  CandidateReading reading = read_candidate(words.model);
  if (!reading.problems.empty() || !reading.candidate) {
    std::string all;
    for (const ModelProblem& p : reading.problems) all += (all.empty() ? "" : "\n") + p.text();
    throw std::invalid_argument(all);
  }
  return std::move(*reading.candidate);
}

int twin_robot(const TwinWords& words, const std::vector<int>& robot_ids) {
  if (words.robot < 0 && robot_ids.size() == 1) return robot_ids.front();
  if (std::find(robot_ids.begin(), robot_ids.end(), words.robot) != robot_ids.end()) return words.robot;
  throw std::invalid_argument(fmt::format(
      "--twin-robot: {}, allowed: {}", words.robot < 0 ? "not given" : "found " + std::to_string(words.robot),
      fmt::join(robot_ids, ", ")));
}

TwinLog::TwinLog(const TwinWords& words) {
  if (words.log.empty()) return;
  if (std::filesystem::exists(words.log)) throw FileExists(words.log + ": is there already");
  file_.reset(std::fopen(words.log.c_str(), "w"));
  if (!file_) throw std::system_error(errno, std::generic_category(), words.log);
}

void TwinLog::write(const TwinEvent& event) {
  if (!file_) return;
  fmt::print(file_.get(), "{}\n", twin_json(event));
  std::fflush(file_.get());
}

}  // namespace omnihil
