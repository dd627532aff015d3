// The register map that InvenSense's six-axis sensors share: settings kept, data evaluated when they are
// read.
//
//   InvensenseRegisters registers(world, 0x98, 0x40);  // WHO_AM_I, PWR_MGMT_1
//   registers.read(0x47);                              // high byte of the gyroscope's z axis
//
// Source: register maps of MPU-6050 (RM-MPU-6000A-00) and ICM-20689 (RM-000030). Sixteen-bit data, full
// scales of GYRO_CONFIG and ACCEL_CONFIG. z is up, gravity on it. A burst reads data of one instant (of its
// first byte). Settings: direction (of z: 1 or -1). Not modelled: FIFO, interrupts, filters, self test, x and
// y rates (zero), noise.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

class InvensenseRegisters {
 public:
  InvensenseRegisters(const DeviceWorld& world, std::uint8_t identity, std::uint8_t power)
      : world_(world), identity_(identity), power_(power) {
    reset();
  }
  void reset() {
    kept_.fill(0);
    kept_[kPower] = power_;
  }
  void begin() { latch(); }
  std::uint8_t read(std::uint8_t which) {
    if (which == 0x75) return identity_;
    if (which == 0x3A) return 1;  // data ready
    if (which >= 0x3B && which <= 0x48) {
      const std::uint16_t word = data_[(which - 0x3B) / 2u];
      return static_cast<std::uint8_t>((which - 0x3B) % 2 == 0 ? word >> 8 : word);
    }
    return kept_[which & 0x7F];
  }
  void write(std::uint8_t which, std::uint8_t byte) {
    if ((which & 0x7F) == kPower && (byte & 0x80) != 0) return reset();
    kept_[which & 0x7F] = byte;
  }

 private:
  static constexpr std::uint8_t kPower = 0x6B;
  static std::uint16_t code(double value, double full_scale) {
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::clamp(std::round(value / full_scale * 32768.0), -32768.0, 32767.0)));
  }
  void latch() {
    constexpr double kGravity_m_s2 = 9.80665, kDegrees = 57.29577951308232;
    const std::int64_t at = world_.now_ns();
    const double direction = world_.setting("direction", 1.0);
    const double gyro_full = 250.0 * (1u << (kept_[0x1B] >> 3 & 3));  // degrees per second
    const double accel_full = 2.0 * (1u << (kept_[0x1C] >> 3 & 3));   // g
    data_.fill(0);
    if (world_.accel_x_m_s2) data_[0] = code(world_.accel_x_m_s2(at) / kGravity_m_s2, accel_full);
    if (world_.accel_y_m_s2) data_[1] = code(direction * world_.accel_y_m_s2(at) / kGravity_m_s2, accel_full);
    data_[2] = code(direction, accel_full);
    data_[3] = static_cast<std::uint16_t>(static_cast<std::int16_t>(-3920));  // 25 degC of an MPU-6050
    if (world_.gyro_z_rad_s) data_[6] = code(direction * world_.gyro_z_rad_s(at) * kDegrees, gyro_full);
  }
  DeviceWorld world_;
  std::uint8_t identity_, power_;
  std::array<std::uint8_t, 128> kept_{};
  std::array<std::uint16_t, 7> data_{};  // accelerometer x y z, temperature, gyroscope x y z
};

}  // namespace omnihil::mcu
