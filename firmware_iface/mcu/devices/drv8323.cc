// DRV8323 (DRV8320) three-phase gate driver: registers of data sheet SLVSDJ3, tables 11 to 18.
//
// A frame is a read bit, four bits of address and eleven of data; the answer has the addressed register as it was before
// the frame, below five zeros. Modelled: coast bit, overcurrent with its four modes (latched, retried after 4 ms or 50 us,
// reported, off), supply under 5.8 V, lock of the registers, CLR_FLT. Not modelled: what the PWM mode makes of the inputs
// (the board file's motor says that), brake bit, drive currents, dead time, gain and offset of the current amplifiers.
#include <limits>
#include <memory>

#include "firmware_iface/mcu/devices/gate_driver.h"

namespace omnihil::mcu {
namespace {
enum : unsigned {
  kFaults = 0,
  kFaults2 = 1,
  kControl = 2,
  kHighSide = 3,
  kLowSide = 4,
  kOvercurrent = 5,
  kAmplifier = 6
};
constexpr std::uint16_t kFault = 1u << 10, kVdsOcp = 1u << 9, kUvlo = 1u << 7, kVdsHa = 1u << 5;
constexpr std::uint16_t kCoast = 1u << 2, kClearFaults = 1u << 0;

class Drv8323 final : public GateDriver {
 public:
  explicit Drv8323(const DeviceWorld& world) : GateDriver(world) { Drv8323::to_defaults(); }

 protected:
  std::uint16_t answer(unsigned header) override {
    const unsigned address = header & 0xFu;
    return address < registers_.size() ? registers_[address] : std::uint16_t{0};
  }
  void take(std::uint16_t frame) override {
    const unsigned address = frame >> 11 & 0xFu;
    const bool read = (frame >> 15 & 1u) != 0;
    if (read || address < kControl || address >= registers_.size()) return;
    std::uint16_t& at = registers_[address];
    const auto data = static_cast<std::uint16_t>(frame & 0x7FFu);
    const unsigned lock = data >> 8;
    if (!locked_) {
      at = data;
    } else if (address == kControl) {
      at = static_cast<std::uint16_t>((at & ~7u) | (data & 7u));
    }
    if (address == kHighSide && lock == 6) locked_ = true;
    if (address == kHighSide && lock == 3) locked_ = false;
    if (address == kControl && (data & kClearFaults) != 0) {
      at &= static_cast<std::uint16_t>(~kClearFaults);
      registers_[kFaults] = registers_[kFaults2] = 0;
      latched_ = false;
      world_changed();  // what has not gone is there again
    }
    settle();
  }
  void to_defaults() override {
    registers_ = {0, 0, 0, 0x3FF, 0x7FF, 0x159, 0x283};
    locked_ = latched_ = false;
  }
  double overcurrent_V() const override {
    constexpr double kLevels_V[] = {0.06, 0.13, 0.20, 0.26, 0.31, 0.45, 0.53, 0.60,
                                    0.68, 0.75, 0.94, 1.13, 1.30, 1.50, 1.70, 1.88};
    return mode() == 3 ? std::numeric_limits<double>::infinity() : kLevels_V[registers_[kOvercurrent] & 0xFu];
  }
  double undervoltage_V() const override { return 5.8; }
  void overcurrent() override {
    registers_[kFaults] |= kFault | kVdsOcp | kVdsHa;
    if (mode() == 0) latched_ = true;
    if (mode() == 1) off_for((registers_[kOvercurrent] >> 10 & 1u) != 0 ? 50'000 : 4'000'000);
  }
  void retried() override { registers_[kFaults] = 0; }
  void undervoltage() override { registers_[kFaults] |= kFault | kUvlo; }
  bool faulty() const override { return (registers_[kFaults] & kFault) != 0; }
  bool held_off() const override { return latched_ || (registers_[kControl] & kCoast) != 0; }

 private:
  unsigned mode() const { return registers_[kOvercurrent] >> 6 & 3u; }
  std::array<std::uint16_t, 7> registers_{};
  bool locked_ = false, latched_ = false;
};
}  // namespace

const DeviceKind& device_drv8323() {
  static const DeviceKind kind{
      "drv8323",
      "DRV8323 three-phase gate driver on SPI, pins enable and fault",
      {"rds_on_ohm"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Drv8323>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
