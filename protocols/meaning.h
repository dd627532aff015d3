// What a field is to a robot, where its format has no code that says so: a quantity of the command or of the feedback.
//
//   const Meaning* meaning = find_meaning("v_forward_m_s");
//   RobotCommand command = command_by_meaning(values);
//   answer_by_meaning(format, to_robot, id, feedback, out);
//   ask_by_meaning(format, command, {.robot_id = 3}, bytes);             // the other way: what a host writes
//
// quantity = times * number of the field. A packet's Message::asks says what it drives.
#pragma once
#include <span>
#include <string_view>

#include "protocols/radio_format.h"

namespace omnihil {

struct Meaning {
  std::string_view word;  // with its unit
  std::string_view says;
  void (*ask)(RobotCommand& command, double quantity) = nullptr;  // null: no command has it
  double (*tell)(const RobotFeedback& feedback) = nullptr;        // null: no feedback has it
};

// "echo": of an answer, the field of the same name in the packet that is answered.
std::span<const Meaning> meanings();
const Meaning* find_meaning(std::string_view word);  // nullptr when unknown

RobotCommand command_by_meaning(const Values& values);
// The packet of role kFeedback. False: the format has none.
bool answer_by_meaning(const RadioFormat& format, const Values& to_robot, int id,
                       const RobotFeedback& feedback, Values& out);

// Appends the frame of the command packet that drives in this mode and frame: velocity, wheel speeds or duties alone.
// False: the format has none, or a number does not fit; nothing is appended.
bool ask_by_meaning(const RadioFormat& format, const RobotCommand& command, const CommandTo& to,
                    std::vector<std::uint8_t>& out);

// By the format's own code, where it has one, else by the fields' meanings.
bool encode_drive(const RadioFormat& format, const RobotCommand& command, const CommandTo& to,
                  std::vector<std::uint8_t>& out);

}  // namespace omnihil
