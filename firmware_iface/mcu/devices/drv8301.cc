// DRV8301 three-phase gate driver: registers of data sheet SLOS719, tables 8 to 13.
//
// A frame is a read bit, four bits of address and eleven of data; the answer, one frame late, has the address and the
// data of the last frame's register. Modelled: overcurrent with its four modes (limited: off until the next step of the
// plant; latched; reported; off), supply under 6 V, GATE_RESET and the enable pin as what clears a fault. Not modelled:
// gains of the amplifiers and their calibration, the buck converter, drive currents, over-temperature.
#include <limits>
#include <memory>

#include "firmware_iface/mcu/devices/gate_driver.h"

namespace omnihil::mcu {
namespace {
enum : unsigned { kStatus1 = 0, kStatus2 = 1, kControl1 = 2, kControl2 = 3 };
constexpr std::uint16_t kFault = 1u << 10, kPvddUv = 1u << 8, kHighA = 1u << 5, kGateReset = 1u << 2;
constexpr std::uint16_t kDevice = 1;  // status 2, bits 3 to 0

class Drv8301 final : public GateDriver {
 public:
  explicit Drv8301(const DeviceWorld& world) : GateDriver(world) { Drv8301::to_defaults(); }

 protected:
  std::uint16_t answer(unsigned) override { return next_; }
  void take(std::uint16_t frame) override {
    const unsigned address = frame >> 11 & 0xFu;
    const bool read = (frame >> 15 & 1u) != 0;
    const bool there = address < registers_.size();
    if (!read && there && address >= kControl1) {
      registers_[address] = static_cast<std::uint16_t>(frame & (address == kControl1 ? 0x7FFu : 0x7Fu));
      if (address == kControl1 && (frame & kGateReset) != 0) {
        registers_[kControl1] &= static_cast<std::uint16_t>(~kGateReset);
        registers_[kStatus1] = 0;
        latched_ = false;
        world_changed();
      }
    }
    next_ = static_cast<std::uint16_t>(address << 11 | (there ? registers_[address] : 0u));
    settle();
  }
  void to_defaults() override {
    registers_ = {0, kDevice, 0, 0};
    next_ = 0;
    latched_ = false;
  }
  double overcurrent_V() const override {
    constexpr double kLevels_V[] = {0.060, 0.068, 0.076, 0.086, 0.097, 0.109, 0.123, 0.138,
                                    0.155, 0.175, 0.197, 0.222, 0.250, 0.282, 0.317, 0.358,
                                    0.403, 0.454, 0.511, 0.576, 0.648, 0.730, 0.822, 0.926,
                                    1.043, 1.175, 1.324, 1.491, 1.679, 1.892, 2.131, 2.400};
    return mode() == 3 ? std::numeric_limits<double>::infinity()
                       : kLevels_V[registers_[kControl1] >> 6 & 31u];
  }
  double undervoltage_V() const override { return 6.0; }
  void overcurrent() override {
    registers_[kStatus1] |= kFault | kHighA;
    if (mode() == 1) latched_ = true;
    if (mode() == 0) off_for(64'000);  // OC_TOFF: 64 PWM periods or the cycle; taken as 64 us
  }
  void undervoltage() override { registers_[kStatus1] |= kFault | kPvddUv; }
  bool faulty() const override { return (registers_[kStatus1] & kFault) != 0; }
  bool held_off() const override { return latched_; }

 private:
  unsigned mode() const { return registers_[kControl1] >> 4 & 3u; }
  std::array<std::uint16_t, 4> registers_{};
  std::uint16_t next_ = 0;
  bool latched_ = false;
};
}  // namespace

const DeviceKind& device_drv8301() {
  static const DeviceKind kind{
      "drv8301",
      "DRV8301 three-phase gate driver on SPI, pins enable and fault",
      {"rds_on_ohm"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Drv8301>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
