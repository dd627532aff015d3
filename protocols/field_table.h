// A packet described once, as a table of fields. Encoder, decoder, checks, documentation, C header and
// fuzzing all walk this table; a radio format is a handful of such tables in one file under teams/.
//
// A field's place is a bit offset and a width in the message's bit order:
//   kMsbFirst  bit 0 is the most significant bit of byte 0, fields run on across bytes, big-endian
//   kLsbFirst  bit 0 is the least significant bit of byte 0, fields run upward, little-endian
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/checksum.h"

namespace omnihil {

enum class BitOrder : std::uint8_t { kMsbFirst, kLsbFirst };

enum class FieldKind : std::uint8_t {
  kInteger,   // value = raw, with a sign by `sign`; lo..hi is the allowed range
  kConst,     // raw must equal `constant`: sync bytes, protocol version
  kType,      // packet type code; raw must equal the message's `type`, or its bits from `constant` on
  kLength,    // raw must equal the whole packet's length in bytes less `constant` (a header not counted)
  kFloat32,   // IEEE-754 single in the byte order of the message; must be finite
  kRanged32,  // value = raw * scale + lo in float32, scale = (hi - lo) / (2^bits - 1): REM's rule
  kScaled,    // value by `scale` from the integer in the field, which has a sign by `sign`
  kReserved,  // meaning unknown: survives a round trip, never refused
  kChecksum,  // computed by `check`; without one by the format's own rule, and the walker leaves it out
};

// Why a packet is refused whose kConst field holds something else.
enum class ConstCause : std::uint8_t {
  kConstant,
  kVersion,  // packet tables of another version, which may be laid out otherwise: looked at before the length
  kAddress,  // for somebody else
};

enum class Sign : std::uint8_t {
  kNone,            // 0 to 2^bits - 1
  kTwosComplement,  // -2^(bits-1) to 2^(bits-1) - 1
  kMagnitude,       // the highest bit alone is the sign: +-(2^(bits-1) - 1), and two zeros
};

struct Field;
struct Meaning;

// What the team's encoder does with a number beyond lo..hi.
enum class Beyond : std::uint8_t {
  kRefused,
  kClamped,  // sets it to the end
  kWrapped,  // adds or takes away whole spans hi - lo, in float32: angles
};

// How a team turns a number into the integer of a field and back, in its own arithmetic. Decoding is linear:
// number = (number at 0) + count * (number at 1 - number at 0), up to rounding. The rules: scale_rules.h.
struct ScaleRule {
  std::string_view name{};  // as a table in a file calls it: "nearest"
  std::string_view says{};  // for the documentation: "count = trunc(32767 x / hi + 32767) in float32"
  double (*number)(const Field& field, std::int64_t count) = nullptr;
  std::int64_t (*count)(const Field& field, double number) = nullptr;  // of a number within lo..hi
  Beyond beyond = Beyond::kRefused;
  bool none_at_lowest = false;  // the lowest count says that there is no number: NaN, null in JSON
};

// A sum or CRC over bytes of a packet as it stands in its frame without framing; the field itself counts as 0.
struct ChecksumRule {
  const ChecksumKind* kind = nullptr;
  int from = 0;   // the first byte of the sum
  int until = 0;  // the byte after its last; from 0 down counted from the packet's end

  std::uint64_t of(std::span<const std::uint8_t> packet) const {
    const int end = until > 0 ? until : static_cast<int>(packet.size()) + until;
    return kind->of(packet.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(end - from)));
  }
};

// What a field tells a dongle, whatever the team calls it.
enum class FieldRole : std::uint8_t {
  kNone,
  kRobot,       // the robot meant
  kRobotBits,   // a bit for each robot meant
  kTeam,        // its team: 0 yellow, 1 blue
  kTeamYellow,  // its team: 0 blue, 1 yellow
  kAllRobots,   // not 0: every robot of the team
  kForDongle,   // not 0: the dongle itself
  kForHost,     // not 0: the host; a dongle that gets this from the host gives it back
};

struct Field {
  // The team's own name. "cmd[2]" is element 2 of an array "cmd", "motor.speed" a member of a struct "motor".
  std::string_view name{};
  int bit = 0;
  int bits = 0;
  FieldKind kind = FieldKind::kInteger;
  Sign sign = Sign::kNone;  // kInteger and kScaled
  double lo = 0.0;          // smallest and largest value, in `unit`; equal: not limited
  double hi = 0.0;
  std::uint64_t constant = 0;  // kConst: the content; kType, kLength: see there
  ConstCause cause = ConstCause::kConstant;
  const ScaleRule* scale = nullptr;     // kScaled
  const ChecksumRule* check = nullptr;  // kChecksum
  std::string_view unit{};  // "m/s", "rad", "" for a plain number, "bool" for true and false in JSON
  std::string_view what{};  // one line for the documentation
  // Part of the frame rather than of the packet's content (HERMES' version, source, checksum): filled in by
  // encode, checked by decode, not listed among the values a user reads and writes.
  bool envelope = false;
  FieldRole role = FieldRole::kNone;
  // A flag of the same packet, before this field: where it is 0 the field says nothing, is sent as 0 and read as
  // NaN (null in JSON).
  std::string_view only_if{};
  // In formats that come from files: what the number is to a robot, times * number; meaning.h.
  const Meaning* means = nullptr;
  double times = 1.0;
  std::string_view names{};  // of its values, where they have some: "1 IDLE, 8 CLOSED_LOOP_CONTROL"
  int tag = 0;               // of Framing::kProtobuf: its number in the protobuf message
};

