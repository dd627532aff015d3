// A REM command packet and the command it stands for, both ways, for every version and command packet.
//
//   RobotCommand command = rem::to_command(values);                         // what the robot reads
//   if (!rem::encode_command(kMessages, command, {.robot_id = 3}, out)) …   // this version cannot say it
//
// v = rho (cos theta, sin theta) is in the field frame; the robot turns it by its own yaw. A velocity in the
// robot's own frame (no OMNIHIL_COMMAND_FIELD_FRAME) has no packet, but a pure turn has.
// Source: microcontroller6.0 5bfe578, executeCommands and global2Local.
#pragma once
#include <span>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil::rem {

RobotCommand to_command(const Values& values);

// Tries the packet of role kCommand, then the one of role kSingleCommand.
bool encode_command(std::span<const Message> messages, const RobotCommand& command, const CommandTo& to,
                    std::vector<std::uint8_t>& out);

}  // namespace omnihil::rem
