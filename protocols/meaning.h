// What a field is to a robot, where its format has no code that says so: a quantity of the command or of the feedback.
//
//   const Meaning* meaning = find_meaning("v_forward_m_s");
//   RobotCommand command = command_by_meaning(values);
//   answer_by_meaning(format, to_robot, id, feedback, out);
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

}  // namespace omnihil
