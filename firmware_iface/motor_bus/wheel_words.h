// What a main board says to the boards that drive its wheels, as a table: frames and where the numbers stand in them.
//
//   WheelWords words{.period_ns = 2'000'000, .frames = {{.id = 0x100, .bytes = 8, .fields = {speed}}}};
//   speak(words, board, first_wheel, speeds_rad_s, frames);     // in the order of the table
//
// A frame is said once for each wheel of the board, with the id of its first wheel and those after it, or once for the
// board. A field is a number that stays or a speed of a motor times a factor. Integers are rounded and end at their
// bounds. Cannot: checksums, counters, answers.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

enum class WordType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kF32, kCount };
std::optional<WordType> word_type(std::string_view name);  // "u8", "i16", "f32", …
std::size_t bytes_of(WordType type);

struct WordField {
  std::size_t at = 0;
  WordType type = WordType::kF32;
  bool big_endian = false;
  bool speed = false;  // of a motor; else the number stays
  int wheel = 0;       // whose, of the board's; in a frame for each wheel its own
  double value = 0.0;  // the number, or what 1 rad/s of the motor is
};

struct WordFrame {
  bool each_wheel = true;  // else one for the board
  std::uint32_t id = 0;    // CAN: of the robot's wheel 0, or of its board 0
  bool extended = false;
  std::uint8_t bytes = 0;
  std::vector<WordField> fields;
};

struct WheelWords {
  std::int64_t period_ns = 0;  // 0: there are none
  std::vector<WordFrame> frames;
};

void speak(const WheelWords& words, int board, int first_wheel, std::span<const double> omega_rotor_rad_s,
           std::vector<BusFrame>& out);

}  // namespace omnihil
