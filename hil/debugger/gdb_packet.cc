#include "hil/debugger/gdb_packet.h"

#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

constexpr char kEscape = '}', kEscapeBit = 0x20, kInterrupt = 0x03;
constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kMost = 1u << 20;  // of one packet; announced are 16 KiB

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::uint8_t sum_of(std::string_view data) {
  std::uint8_t sum = 0;
  for (const char c : data) sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(c));
  return sum;
}

std::string unescaped(std::string_view data) {
  std::string plain;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const bool escaped = data[i] == kEscape && i + 1 < data.size();
    plain += escaped ? static_cast<char>(data[++i] ^ kEscapeBit) : data[i];
  }
  return plain;
}

}  // namespace

std::optional<GdbEvent> GdbInput::take() {
  while (!waiting_.empty()) {
    const char first = waiting_.front();
    if (first != '$') {
      waiting_.erase(0, 1);
      if (first == kInterrupt) return GdbEvent{GdbEventKind::kInterrupt, {}};
      if (first == '+') return GdbEvent{GdbEventKind::kAck, {}};
      if (first == '-') return GdbEvent{GdbEventKind::kNack, {}};
      continue;  // noise between packets
    }
    const std::size_t hash = waiting_.find('#');
    if (hash == std::string::npos && waiting_.size() > kMost) waiting_.clear();
    if (hash == std::string::npos || hash + 2 >= waiting_.size()) return std::nullopt;  // not whole yet
    const std::string data = waiting_.substr(1, hash - 1);
    const int high = digit(waiting_[hash + 1]), low = digit(waiting_[hash + 2]);
    waiting_.erase(0, hash + 3);
    if (high < 0 || low < 0 || sum_of(data) != high * 16 + low) return GdbEvent{GdbEventKind::kBroken, {}};
    return GdbEvent{GdbEventKind::kPacket, unescaped(data)};
  }
  return std::nullopt;
}

std::vector<std::uint8_t> gdb_packet(std::string_view data) {
  std::string body;
  for (const char c : data) {
    const bool special = c == '$' || c == '#' || c == kEscape || c == '*';
    if (special) body += kEscape;
    body += special ? static_cast<char>(c ^ kEscapeBit) : c;
  }
  const std::uint8_t sum = sum_of(body);
  const std::string framed = '$' + body + '#' + kDigits[sum >> 4] + kDigits[sum & 15];
  return {framed.begin(), framed.end()};
}

std::string text_as_hex(std::string_view text) {
  return to_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::optional<std::uint64_t> take_hex(std::string_view& text) {
  constexpr std::size_t kLongest = 16;
  std::uint64_t value = 0;
  std::size_t used = 0;
  for (; used < text.size() && used < kLongest && digit(text[used]) >= 0; ++used)
    value = value << 4 | static_cast<std::uint64_t>(digit(text[used]));
  if (used == 0) return std::nullopt;
  text.remove_prefix(used);
  return value;
}

bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

}  // namespace omnihil
