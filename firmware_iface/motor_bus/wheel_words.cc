#include "firmware_iface/motor_bus/wheel_words.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace omnihil {
namespace {

struct TypeRow {
  std::size_t bytes;
  bool has_sign;
};
// In the order of WordType.
constexpr std::array<TypeRow, static_cast<std::size_t>(WordType::kCount)> kTypes{
    {{1, false}, {1, true}, {2, false}, {2, true}, {4, false}, {4, true}, {4, true}}};

const TypeRow& row(WordType type) { return kTypes[static_cast<std::size_t>(type)]; }

std::size_t byte_of(const WordField& field, std::size_t i) {  // the i-th from the least significant
  return field.at + (field.big_endian ? row(field.type).bytes - 1 - i : i);
}

// Bits of the frame that are not the field's stay.
void put(BusFrame& frame, const WordField& field, std::uint32_t number) {
  const std::uint64_t mask = ((std::uint64_t{1} << field.width()) - 1) << field.shift;
  const std::uint64_t bits = std::uint64_t{number} << field.shift & mask;
  for (std::size_t i = 0; i < row(field.type).bytes; ++i) {
    std::uint8_t& byte = frame.data[byte_of(field, i)];
    byte = static_cast<std::uint8_t>((byte & ~(mask >> 8 * i)) | (bits >> 8 * i & 0xFFu));
  }
}

std::uint32_t bits_of(const WordField& field, double value) {
  if (field.type == WordType::kF32) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  const WordRange range = range_of(field);
  return static_cast<std::uint32_t>(std::llround(std::clamp(value, range.lower, range.upper)));
}

std::uint32_t counted(const WordCounter& counter, std::int64_t n) {
  const std::uint64_t round = std::uint64_t{counter.last} - counter.first + 1;
  const std::uint64_t steps = static_cast<std::uint64_t>(n) % round * counter.step % round;
  return static_cast<std::uint32_t>(counter.first + steps);
}

std::uint32_t checksum_of(const WordChecksum& rule, std::span<const std::uint8_t> frame) {
  const auto over = frame.subspan(rule.over_first, rule.over_last - rule.over_first + 1);
  std::uint32_t rest = rule.crc.start;
  switch (rule.sum) {
    case WordSum::kSum:
      for (const std::uint8_t byte : over) rest += byte;
      return rest ^ rule.crc.xor_out;
    case WordSum::kXor:
      for (const std::uint8_t byte : over) rest ^= byte;
      return rest ^ rule.crc.xor_out;
    case WordSum::kCrc:
      return rule.crc(over);
    case WordSum::kNamed:
      break;
  }
  return static_cast<std::uint32_t>(rule.named->of(over));
}

void fill(BusFrame& frame, const WordFrame& said, std::int64_t n, std::size_t wheel,
          std::span<const double> omega_rotor_rad_s) {
  for (const WordField& field : said.fields) {
    if (field.source == WordSource::kStays) put(frame, field, bits_of(field, field.value));
    if (field.source == WordSource::kCounter) put(frame, field, counted(field.counter, n));
    if (field.source != WordSource::kSpeed) continue;
    const std::size_t whose = said.each_wheel ? wheel : static_cast<std::size_t>(field.wheel);
    put(frame, field, bits_of(field, field.value * omega_rotor_rad_s[whose]));
  }
  for (const WordField& field : said.fields) {
    if (field.source == WordSource::kChecksum) put(frame, field, checksum_of(field.checksum, frame.bytes()));
  }
}

}  // namespace

std::size_t bytes_of(WordType type) { return row(type).bytes; }
bool is_unsigned(WordType type) { return !row(type).has_sign; }

WordRange range_of(const WordField& field) {
  const double span = std::ldexp(1.0, static_cast<int>(field.width()));
  if (row(field.type).has_sign) return {-0.5 * span, 0.5 * span - 1.0};
  return {0.0, span - 1.0};
}

void speak(const WheelWords& words, const WordMoment& moment, std::span<const double> omega_rotor_rad_s,
           std::vector<BusFrame>& out) {
  for (const WordFrame& said : words.frames) {
    const std::int64_t every_ns = said.every_ns != 0 ? said.every_ns : words.period_ns;
    const std::int64_t since_ns = moment.at_ns - said.from_ns;
    if (since_ns < 0 || moment.at_ns >= said.until_ns || since_ns % every_ns != 0) continue;
    const std::size_t times = said.each_wheel ? omega_rotor_rad_s.size() : 1;
    for (std::size_t wheel = 0; wheel < times; ++wheel) {
      const auto first = static_cast<std::uint32_t>(said.each_wheel ? moment.first_wheel : moment.board);
      BusFrame frame = can_frame(said.id + first + static_cast<std::uint32_t>(wheel), said.bytes);
      frame.extended = said.extended;
      fill(frame, said, since_ns / every_ns, wheel, omega_rotor_rad_s);
      out.push_back(frame);
    }
  }
}

}  // namespace omnihil
