// MPU-6050 inertial sensor on I2C. Settings: address (104), direction. What it is: invensense_registers.h.
#include <memory>

#include "firmware_iface/mcu/devices/invensense_registers.h"

namespace omnihil::mcu {
namespace {
class Mpu6050 final : public Device, public I2cDevice {
 public:
  explicit Mpu6050(const DeviceWorld& world)
      : registers_(world, 0x68, 0x40), address_(static_cast<std::uint8_t>(world.setting("address", 104.0))) {}
  void reset() override { registers_.reset(); }
  I2cDevice* i2c() override { return this; }
  std::uint8_t address() const override { return address_; }
  void start(bool read) override {
    pointing_ = !read;
    if (read) registers_.begin();
  }
  bool write(std::uint8_t byte) override {
    if (pointing_) {
      pointer_ = byte;
      pointing_ = false;
    } else {
      registers_.write(pointer_++, byte);
    }
    return true;
  }
  std::uint8_t read() override { return registers_.read(pointer_++); }

 private:
  InvensenseRegisters registers_;
  std::uint8_t address_, pointer_ = 0;
  bool pointing_ = false;
};
}  // namespace

const DeviceKind& device_mpu6050() {
  static const DeviceKind kind{
      "mpu6050",
      "MPU-6050 inertial sensor on I2C",
      {"address", "direction"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Mpu6050>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