// kInside: between the boards of one robot, never on the radio.
enum class Direction : std::uint8_t { kToRobot, kFromRobot, kBoth, kToDongle, kFromDongle, kInside };

// What a packet is for, where a dongle or the radio end of a robot treats it in a way of its own.
enum class MessageRole : std::uint8_t {
  kNone,
  kHeaderOnly,     // says nothing
  kFiller,         // fills an air packet; never for anybody
  kCommand,        // what a robot does from now on; a newer one makes it void
  kSingleCommand,  // the same, but each one counts
  kKill,           // the robot stops
  kSetGains,       // a robot's controllers
  kGetGains,       // answered by kGains
  kGains,
  kAnnounce,  // a packet that is to be acknowledged follows
  kAcknowledge,
  kFeedback,         // a robot's state in short
  kStateInfo,        // and at length
  kText,             // a line for people
  kConfigureDongle,  // from the host an order, from the dongle its answer
  kAskDongle,        // answered by kConfigureDongle
};

struct Message {
  std::string_view name;   // the team's own name, as `encode FORMAT NAME` takes it
  std::uint32_t type = 0;  // the code on the wire
  int size_bytes = 0;      // of the fields; a text tail comes on top
  bool text_tail = false;  // free text follows the fields (REM_Log)
  Direction direction = Direction::kBoth;
  BitOrder bit_order = BitOrder::kMsbFirst;
  std::span<const Field> fields;
  std::string_view what;
  MessageRole role = MessageRole::kNone;
  std::uint32_t answer_type = 0;  // of the packet that answers this one; 0: none does
  // In formats that come from files: the drive that a command is for, OMNIHIL_MODE_*, and its frame.
  int asks = -1;
  bool in_field_frame = false;

  int field_index(std::string_view name) const;  // -1 when there is none
  int field_index(FieldRole wanted) const;
};

const Message* message_of_type(std::span<const Message> messages, std::uint32_t type);  // nullptr: none
const Message* message_of_role(std::span<const Message> messages, MessageRole role);  // the first; or nullptr

inline constexpr int kMaxFields = 96;

// One field's content: `raw` is what stands on the wire, `number` its meaning in the field's unit.
struct Value {
  double number = 0.0;
  std::uint64_t raw = 0;
};

// Values of one packet, index by index as in message->fields. Fixed size: no allocation in the loop.
// Encoding goes by `number`; `raw` decides only where it stands for exactly that number (decoded values go
// back to the very same bits, and integers wider than a double's 53 bits survive).
struct Values {
  const Message* message = nullptr;
  std::array<Value, kMaxFields> fields{};
  std::string_view text;  // the tail of a message with text_tail; points into the decoded buffer

  double number(std::string_view field) const;  // asserts that the field exists
  bool flag(std::string_view field) const { return number(field) != 0.0; }
  void set(std::string_view field, double number);  // asserts that the field exists; clears `raw`
  // Of a field that this packet may not have.
  double number_or(std::string_view field, double absent) const {
    return at_or(message->field_index(field), absent);
  }
  double number_or(FieldRole role, double absent) const { return at_or(message->field_index(role), absent); }

 private:
  double at_or(int index, double absent) const {
    return index < 0 ? absent : fields[static_cast<std::size_t>(index)].number;
  }
};

// True when the fields cover size_bytes * 8 bits exactly, without gap or overlap.
constexpr bool is_tiled(const Message& message) {
  int covered = 0;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& a = message.fields[i];
    if (a.bits < 1 || a.bits > 64 || a.bit < 0 || a.bit + a.bits > 8 * message.size_bytes) return false;
    for (std::size_t j = 0; j < i; ++j) {
      const Field& b = message.fields[j];
      if (a.bit < b.bit + b.bits && b.bit < a.bit + a.bits) return false;
    }
    covered += a.bits;
  }
  return covered == 8 * message.size_bytes && message.fields.size() <= kMaxFields;
}

constexpr bool all_tiled(std::span<const Message> messages) {
  for (const Message& message : messages) {
    if (!is_tiled(message)) return false;
  }
  return true;
}

}  // namespace omnihil
