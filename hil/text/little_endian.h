// Numbers as bytes of a file, least significant first.
//
//   std::string bytes;
//   put_u32(bytes, 0xa1b23c4d);              // 4d 3c b2 a1
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace omnihil {

template <typename T>
void put_little_endian(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
}
inline void put_u8(std::string& out, std::uint8_t value) { out += static_cast<char>(value); }
inline void put_u16(std::string& out, std::uint16_t value) {
  put_u8(out, static_cast<std::uint8_t>(value & 0xff));
  put_u8(out, static_cast<std::uint8_t>(value >> 8));
}
inline void put_u32(std::string& out, std::uint32_t value) { put_little_endian(out, value); }
inline void put_u64(std::string& out, std::uint64_t value) { put_little_endian(out, value); }
// Behind its length in four bytes.
inline void put_text(std::string& out, std::string_view text) {
  put_u32(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

}  // namespace omnihil
