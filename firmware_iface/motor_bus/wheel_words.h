// What a main board says to the boards that drive its wheels, as a table: frames and where the numbers stand in them.
//
//   WheelWords words{.period_ns = 2'000'000, .frames = {{.id = 0x100, .bytes = 8, .fields = {speed}}}};
//   speak(words, {board, first_wheel, at_ns}, speeds_rad_s, frames);     // in the order of the table
//
// A frame is said once for each wheel of the board, with the id of its first wheel and those after it, or once for the
// board; in each period, or every so many of them, and only within its time, which a start sequence ends. A field is a
// number that stays, a speed of a motor times a factor, a counter, or a checksum over bytes of the frame. Integers are
// rounded and end at their bounds. A counter is a function of the time alone, n = (t - from) / every: first + step n, going
// round. Checksums come after all else of the frame, in the order of the table, so that one may cover another. Cannot:
// answers, checksums over the id.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "firmware_iface/checksum.h"
#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

enum class WordType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kF32, kCount };
std::size_t bytes_of(WordType type);
bool is_unsigned(WordType type);

enum class WordSource : std::uint8_t { kStays, kSpeed, kCounter, kChecksum };

struct WordCounter {  // goes from `last` on at `first`
  std::uint32_t first = 0, last = 0, step = 1;
};

enum class WordSum : std::uint8_t { kSum, kXor, kCrc, kNamed };
struct WordChecksum {
  WordSum sum = WordSum::kSum;
  Crc crc{};                            // of kCrc; of a sum `start` and `xor_out` alone
  const ChecksumKind* named = nullptr;  // of kNamed
  std::size_t over_first = 0, over_last = 0;
};

struct WordField {
  std::size_t at = 0;
  WordType type = WordType::kF32;
  bool big_endian = false;
  unsigned shift = 0, bits = 0;  // within the type's word, from its lowest bit; 0 bits: all of it
  WordSource source = WordSource::kStays;
  int wheel = 0;       // whose speed, of the board's; in a frame for each wheel its own
  double value = 0.0;  // the number, or what 1 rad/s of the motor is
  WordCounter counter{};
  WordChecksum checksum{};

  unsigned width() const { return bits != 0 ? bits : 8 * static_cast<unsigned>(bytes_of(type)); }
};

// What a whole number in that field may be.
struct WordRange {
  double lower, upper;
};
WordRange range_of(const WordField& field);

struct WordFrame {
  static constexpr std::int64_t kForever_ns = std::numeric_limits<std::int64_t>::max();
  bool each_wheel = true;  // else one for the board
  std::uint32_t id = 0;    // CAN: of the robot's wheel 0, or of its board 0
  bool extended = false;
  std::uint8_t bytes = 0;
  std::int64_t every_ns = 0;  // 0: in each period
  std::int64_t from_ns = 0, until_ns = kForever_ns;
  std::vector<WordField> fields = {};
};

struct WheelWords {
  std::int64_t period_ns = 0;  // 0: there are none
  std::vector<WordFrame> frames;
};

struct WordMoment {
  int board = 0, first_wheel = 0;
  std::int64_t at_ns = 0;  // a multiple of the period
};

void speak(const WheelWords& words, const WordMoment& moment, std::span<const double> omega_rotor_rad_s,
           std::vector<BusFrame>& out);

}  // namespace omnihil
