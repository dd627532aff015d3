// A device alone: its world's numbers, time that a test sets, its pins as they are.
//
//   DeviceBench b("drv8323", {{"rds_on_ohm", 0.002}});
//   b.word(0x8000);                    // 16 bits by SPI, chip selected
//   b.run_for_ns(1'000'000);           // its alarms ring in time
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

struct DeviceBench {
  explicit DeviceBench(std::string_view kind, std::map<std::string, double, std::less<>> settings = {}) {
    DeviceWorld world;
    world.now_ns = [this] { return now_ns; };
    world.wake_at = [this](std::int64_t at_ns) { wake_ns = at_ns; };
    world.angle_rad = [this](std::int64_t) { return angle_rad; };
    world.bus_voltage_V = [this](std::int64_t) { return bus_voltage_V; };
    world.motor_current_A = [this](std::int64_t) { return motor_current_A; };
    world.gyro_z_rad_s = [this](std::int64_t) { return gyro_z_rad_s; };
    world.accel_x_m_s2 = [this](std::int64_t) { return accel_x_m_s2; };
    world.settings = std::move(settings);
    device = find_device(kind)->make(world);
    device->on_output([this](std::string_view pin, bool level) {
      if (level && !pins[std::string(pin)]) ++rises[std::string(pin)];
      pins[std::string(pin)] = level;
    });
    device->reset();
  }
  DeviceBench(const DeviceBench&) = delete;
  void run_for_ns(std::int64_t ns) {
    const std::int64_t end_ns = now_ns + ns;
    while (wake_ns != kNoWake && wake_ns <= end_ns) {
      now_ns = std::max(now_ns, wake_ns);
      wake_ns = kNoWake;
      device->woken();
    }
    now_ns = end_ns;
  }
  std::vector<std::uint8_t> transfer(const std::vector<std::uint8_t>& out) {
    std::vector<std::uint8_t> in;
    device->spi()->select(true);
    for (const std::uint8_t byte : out) in.push_back(device->spi()->exchange(byte));
    device->spi()->select(false);
    return in;
  }
  unsigned word(unsigned out) {
    const auto in = transfer({static_cast<std::uint8_t>(out >> 8), static_cast<std::uint8_t>(out)});
    return static_cast<unsigned>(in[0] << 8 | in[1]);
  }
  void step() { device->world_changed(); }

  std::int64_t now_ns = 0, wake_ns = kNoWake;
  double angle_rad = 0.0, bus_voltage_V = 24.0, motor_current_A = 0.0, gyro_z_rad_s = 0.0, accel_x_m_s2 = 0.0;
  std::map<std::string, bool> pins;
  std::map<std::string, int> rises;
  std::unique_ptr<Device> device;
};

}  // namespace omnihil::mcu
