// What ibis' command asks of a robot, what the robot answers, and a host's command as a packet.
//
//   RobotCommand command = ibis::to_command(values);
//   ibis::answer(kMessages, to_robot, feedback, answered);
//   if (!ibis::encode_command(kMessages, command, bytes)) return;   // it cannot be said
#pragma once
#include <span>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil::ibis {

RobotCommand to_command(const Values& values);
bool answer(std::span<const Message> messages, const Values& to_robot, const RobotFeedback& feedback,
            Values& out);
// `robot_id`: of a table that names the robot.
bool encode_command(std::span<const Message> messages, const RobotCommand& wanted,
                    std::vector<std::uint8_t>& out, int robot_id = -1);

}  // namespace omnihil::ibis
