// Faults of robots by time, as a bench says them: in force from an instant to another, those of one robot together.
//
//   std::vector<TimedFault> plan{{.key = 3, .from_ns = 1'000'000'000, .faults = {.supply_ratio = 0.6}}};
//   const RobotFaults now = faults_at(plan, 3, session.now_ns());
//   if (silent_at(plan, 3, session.now_ns())) …         // no packet passes between this robot and its dongle
//
// A session takes them at the beginning of a loop step (SessionConfig::faults); a recording's header has them.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "sim/robot/robot_faults.h"

namespace omnihil {

struct TimedFault {
  int key = 0;  // the robot's id; an opponent's: kOpponentKey + id
  std::int64_t from_ns = 0;
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  // for good
  bool silent = false;
  RobotFaults faults{};

  bool operator==(const TimedFault&) const = default;
};

// `one` in force beside what is: forces add, supplies multiply, sets join, the later heat holds.
void join_faults(RobotFaults& all, const RobotFaults& one);

RobotFaults faults_at(std::span<const TimedFault> plan, int key, std::int64_t now_ns);
bool silent_at(std::span<const TimedFault> plan, int key, std::int64_t now_ns);
bool any_silence(std::span<const TimedFault> plan);

// What is wrong with them, a line each; `keys`: of the robots on the floor.
std::vector<std::string> fault_problems(std::span<const TimedFault> plan, std::span<const int> keys);

}  // namespace omnihil
