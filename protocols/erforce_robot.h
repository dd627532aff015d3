// What ER-Force's packets of 2025 ask of a robot, what it answers, and a host's command as a packet.
//
//   RobotCommand command = erforce::to_command(values);
//   erforce::answer(kMessages, to_robot, feedback, answered);
//   if (!erforce::encode_command(format, command, bytes)) return;   // it cannot be said
#pragma once
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil::erforce {

RobotCommand to_command(const Values& values);
bool answer(std::span<const Message> messages, const Values& to_robot, const RobotFeedback& feedback,
            Values& out);
// The robot acknowledges the part of a datagram that came last; `kept` is 0 before the first.
void remember(const Values& to_robot, std::uint32_t& kept, Values& answer);
bool encode_command(const RadioFormat& format, const RobotCommand& wanted, std::vector<std::uint8_t>& out);

}  // namespace omnihil::erforce
