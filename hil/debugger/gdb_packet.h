// Packets of the GDB remote serial protocol in a stream of bytes: $data#sum, + and - between them, 0x03 to interrupt.
//
//   GdbInput input;
//   input.add(bytes);
//   while (std::optional<GdbEvent> event = input.take()) …
//   const std::vector<std::uint8_t> out = gdb_packet("OK");      // $OK#9a
//
// Law: GDB manual, appendix "Remote Protocol", Overview: the sum is of the bytes between $ and #, modulo 256; } before
// a byte means that byte xor 0x20. A packet with a wrong sum is an event of its own, to be refused with '-'.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

enum class GdbEventKind : std::uint8_t { kPacket, kInterrupt, kAck, kNack, kBroken };
struct GdbEvent {
  GdbEventKind kind;
  std::string data;  // of a packet, unescaped
};

class GdbInput {
 public:
  void add(std::span<const std::uint8_t> bytes) { waiting_.append(bytes.begin(), bytes.end()); }
  std::optional<GdbEvent> take();
  void clear() { waiting_.clear(); }

 private:
  std::string waiting_;
};

std::vector<std::uint8_t> gdb_packet(std::string_view data);  // escaped, framed

std::string text_as_hex(std::string_view text);
// A hexadecimal number at the begin of `text`, which is shortened by it; nullopt: there is none.
std::optional<std::uint64_t> take_hex(std::string_view& text);
bool take_word(std::string_view& text, std::string_view word);  // true: it stood there, and is taken off

}  // namespace omnihil
