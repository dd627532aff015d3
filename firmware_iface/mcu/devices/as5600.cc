// AS5600 magnetic angle sensor on I2C: 12-bit angle of the shaft it sits on (data sheet v1-06).
//
// Address 0x36. RAW ANGLE is the shaft's, ANGLE that less the start position ZPOS; the high byte latches the low one, and
// after the low one the pointer is back at the high one. Settings: direction (1 or -1), offset_rad. Not modelled: a range
// that ends before a turn (MPOS, MANG are kept), filters and hysteresis of CONF, the analog and PWM output, burning.
#include <array>
#include <cmath>
#include <memory>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
class As5600 final : public Device, public I2cDevice {
 public:
  explicit As5600(const DeviceWorld& world) : world_(world) {}
  void reset() override {
    settings_.fill(0);
    pointer_ = 0;
  }
  I2cDevice* i2c() override { return this; }
  std::uint8_t address() const override { return 0x36; }
  void start(bool reading) override { pointed_ = reading; }
  bool write(std::uint8_t byte) override {
    if (!pointed_) {
      pointer_ = byte;
      pointed_ = true;
    } else {
      if (pointer_ >= kZpos && pointer_ < settings_.size()) settings_[pointer_] = byte;
      ++pointer_;
    }
    return true;
  }
  std::uint8_t read() override {
    const std::uint8_t at = pointer_++;
    switch (at) {
      case kStatus:
        return 0x20;  // MD: a magnet is there, neither too weak nor too strong
      case kRawAngle:
        return high(raw());
      case kAngle:
        return high((raw() - zero()) & 0xFFFu);
      case kMagnitude:
        return high(0x7D0);
      case kRawAngle + 1:
      case kAngle + 1:
      case kMagnitude + 1:
        pointer_ = static_cast<std::uint8_t>(at - 1);
        return low_;
      case kAgc:
        return 0x80;
      default:
        return at < settings_.size() ? settings_[at] : std::uint8_t{0};
    }
  }

 private:
  enum : std::uint8_t {
    kZpos = 0x01,
    kStatus = 0x0B,
    kRawAngle = 0x0C,
    kAngle = 0x0E,
    kAgc = 0x1A,
    kMagnitude = 0x1B
  };
  std::uint8_t high(unsigned word) {
    low_ = static_cast<std::uint8_t>(word);
    return static_cast<std::uint8_t>(word >> 8);
  }
  unsigned zero() const { return (settings_[kZpos] << 8u | settings_[kZpos + 1]) & 0xFFFu; }
  unsigned raw() const {
    constexpr double kTwoPi = 6.283185307179586;
    const double angle = world_.angle_rad ? world_.angle_rad(world_.now_ns()) : 0.0;
    const double turns =
        (world_.setting("direction", 1.0) * angle + world_.setting("offset_rad", 0.0)) / kTwoPi;
    return static_cast<unsigned>((turns - std::floor(turns)) * 4096.0) & 0xFFFu;
  }
  DeviceWorld world_;
  std::array<std::uint8_t, 9> settings_{};  // ZMCO, ZPOS, MPOS, MANG, CONF at 0 to 8
  std::uint8_t pointer_ = 0, low_ = 0;
  bool pointed_ = false;
};
}  // namespace

const DeviceKind& device_as5600() {
  static const DeviceKind kind{
      "as5600",
      "AS5600 angle sensor on I2C, 12 bits",
      {"direction", "offset_rad"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<As5600>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
