#include "firmware_iface/motor_bus/wheel_words.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace omnihil {
namespace {

struct TypeRow {
  std::string_view name;
  std::size_t bytes;
  double lower, upper;
};
constexpr std::array<TypeRow, static_cast<std::size_t>(WordType::kCount)> kTypes{
    {{"u8", 1, 0.0, 255.0},
     {"i8", 1, -128.0, 127.0},
     {"u16", 2, 0.0, 65535.0},
     {"i16", 2, -32768.0, 32767.0},
     {"u32", 4, 0.0, 4294967295.0},
     {"i32", 4, -2147483648.0, 2147483647.0},
     {"f32", 4, 0.0, 0.0}}};

const TypeRow& row(WordType type) { return kTypes[static_cast<std::size_t>(type)]; }

void put(BusFrame& frame, const WordField& field, double value) {
  const TypeRow& type = row(field.type);
  const auto bits = field.type == WordType::kF32
                        ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                        : static_cast<std::uint32_t>(std::llround(std::clamp(value, type.lower, type.upper)));
  for (std::size_t i = 0; i < type.bytes; ++i) {
    const std::size_t shift = 8 * (field.big_endian ? type.bytes - 1 - i : i);
    frame.data[field.at + i] = static_cast<std::uint8_t>(bits >> shift);
  }
}

}  // namespace

std::optional<WordType> word_type(std::string_view name) {
  for (std::size_t i = 0; i < kTypes.size(); ++i) {
    if (kTypes[i].name == name) return static_cast<WordType>(i);
  }
  return std::nullopt;
}

std::size_t bytes_of(WordType type) { return row(type).bytes; }

void speak(const WheelWords& words, int board, int first_wheel, std::span<const double> omega_rotor_rad_s,
           std::vector<BusFrame>& out) {
  for (const WordFrame& said : words.frames) {
    const std::size_t times = said.each_wheel ? omega_rotor_rad_s.size() : 1;
    for (std::size_t n = 0; n < times; ++n) {
      const auto first = static_cast<std::uint32_t>(said.each_wheel ? first_wheel : board);
      BusFrame frame = can_frame(said.id + first + static_cast<std::uint32_t>(n), said.bytes);
      frame.extended = said.extended;
      for (const WordField& field : said.fields) {
        const std::size_t wheel = said.each_wheel ? n : static_cast<std::size_t>(field.wheel);
        put(frame, field, field.speed ? field.value * omega_rotor_rad_s[wheel] : field.value);
      }
      out.push_back(frame);
    }
  }
}

}  // namespace omnihil
