// Captures byte by byte, in either byte order: what no tool at hand writes.
#pragma once
#include <string>
#include <string_view>

#include "hil/capture/captured.h"

namespace omnihil::peers {

struct FileBytes {
  bool big = false;
  std::string text;

  FileBytes& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) text += static_cast<char>(value >> 8 * (big ? size - 1 - i : i) & 0xFF);
    return *this;
  }
  FileBytes& u16(std::uint64_t value) { return number(value, 2); }
  FileBytes& u32(std::uint64_t value) { return number(value, 4); }
  FileBytes& bytes(std::string_view more) { return text += more, *this; }
  FileBytes& pad() { return text.append((4 - text.size() % 4) % 4, '\0'), *this; }
};

// What stands on the network, always most significant first.
inline FileBytes net() { return {.big = true, .text = {}}; }
inline std::string udp(int from, int to, std::string_view payload) {
  const auto port = [](int value) { return static_cast<std::uint64_t>(value); };
  return net().u16(port(from)).u16(port(to)).u16(8 + payload.size()).u16(0).bytes(payload).text;
}
inline std::string ipv4(std::string_view payload, int protocol = 17, int fragment = 0) {
  return net()
      .number(0x45, 1)
      .number(0, 1)
      .u16(20 + payload.size())
      .u16(1)
      .u16(static_cast<std::uint64_t>(fragment))
      .number(64, 1)
      .number(static_cast<std::uint64_t>(protocol), 1)
      .u16(0)
      .u32(0x7F000001)
      .u32(0x7F000001)
      .bytes(payload)
      .text;
}
inline std::string ipv6(std::string_view payload) {
  return net()
      .u32(0x60000000)
      .u16(payload.size())
      .number(17, 1)
      .number(64, 1)
      .bytes(std::string(32, '\1'))
      .bytes(payload)
      .text;
}
inline std::string ethernet(std::string_view payload, int type = 0x0800) {
  return net().bytes("\1\1\1\1\1\1\2\2\2\2\2\2").u16(static_cast<std::uint64_t>(type)).bytes(payload).text;
}
inline std::string cooked(std::string_view payload, int way, int protocol) {  // way 4: sent by this computer
  return net()
      .u16(static_cast<std::uint64_t>(way))
      .u16(1)
      .u16(6)
      .bytes(std::string(8, '\0'))
      .u16(static_cast<std::uint64_t>(protocol))
      .bytes(payload)
      .text;
}
inline std::string cooked2(std::string_view payload, int way, int protocol) {
  return net()
      .u16(static_cast<std::uint64_t>(protocol))
      .u16(0)
      .u32(1)
      .u16(1)
      .number(static_cast<std::uint64_t>(way), 1)
      .number(6, 1)
      .bytes(std::string(8, '\0'))
      .bytes(payload)
      .text;
}
inline std::string socketcan(std::uint32_t id, std::string_view data, int flags = 0) {
  return net()
      .u32(id)
      .number(data.size(), 1)
      .number(static_cast<std::uint64_t>(flags), 1)
      .u16(0)
      .bytes(data)
      .text;
}

// pcap of packets a millisecond apart, from `start_s` on.
inline std::string pcap_file(bool big, bool nanoseconds, int link, const std::vector<std::string>& packets,
                             std::uint64_t start_s = 1'700'000'000) {
  FileBytes out{.big = big, .text = {}};
  out.u32(nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4)
      .u16(2)
      .u16(4)
      .u32(0)
      .u32(0)
      .u32(65'535)
      .u32(static_cast<std::uint64_t>(link));
  std::uint64_t ms = 0;
  for (const std::string& packet : packets) {
    out.u32(start_s)
        .u32(ms++ * (nanoseconds ? 1'000'000 : 1'000))
        .u32(packet.size())
        .u32(packet.size())
        .bytes(packet);
  }
  return out.text;
}

// Blocks of pcapng.
inline std::string block(bool big, std::uint32_t type, std::string_view body) {
  FileBytes padded{.big = big, .text = std::string(body)};
  padded.pad();
  FileBytes out{.big = big, .text = {}};
  return out.u32(type).u32(padded.text.size() + 12).bytes(padded.text).u32(padded.text.size() + 12).text;
}
inline std::string section(bool big) {
  return block(big, 0x0A0D0D0A,
               FileBytes{.big = big, .text = {}}.u32(0x1A2B3C4D).u16(1).u16(0).u32(~0U).u32(~0U).text);
}
// `resolution`: 9 is 10^-9 s, 0x8A is 2^-10 s; without one 10^-6 s. `offset_s` is added to every time.
inline std::string interface(bool big, int link, int resolution = -1, int offset_s = 0) {
  FileBytes body{.big = big, .text = {}};
  body.u16(static_cast<std::uint64_t>(link)).u16(0).u32(0);
  if (resolution >= 0) body.u16(9).u16(1).number(static_cast<std::uint64_t>(resolution), 1).pad();
  if (offset_s != 0) body.u16(14).u16(8).number(static_cast<std::uint64_t>(offset_s), 8);
  if (resolution >= 0 || offset_s != 0) body.u32(0);
  return block(big, 1, body.text);
}
// `flags`: 1 inbound, 2 outbound, 0: no such option.
inline std::string packet(bool big, std::uint64_t ticks, std::string_view data, int flags = 0, int on = 0) {
  FileBytes body{.big = big, .text = {}};
  body.u32(static_cast<std::uint64_t>(on))
      .u32(ticks >> 32)
      .u32(ticks & 0xFFFF'FFFF)
      .u32(data.size())
      .u32(data.size())
      .bytes(data)
      .pad();
  if (flags != 0)
    body.u16(1).u16(5).bytes("hello").pad().u16(2).u16(4).u32(static_cast<std::uint64_t>(flags)).u32(0);
  return block(big, 6, body.text);
}

}  // namespace omnihil::peers
