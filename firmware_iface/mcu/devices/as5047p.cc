// AS5047P magnetic angle sensor on SPI: 14-bit angle of the shaft it sits on (data sheet v1-03).
//
// Frames of 16 bits; what a frame asks for comes with the next one, sampled when that one begins. Settings:
// direction (1 or -1), offset_rad. Not modelled: propagation delay (100 us class, compensated by the chip),
// noise, non-linearity (the AGC and magnitude registers are constant), programming of the zero position.
#include <bit>
#include <cmath>
#include <memory>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kNop = 0,
  kErrfl = 1,
  kDiaagc = 0x3FFC,
  kMag = 0x3FFD,
  kAngleunc = 0x3FFE,
  kAnglecom = 0x3FFF
};

class As5047p final : public Device, public SpiDevice {
 public:
  explicit As5047p(const DeviceWorld& world) : world_(world) {}
  void reset() override {
    asked_ = kNop;
    errors_ = 0;
  }
  SpiDevice* spi() override { return this; }
  void select(bool selected) override {
    if (!selected) return;
    high_ = true;
    answer_ = frame(value(asked_));
  }
  std::uint8_t exchange(std::uint8_t from_master) override {
    if (high_) {
      command_ = static_cast<std::uint16_t>(from_master << 8);
      high_ = false;
      return static_cast<std::uint8_t>(answer_ >> 8);
    }
    command_ |= from_master;
    const auto out = static_cast<std::uint8_t>(answer_);
    take(command_);
    answer_ = frame(value(asked_));  // for masters that hold the chip select over several frames
    high_ = true;
    return out;
  }

 private:
  void take(std::uint16_t command) {
    if (std::popcount(command) % 2 != 0) {
      errors_ |= 4;  // PARERR
      asked_ = kNop;
      return;
    }
    asked_ = (command & 0x4000) != 0 ? command & 0x3FFF : kNop;
    read_error_ = asked_ == kErrfl;
  }
  std::uint16_t value(std::uint16_t which) {
    switch (which) {
      case kAnglecom:
      case kAngleunc: {
        constexpr double kTwoPi = 6.283185307179586;
        const double angle = world_.angle_rad ? world_.angle_rad(world_.now_ns()) : 0.0;
        const double turns =
            (world_.setting("direction", 1.0) * angle + world_.setting("offset_rad", 0.0)) / kTwoPi;
        return static_cast<std::uint16_t>(static_cast<std::uint32_t>((turns - std::floor(turns)) * 16384.0) &
                                          0x3FFFu);
      }
      case kMag:
        return 0x0FA0;
      case kDiaagc:
        return 0x0180;
      case kErrfl: {
        const std::uint16_t errors = errors_;
        if (read_error_) errors_ = 0;
        return errors;
      }
      default:
        return 0;
    }
  }
  // Even parity over the frame; bit 14 tells of an error.
  std::uint16_t frame(std::uint16_t data) const {
    auto out = static_cast<std::uint16_t>((data & 0x3FFF) | (errors_ != 0 ? 0x4000 : 0));
    if (std::popcount(out) % 2 != 0) out |= 0x8000;
    return out;
  }
  DeviceWorld world_;
  std::uint16_t asked_ = kNop, command_ = 0, answer_ = 0, errors_ = 0;
  bool high_ = true, read_error_ = false;
};
}  // namespace

const DeviceKind& device_as5047p() {
  static const DeviceKind kind{
      "as5047p",
      "AS5047P angle sensor on SPI, 14 bits",
      {"direction", "offset_rad"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<As5047p>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
