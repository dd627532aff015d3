#include "firmware_iface/mcu/stm32/can.h"

#include <vector>

namespace omnihil::mcu {
namespace {
constexpr unsigned kLengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
}

unsigned can_dlc(unsigned bytes) {
  unsigned dlc = 0;
  while (dlc < 15 && kLengths[dlc] < bytes) ++dlc;
  return dlc;
}

unsigned can_bytes(unsigned dlc, bool fd) { return fd || dlc <= 8 ? kLengths[dlc & 15u] : 8; }

unsigned can_fast_bits(const CanFrame& frame) {
  if (!frame.fd || !frame.fast) return 0;
  // ESI, DLC, data, stuff count with parity, CRC of 17 or 21 bits with fixed stuff bits, CRC delimiter
  const unsigned crc = frame.bytes > 16 ? 21 + 6 : 17 + 5;
  return 1 + 4 + 8u * frame.bytes + 4 + crc + 1;
}

unsigned can_frame_bits(const CanFrame& frame) {
  if (frame.fd) {
    const unsigned head = frame.extended ? 37 : 18;
    const unsigned slow = frame.fast ? 0 : 1 + 4 + 8u * frame.bytes + 4 + (frame.bytes > 16 ? 27 : 22) + 1;
    return head + head / 10 + slow + 2 + 7 + 3;  // ACK with delimiter, end of frame, interframe space
  }
  return static_cast<unsigned>(can_line_bits(frame).size());
}

std::vector<bool> can_line_bits(const CanFrame& frame) {
  std::vector<bool> bits;
  const auto put = [&bits](std::uint32_t value, unsigned n) {
    for (unsigned i = n; i-- > 0;) bits.push_back((value >> i & 1u) != 0);
  };
  put(0, 1);  // SOF
  if (frame.extended) {
    put(frame.id >> 18, 11);
    put(3, 2);  // SRR, IDE
    put(frame.id & 0x3FFFFu, 18);
    put(frame.remote ? 1 : 0, 1);
    put(0, 2);
  } else {
    put(frame.id, 11);
    put(frame.remote ? 1 : 0, 1);
    put(0, 2);
  }
  put(frame.bytes, 4);
  for (unsigned i = 0; i < frame.bytes && !frame.remote; ++i) put(frame.data[i], 8);
  std::uint32_t crc = 0;  // polynomial 0x4599
  for (const bool b : bits) {
    const bool feedback = b != ((crc >> 14 & 1u) != 0);
    crc = (crc << 1 & 0x7FFFu) ^ (feedback ? 0x4599u : 0u);
  }
  put(crc, 15);
  std::vector<bool> line;
  unsigned run = 0;
  bool last = true;
  for (const bool b : bits) {
    line.push_back(b);
    run = b == last && run > 0 ? run + 1 : 1;
    last = b;
    if (run == 5) {  // a bit of the other kind follows, and counts for the next run
      line.push_back(!b);
      last = !b;
      run = 1;
    }
  }
  line.push_back(true);                      // CRC delimiter
  line.push_back(false);                     // ACK slot
  line.insert(line.end(), 1 + 7 + 3, true);  // its delimiter, end of frame, interframe space
  return line;
}

}  // namespace omnihil::mcu
