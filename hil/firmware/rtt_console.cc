#include "hil/firmware/rtt_console.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace omnihil {
namespace {

constexpr char kIdentifier[16] = "SEGGER RTT";  // filled up with zeros
constexpr std::uint32_t kChannels = 16, kDownChannels = 20, kFirstChannel = 24, kChannelBytes = 24;
constexpr std::uint32_t kBuffer = 4, kSize = 8, kWritten = 12, kRead = 16;  // in a channel
constexpr std::uint32_t kLargest = 1 << 20;  // of a buffer: more is no control block
constexpr std::uint32_t kMostChannels = 64;  // likewise
constexpr int kPause = 20;                   // pumps between two looks through the RAM: 10 ms

}  // namespace

std::uint32_t RttConsole::word(std::uint32_t address) const {
  std::uint8_t raw[4] = {};
  std::uint32_t value = 0;
  if (!machine_.memory().read(address, raw)) return 0;
  std::memcpy(&value, raw, sizeof value);
  return value;
}

void RttConsole::set_word(std::uint32_t address, std::uint32_t value) {
  std::uint8_t raw[4];
  std::memcpy(raw, &value, sizeof raw);
  machine_.cpu().spoil_fast_forward();
  machine_.memory().write(address, raw);
}

RttConsole::Ring RttConsole::ring(std::uint32_t channel) const {
  const Ring ring{channel, word(channel + kBuffer), word(channel + kSize), word(channel + kWritten),
                  word(channel + kRead)};
  return ring.size > kLargest || ring.written >= ring.size || ring.read >= ring.size ? Ring{} : ring;
}

RttConsole::Ring RttConsole::down() const {
  if (!is_there() || word(block_ + kDownChannels) == 0) return {};
  const std::uint32_t up = word(block_ + kChannels);
  return up > kMostChannels ? Ring{} : ring(block_ + kFirstChannel + kChannelBytes * up);
}

// One place stays free: full is not empty.
std::size_t RttConsole::room() const {
  const Ring to = down();
  return to.size == 0 ? 0 : (to.read + to.size - to.written - 1) % to.size;
}

void RttConsole::put(std::span<const std::uint8_t> bytes) {
  Ring to = down();
  if (to.size == 0 || bytes.empty()) return;
  for (const std::uint8_t byte : bytes) {
    machine_.memory().write(to.buffer + to.written, {&byte, 1});
    to.written = (to.written + 1) % to.size;
  }
  set_word(to.channel + kWritten, to.written);
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
    for (std::uint32_t at = 0; at + kFirstChannel + kChannelBytes <= region->size; at += 4) {
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
  const Ring from = ring(block_ + kFirstChannel);
  if (from.written == from.read) return;
  std::string text;
  std::uint32_t read = from.read;
  for (; read != from.written; read = (read + 1) % from.size) {
    std::uint8_t byte = 0;
    if (!machine_.memory().read(from.buffer + read, {&byte, 1})) return;
    text += static_cast<char>(byte);
  }
  set_word(from.channel + kRead, read);
  say(text);
}

}  // namespace omnihil
