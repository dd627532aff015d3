#include "firmware_iface/mcu/rp2040/flash_chip.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint8_t {
  kPageProgram = 0x02,
  kRead = 0x03,
  kWriteDisable = 0x04,
  kStatus1 = 0x05,
  kWriteEnable = 0x06,
  kFastRead = 0x0B,
  kWriteStatus1 = 0x01,
  kWriteStatus2 = 0x31,
  kErase4 = 0x20,
  kStatus2 = 0x35,
  kUnique = 0x4B,
  kErase32 = 0x52,
  kManufacturer = 0x90,
  kIdentity = 0x9F,
  kErase64 = 0xD8,
};
constexpr std::array<std::uint8_t, 3> kJedec{0xEF, 0x40, 0x15};
constexpr std::array<std::uint8_t, 8> kUniqueId{0x6F, 0x6D, 0x6E, 0x69,
                                                0x68, 0x69, 0x6C, 0x00};  // this one's own
constexpr std::uint8_t kWritable = 2, kQuadEnable = 2;
}  // namespace

void FlashChip::select(bool selected) {
  if (selected && !selected_) place_ = address_ = command_ = 0;
  selected_ = selected;
}

void FlashChip::erase(std::uint32_t offset, std::uint32_t bytes) {
  const std::uint32_t at = offset & (kFlashBytes - 1) & ~(bytes - 1);
  system_.program_flash(kFlashBase + at, std::vector<std::uint8_t>(bytes, 0xFF));
}

void FlashChip::program(std::uint32_t offset, std::uint8_t byte) {
  const std::uint32_t at = kFlashBase + (offset & (kFlashBytes - 1));
  const auto cell =
      static_cast<std::uint8_t>(system_.bus_read(at, 1) & byte);  // ones stay only where they were
  system_.program_flash(at, {&cell, 1});
}

std::uint8_t FlashChip::exchange(std::uint8_t out) {
  if (place_ == 0) {
    command_ = out;
    if (out == kWriteEnable) writable_ = true;
    if (out == kWriteDisable) writable_ = false;
  }
  const std::uint8_t in = place_ == 0 ? std::uint8_t{0xFF} : answer(out);
  ++place_;
  return in;
}

std::uint8_t FlashChip::answer(std::uint8_t out) {
  const bool of_address = place_ <= 3;
  switch (command_) {
    case kStatus1:
      return writable_ ? kWritable : 0;
    case kStatus2:
      return kQuadEnable;
    case kIdentity:
      return kJedec[(place_ - 1) % kJedec.size()];
    case kManufacturer:
      return place_ < 4 ? 0xFF : place_ % 2 == 0 ? kJedec[0] : std::uint8_t{kJedec[2] - 1};
    case kUnique:
      return place_ < 5 ? 0xFF : kUniqueId[(place_ - 5) % kUniqueId.size()];
    case kRead:
    case kFastRead:
      if (of_address) {
        address_ = address_ << 8 | out;
        return 0xFF;
      }
      if (command_ == kFastRead && place_ == 4) return 0xFF;
      return static_cast<std::uint8_t>(system_.bus_read(kFlashBase + (address_++ & (kFlashBytes - 1)), 1));
    case kPageProgram:
      if (of_address) {
        address_ = address_ << 8 | out;
      } else if (writable_) {
        program(address(), out);
        address_ = (address_ & ~0xFFu) | ((address_ + 1) & 0xFFu);  // within its page
      }
      return 0xFF;
    case kErase4:
    case kErase32:
    case kErase64:
      address_ = address_ << 8 | out;
      if (place_ == 3 && writable_) {
        erase(address(), command_ == kErase4 ? 4096u : command_ == kErase32 ? 32768u : 65536u);
        writable_ = false;
      }
      return 0xFF;
    case kWriteStatus1:
    case kWriteStatus2:
    case 0xFF:  // ends continuous read
      return 0xFF;
    default:
      if (place_ == 1) system_.report_unmodelled("flash chip", fmt::format("command 0x{:02x}", command_));
      return 0xFF;
  }
}

}  // namespace omnihil::mcu::rp2040
