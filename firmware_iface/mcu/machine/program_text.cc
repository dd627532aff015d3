// Text that a program says to whoever debugs it: semihosting and ITM.
#include <algorithm>
#include <string>

#include "firmware_iface/mcu/machine/machine.h"

namespace omnihil::mcu {
namespace {

// Semihosting for AArch32 and AArch64, release 2.0: the operation in r0, its argument's address in r1.
enum Operation : std::uint32_t {
  kOpen = 0x01,
  kClose = 0x02,
  kWriteC = 0x03,
  kWrite0 = 0x04,
  kWrite = 0x05,
  kIsTty = 0x09
};
constexpr std::uint32_t kSemihosting = 0xAB, kFailed = ~0u;
constexpr std::uint32_t kLongest = 4096;  // of one call

// DDI 0403E.e C1.7: stimulus ports, trace enable, trace control.
constexpr std::uint32_t kItm = 0xE0000000, kPorts = 0x80, kEnable = 0xE00, kControl = 0xE80, kLock = 0xFB0;

std::string text_at(Memory& memory, std::uint32_t address, std::uint32_t most, bool to_zero) {
  std::string text;
  std::uint8_t byte = 0;
  while (text.size() < most && memory.read(address++, {&byte, 1}) && !(to_zero && byte == 0))
    text += static_cast<char>(byte);
  return text;
}

}  // namespace

void Machine::set_semihosting(std::function<void(std::string_view)> listener) {
  set_breakpoint_hook([this, listener = std::move(listener)](std::uint32_t number) {
    if (number != kSemihosting) return false;
    std::uint32_t& result = cpu_.reg.r[0];
    const std::uint32_t argument = cpu_.reg.r[1];
    std::uint32_t block[3] = {};
    cpu_.spoil_fast_forward();
    switch (result) {
      case kWriteC:
        listener(text_at(memory_, argument, 1, false));
        break;
      case kWrite0:
        listener(text_at(memory_, argument, kLongest, true));
        break;
      case kWrite:
        for (std::uint32_t i = 0; i < 3; ++i) read_word(argument + 4 * i, block[i]);
        listener(text_at(memory_, block[1], std::min(block[2], kLongest), false));
        result = 0;  // nothing was left over
        break;
      case kOpen:
      case kIsTty:
        result = 1;
        break;
      case kClose:
        result = 0;
        break;
      default:
        report_unmodelled("semihosting", "operation " + std::to_string(result));
        result = kFailed;
    }
    return true;
  });
}

bool Machine::read_trace(std::uint32_t address, std::uint32_t& value) const {
  const std::uint32_t offset = address - kItm;
  if (!trace_ || offset >= 0x1000) return false;
  value = offset < kPorts || offset == kControl ? 1 : offset == kEnable ? ~0u : 0;  // ready, on
  return true;
}

bool Machine::write_trace(std::uint32_t address, unsigned bytes, std::uint32_t value) {
  const std::uint32_t offset = address - kItm;
  if (!trace_ || offset >= 0x1000) return false;
  std::string said;
  for (unsigned i = 0; i < bytes; ++i) said += static_cast<char>(value >> 8 * i);
  if (offset < kPorts) trace_(said);
  if (offset >= kPorts && offset != kEnable && offset != kControl && offset != kLock)
    report_unmodelled("ITM", "a register but its ports written");
  return true;
}

}  // namespace omnihil::mcu
