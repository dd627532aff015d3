#include "hil/firmware/rtt_console.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace omnihil {
namespace {

constexpr char kIdentifier[16] = "SEGGER RTT";  // filled up with zeros
constexpr std::uint32_t kChannels = 16, kFirstChannel = 24;
constexpr std::uint32_t kBuffer = 4, kSize = 8, kWritten = 12, kRead = 16;  // in a channel
constexpr std::uint32_t kLargest = 1 << 20;  // of a buffer: more is no control block
constexpr int kPause = 20;                   // pumps between two looks through the RAM: 10 ms

}  // namespace

std::uint32_t RttConsole::word(std::uint32_t address) const {
  std::uint8_t raw[4] = {};
  std::uint32_t value = 0;
  if (!machine_.memory().read(address, raw)) return 0;
  std::memcpy(&value, raw, sizeof value);
  return value;
}

bool RttConsole::is_there() const {
  std::uint8_t raw[sizeof kIdentifier] = {};
  return block_ != 0 && machine_.memory().read(block_, raw) && std::memcmp(raw, kIdentifier, sizeof raw) == 0;
}

// Word by word: the program aligns it.
bool RttConsole::look_for() {
  for (const auto& region : machine_.memory().regions()) {
    if (region->is_alias || !region->writable()) continue;
    const std::uint8_t* data = region->data();
    for (std::uint32_t at = 0; at + kFirstChannel + 24 <= region->size; at += 4) {
      if (data[at] != kIdentifier[0] || std::memcmp(data + at, kIdentifier, sizeof kIdentifier) != 0)
        continue;
      block_ = region->base + at;
      if (word(block_ + kChannels) > 0) return true;
    }
  }
  block_ = 0;
  return false;
}

void RttConsole::pump(const std::function<void(std::string_view)>& say) {
  if (!is_there()) {
    if (pause_-- > 0) return;
    pause_ = kPause;
    if (!look_for()) return;
  }
  const std::uint32_t channel = block_ + kFirstChannel;
  const std::uint32_t buffer = word(channel + kBuffer), size = word(channel + kSize);
  const std::uint32_t written = word(channel + kWritten);
  std::uint32_t read = word(channel + kRead);
  if (size == 0 || size > kLargest || written >= size || read >= size || written == read) return;
  std::string text;
  for (; read != written; read = (read + 1) % size) {
    std::uint8_t byte = 0;
    if (!machine_.memory().read(buffer + read, {&byte, 1})) return;
    text += static_cast<char>(byte);
  }
  std::uint8_t raw[4];
  std::memcpy(raw, &read, sizeof raw);
  machine_.cpu().spoil_fast_forward();
  machine_.memory().write(channel + kRead, raw);
  say(text);
}

}  // namespace omnihil
