// What a board file says whose chip is an AVR: one motor to a board, one board or several with the same
// image. For people: docs/mcu-avr.md.
//
//   std::vector<BoardProblem> problems;
//   std::optional<AvrBoardSpec> spec = read_avr_board(text, "boards/mine.toml", problems);
//
// All problems come at once, each with its line, key, value and what is allowed; of an unknown chip that
// alone.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/avr/avr_chip.h"

namespace omnihil::mcu {

struct AvrMotor {  // and the board that drives it
  int wheel = 0;
  const AvrChannel* pwm = nullptr;
  bool inverted = false;
  std::optional<PinName> direction;
  bool direction_high_is_forward = true;
  double sign = 1.0;  // -1: the motor's leads are swapped
  std::optional<PinName> enable;
  std::vector<PinName> encoder;  // lines A and B; empty: none
  double encoder_sign = 1.0;
};

struct AvrPin {
  PinName pin;
  bool level = false;
  int robot_id_bit = -1;  // not negative: this bit of the robot's number instead
  int wheel_bit = -1;     // not negative: this bit of the number of the board's wheel instead
};

struct AvrBoardSpec {
  std::string name;
  const AvrChip* chip = nullptr;
  double crystal_Hz = 16e6;
  std::int64_t coupling_ns = 500'000;
  const AvrInterrupt* control = nullptr;  // begins a control period; null: not said
  std::int64_t control_period_ns = 0;
  std::string radio_format;  // empty: none
  char serial = 0;           // the port that the radio is on
  std::vector<AvrMotor> motors;
  std::vector<AnalogEntry> analog;  // a motor's current: of the board's own wheel
  std::vector<AvrPin> pins;
  std::vector<FlashEntry> eeprom;
};

std::optional<AvrBoardSpec> read_avr_board(std::string_view text, const std::string& file,
                                           std::vector<BoardProblem>& problems,
                                           const BoardContext& context = {});

}  // namespace omnihil::mcu
