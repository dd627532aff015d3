// MA7xx magnetic angle sensor (MA702, MA730, MA732) on SPI: the 16-bit angle word and the registers (data sheet MA730
// rev. 1.01, "SPI communication").
//
// Any frame of 16 bits gives the angle, taken as the chip is selected; a frame that begins with 010 asks for a register,
// one with 100 writes it, and the frame after gives the register in its high byte. Settings: direction (1 or -1),
// offset_rad, bits (14: what of the word is resolved; the rest is 0). Modelled: zero setting, rotation direction, magnet
// flags. Not modelled: filter and its delay, other outputs (ABZ, PWM), time of storing.
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
enum : unsigned { kZeroLow = 0, kZeroHigh = 1, kDirection = 9, kMagnet = 27 };

class Ma7xx final : public Device, public SpiDevice {
 public:
  explicit Ma7xx(const DeviceWorld& world) : world_(world) {}
  void reset() override { asked_ = -1; }  // its settings are stored in the chip
  SpiDevice* spi() override { return this; }
  void select(bool selected) override {
    if (!selected) {
      finish();
      return;
    }
    bytes_ = 0;
    frame_ = 0;
    word_ =
        asked_ < 0 ? angle() : static_cast<std::uint16_t>(registers_[static_cast<std::size_t>(asked_)] << 8);
    asked_ = -1;
  }
  std::uint8_t exchange(std::uint8_t from_master) override {
    frame_ = static_cast<std::uint16_t>(frame_ << 8 | from_master);
    const unsigned at = bytes_++;
    if (at > 1) return 0;
    return static_cast<std::uint8_t>(at == 0 ? word_ >> 8 : word_);
  }

 private:
  void finish() {
    if (bytes_ != 2) return;
    const unsigned command = frame_ >> 13, address = frame_ >> 8 & 0x1Fu;
    if (command == 4 && address != kMagnet) registers_[address] = static_cast<std::uint8_t>(frame_);
    if (command == 4 || command == 2) asked_ = static_cast<int>(address);
  }
  // Turned round first, then less the zero.
  std::uint16_t angle() const {
    constexpr double kTwoPi = 6.283185307179586;
    const double shaft = world_.angle_rad ? world_.angle_rad(world_.now_ns()) : 0.0;
    double turns = (world_.setting("direction", 1.0) * shaft + world_.setting("offset_rad", 0.0)) / kTwoPi;
    if ((registers_[kDirection] & 0x80u) != 0) turns = -turns;
    const auto bits = static_cast<unsigned>(world_.setting("bits", 14.0));
    const double steps = std::ldexp(1.0, static_cast<int>(bits));
    const auto raw = static_cast<unsigned>((turns - std::floor(turns)) * steps) << (16 - bits);
    return static_cast<std::uint16_t>(raw - (registers_[kZeroHigh] << 8u | registers_[kZeroLow]));
  }

  DeviceWorld world_;
  std::array<std::uint8_t, 32> registers_{};  // magnet flags 0: neither too weak nor too strong
  int asked_ = -1;
  unsigned bytes_ = 0;
  std::uint16_t frame_ = 0, word_ = 0;
};
}  // namespace

const DeviceKind& device_ma7xx() {
  static const DeviceKind kind{
      "ma7xx",
      "MA702, MA730, MA732 angle sensor on SPI, 16-bit words",
      {"direction", "offset_rad", "bits"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Ma7xx>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
