// ICM-20689 inertial sensor on SPI; setting identity 18 makes it an ICM-20602. What it is:
// invensense_registers.h.
#include <memory>

#include "firmware_iface/mcu/devices/invensense_registers.h"

namespace omnihil::mcu {
namespace {
class Icm20689 final : public Device, public SpiDevice {
 public:
  explicit Icm20689(const DeviceWorld& world)
      : registers_(world, static_cast<std::uint8_t>(world.setting("identity", 0x98)), 0x40) {}
  void reset() override { registers_.reset(); }
  SpiDevice* spi() override { return this; }
  void select(bool) override { first_ = true; }
  std::uint8_t exchange(std::uint8_t from_master) override {
    if (first_) {
      first_ = false;
      reading_ = (from_master & 0x80) != 0;
      pointer_ = from_master & 0x7F;
      if (reading_) registers_.begin();
      return 0;
    }
    if (reading_) return registers_.read(pointer_++);
    registers_.write(pointer_++, from_master);
    return 0;
  }

 private:
  InvensenseRegisters registers_;
  std::uint8_t pointer_ = 0;
  bool first_ = true, reading_ = false;
};
}  // namespace

const DeviceKind& device_icm20689() {
  static const DeviceKind kind{
      "icm20689",
      "ICM-20689 (ICM-20602) inertial sensor on SPI",
      {"identity", "direction"},
      [](const DeviceWorld& world) -> std::unique_ptr<Device> { return std::make_unique<Icm20689>(world); }};
  return kind;
}

}  // namespace omnihil::mcu
