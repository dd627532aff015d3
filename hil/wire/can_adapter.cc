#include "hil/wire/can_adapter.h"

#include <charconv>

namespace omnihil {
namespace {
constexpr int kLengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};  // ISO 11898-1:2015
}

int can_fd_length(int code) { return kLengths[code]; }

int can_fd_code(std::size_t bytes) {
  int code = 0;
  while (code < 15 && static_cast<std::size_t>(kLengths[code]) < bytes) ++code;
  return code;
}

bool read_hex_number(std::string_view text, std::uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return !text.empty() && error == std::errc{} && end == text.data() + text.size();
}

bool read_hex(std::string_view text, std::span<std::uint8_t> out, std::size_t& size) {
  if (text.size() % 2 != 0 || text.size() / 2 > out.size()) return false;
  size = text.size() / 2;
  for (std::size_t i = 0; i < size; ++i) {
    std::uint32_t value = 0;
    if (!read_hex_number(text.substr(2 * i, 2), value)) return false;
    out[i] = static_cast<std::uint8_t>(value);
  }
  return true;
}

}  // namespace omnihil
