// The table walker: bytes <-> values of one message, for both bit orders and every kind of field.
//
//   Values values;
//   const FieldFault fault = decode_fields(message, bytes, bytes.size(), values);
//   if (fault.error != PacketError::kNone) …   // fault.field names the culprit
//
// Framing, checksums and the choice of the message are the format's business; this walks the fields only.
// Ranged fields follow the rule of RoboTeam Twente's generator, bit for bit: all in float32,
//   scale = (hi - lo) / (2^bits - 1), printed with 16 decimals and read back as a float32
//   encode: raw = trunc((value - lo) / scale), kept to its `bits` low bits
//   decode: value = raw * scale + lo
// Consequences: encode(decode(raw)) may come out one count lower; a 32-bit field at `hi` wraps to raw 0.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocols/field_table.h"
#include "protocols/packet_error.h"

namespace omnihil {

struct FieldFault {
  PacketError error = PacketError::kNone;
  std::string_view field;
};

std::uint64_t read_bits(std::span<const std::uint8_t> bytes, int bit, int bits, BitOrder order);
void write_bits(std::span<std::uint8_t> bytes, int bit, int bits, BitOrder order, std::uint64_t raw);

float ranged_scale(const Field& field);
float ranged_value(const Field& field, std::uint64_t raw);
std::uint64_t ranged_raw(const Field& field, float value);

// The integer in a kInteger or kScaled field, with its sign (contents of 64 bits without a sign do not fit).
std::int64_t integer_of(const Field& field, std::uint64_t raw);
// The step from one count to the next: of a kRanged32 or kScaled field in its unit, of a kInteger field 1,
// of others 0.
double field_step(const Field& field);

// What a kConst, kType or kLength field must hold.
std::uint64_t required_raw(const Field& field, const Message& message, std::size_t packet_bytes);

// The number a raw content stands for; of a kFloat32 its value even where that is not finite.
double field_number(const Field& field, std::uint64_t raw);

// The value nearest to `number` that the field can carry: integers are rounded down, what is not finite is 0.
// For telemetry, where a robot's own code sets its fields to their ends.
Value nearest_value(const Field& field, double number);

// Reads and checks every field. `bytes` holds at least size_bytes; `packet_bytes` is the length of the whole
// packet, which a kLength field must give. Values read before a fault stay in `out`.
FieldFault decode_fields(const Message& message, std::span<const std::uint8_t> bytes,
                         std::size_t packet_bytes, Values& out);

// Why this field would not be encoded; kNone when it would.
PacketError field_fault(const Field& field, const Message& message, std::size_t packet_bytes,
                        const Value& value);

// Writes every field into `bytes` (at least size_bytes). A constant, type or length left at 0 is filled in;
// any other value there must be the right one. So it is with checksums that have a rule, which are computed
// over bytes.first(packet_bytes) at the end; those that have none are written as 0: the format computes them.
FieldFault encode_fields(const Values& values, std::size_t packet_bytes, std::span<std::uint8_t> bytes);

}  // namespace omnihil
