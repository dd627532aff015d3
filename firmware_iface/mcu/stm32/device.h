// Chips around the microcontroller: what they see of its buses and pins, and the list of kinds there are.
//
//   const DeviceKind* kind = find_device("nrf24l01");
//   std::unique_ptr<Device> radio = kind->make(world);
//   spi.connect(*radio->spi());
//
// Adding one is adding a file to firmware_iface/mcu/devices/ that defines `const DeviceKind& device_STEM()`.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/sd_bus.h"

namespace omnihil::mcu {

class SpiDevice {
 public:
  virtual ~SpiDevice() = default;
  virtual void select(bool selected) = 0;  // chip select, true: active
  virtual std::uint8_t exchange(std::uint8_t from_master) = 0;
};

class I2cDevice {
 public:
  virtual ~I2cDevice() = default;
  virtual std::uint8_t address() const = 0;  // 7 bits
  virtual void start(bool read) = 0;
  virtual bool write(std::uint8_t byte) = 0;  // acknowledged?
  virtual std::uint8_t read() = 0;
};

inline constexpr std::int64_t kNoWake = -1;

// What a device may ask of the world: all as functions of time, answered for the instant asked for.
struct DeviceWorld {
  std::function<std::int64_t()> now_ns = [] { return std::int64_t{0}; };
  std::function<double(std::int64_t at_ns)> angle_rad;      // of the shaft that it sits on
  std::function<double(std::int64_t at_ns)> bus_voltage_V;  // of the battery
  std::function<double(std::int64_t at_ns)> bus_current_A;
  std::function<double(std::int64_t at_ns)> motor_current_A;  // of the wheel that it is for
  std::function<double(std::int64_t at_ns)> gyro_z_rad_s;
  std::function<double(std::int64_t at_ns)> accel_x_m_s2, accel_y_m_s2;
  // Calls the device's woken() at that instant; the last call counts, and kNoWake takes it back.
  std::function<void(std::int64_t at_ns)> wake_at = [](std::int64_t) {};
  CardImage card;                                       // of a memory card
  std::map<std::string, double, std::less<>> settings;  // from the board file: address, shunt_ohm, …

  double setting(std::string_view name, double otherwise) const {
    const auto at = settings.find(name);
    return at == settings.end() ? otherwise : at->second;
  }
};

class Device {
 public:
  virtual ~Device() = default;
  virtual void reset() = 0;
  virtual SpiDevice* spi() { return nullptr; }
  virtual I2cDevice* i2c() { return nullptr; }
  virtual SdDevice* sd() { return nullptr; }
  // Of a memory card: blocks that are no longer what its image has.
  virtual const CardBlocks* changed_blocks() const { return nullptr; }
  // Pins by name: inputs that the board's wires change, outputs that it listens to.
  virtual std::span<const std::string_view> inputs() const { return {}; }
  virtual void input(std::string_view, bool) {}
  virtual std::span<const std::string_view> outputs() const { return {}; }
  void on_output(std::function<void(std::string_view pin, bool level)> listener) {
    on_output_ = std::move(listener);
  }
  // The instant that it had asked for has come.
  virtual void woken() {}
  // A step of the plant has begun: currents and voltage are new ones.
  virtual void world_changed() {}
  // Gate drivers: whether they let their bridge's switches follow the timer.
  virtual bool gates_bridge() const { return false; }
  virtual bool drives_bridge() const { return true; }
  void on_bridge(std::function<void()> listener) { on_bridge_ = std::move(listener); }
  // Radios: packets from and to the air.
  virtual bool is_radio() const { return false; }
  virtual void air(std::span<const std::uint8_t>) {}
  virtual bool take_sent(std::vector<std::uint8_t>&) { return false; }

 protected:
  void output(std::string_view pin, bool level) const {
    if (on_output_) on_output_(pin, level);
  }
  void bridge_changed() const {
    if (on_bridge_) on_bridge_();
  }

 private:
  std::function<void(std::string_view, bool)> on_output_;
  std::function<void()> on_bridge_;
};

struct DeviceKind {
  std::string_view name;
  std::string_view what;                   // one line for people
  std::vector<std::string_view> settings;  // names it knows
  std::unique_ptr<Device> (*make)(const DeviceWorld& world);
};

std::span<const DeviceKind* const> all_devices();
const DeviceKind* find_device(std::string_view name);

}  // namespace omnihil::mcu
