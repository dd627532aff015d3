// INA219 battery monitor on I2C: bus voltage in 4 mV, shunt voltage in 10 uV (data sheet SBOS448G).
//
// Settings: address (64), shunt_ohm (0.1). Conversion is instantaneous: a read gives the voltage of that
// instant. Not modelled: averaging, gains of the shunt amplifier (320 mV always), triggered modes.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {
class Ina219 final : public Device, public I2cDevice {
 public:
  explicit Ina219(const DeviceWorld& world) : world_(world) { Ina219::reset(); }
  void reset() override {
    config_ = 0x399F;
    calibration_ = 0;
    pointer_ = 0;
  }
  I2cDevice* i2c() override { return this; }
  std::uint8_t address() const override { return static_cast<std::uint8_t>(world_.setting("address", 64.0)); }
  void start(bool) override { count_ = 0; }
  bool write(std::uint8_t byte) override {
    if (count_ == 0) pointer_ = byte;
    if (count_ == 1) written_ = static_cast<std::uint16_t>(byte << 8);
    if (count_ == 2) {
      written_ |= byte;
      if (pointer_ == 0 && (written_ & 0x8000) != 0) {
        reset();
      } else if (pointer_ == 0) {
        config_ = written_;
      } else if (pointer_ == 5) {
        calibration_ = written_ & 0xFFFE;
      }
    }
    ++count_;
    return true;
  }
  std::uint8_t read() override {
    if (count_ % 2 == 0) latched_ = value();
    return static_cast<std::uint8_t>(count_++ % 2 == 0 ? latched_ >> 8 : latched_);
  }

 private:
  std::int32_t shunt_10uV() const {
    const double current_A = world_.bus_current_A ? world_.bus_current_A(world_.now_ns()) : 0.0;
    return static_cast<std::int32_t>(
        std::clamp(std::round(current_A * world_.setting("shunt_ohm", 0.1) / 10e-6), -32000.0, 32000.0));
  }
  std::uint32_t bus_4mV() const {
    const double volts = world_.bus_voltage_V ? world_.bus_voltage_V(world_.now_ns()) : 0.0;
    return static_cast<std::uint32_t>(std::clamp(volts / 0.004, 0.0, 8191.0));
  }
  std::uint16_t value() const {
    const std::int32_t current = shunt_10uV() * calibration_ / 4096;  // §8.5.1
    switch (pointer_) {
      case 0:
        return config_;
      case 1:
        return static_cast<std::uint16_t>(shunt_10uV());
      case 2:
        return static_cast<std::uint16_t>(bus_4mV() << 3 | 2u);  // CNVR
      case 3:
        return static_cast<std::uint16_t>(std::abs(current) * static_cast<std::int64_t>(bus_4mV()) / 5000);
      case 4:
        return static_cast<std::uint16_t>(current);
      case 5:
        return calibration_;
      default:
        return 0;
    }
  }
  DeviceWorld world_;
  std::uint16_t config_ = 0x399F, calibration_ = 0, written_ = 0, latched_ = 0;
  std::uint8_t pointer_ = 0;
  unsigned count_ = 0;
};
}  // namespace

const DeviceKind& device_ina219() {
  static const DeviceKind kind{
      "ina219",
      "INA219 voltage and current monitor on I2C",
      {"address", "shunt_ohm"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Ina219>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
