// What can be wrong with a session before and while it runs.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "hil/loop/session.h"

namespace omnihil {

// Every problem of the configuration, one line each; empty when it can run. Models and plant options are
// checked by the plant itself.
std::vector<std::string> session_problems(const SessionConfig& config);
// The same for the firmware of the robots, once it is made.
std::vector<std::string> firmware_problems(const SessionConfig& config,
                                           std::span<const std::unique_ptr<Firmware>> firmware);

// Name of the first signal of a control tick that is not finite; empty: all are. (The true state is watched
// by the plant: Plant::fault.)
std::string first_non_finite(const RobotSample& sample);

// Ids of the radio formats that there are.
std::vector<std::string> radio_format_ids();

// Throws std::invalid_argument with all problems as one text, if there are any.
void throw_problems(const std::vector<std::string>& problems);

// What a robot's firmware is told about its robot.
RobotConfig robot_config(const RobotModel& model, int robot_id);

}  // namespace omnihil
