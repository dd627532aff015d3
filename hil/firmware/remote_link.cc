#include "hil/firmware/remote_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/loop/clock.h"

namespace omnihil {
namespace {

constexpr std::int64_t kHelloEvery_ns = 200'000'000, kHelloPatience_ns = 3'000'000'000;
constexpr std::size_t kHelloBytes = 56, kSensorsBytes = 37, kCommandBytes = 68, kDriveBytes = 18;
constexpr std::size_t kMaxRadioFrames = 64;
constexpr std::size_t kBite_bytes = 1024;

// Rounded and held to what the field holds; a sensor at its end of scale.
std::int16_t to_i16(double value) {
  return std::isfinite(value) ? static_cast<std::int16_t>(std::clamp(std::round(value), -32768.0, 32767.0))
                              : std::int16_t{0};
}

class Packer {
 public:
  explicit Packer(std::span<std::uint8_t> out) : out_(out) {}
  Packer& u8(std::uint32_t value) {
    out_[at_++] = static_cast<std::uint8_t>(value);
    return *this;
  }
  Packer& i16(double value) {
    omnihil_put_u16(&out_[at_], static_cast<std::uint16_t>(to_i16(value)));
    at_ += 2;
    return *this;
  }
  Packer& u16(double value) {
    omnihil_put_u16(&out_[at_], static_cast<std::uint16_t>(std::clamp(std::round(value), 0.0, 65535.0)));
    at_ += 2;
    return *this;
  }
  Packer& u32(std::uint64_t value) {
    omnihil_put_u32(&out_[at_], static_cast<std::uint32_t>(value));
    at_ += 4;
    return *this;
  }
  Packer& f32(double value) {
    omnihil_put_f32(&out_[at_], static_cast<float>(value));
    at_ += 4;
    return *this;
  }
  Packer& four(const double (&values)[kWheels]) {
    for (const double value : values) f32(value);
    return *this;
  }

 private:
  std::span<std::uint8_t> out_;
  std::size_t at_ = 0;
};

}  // namespace

void RemoteLink::send(std::uint8_t type, std::uint16_t sequence, std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, OMNIHIL_REMOTE_WIRE_MAX> wire{};
  const std::size_t n = omnihil_remote_encode(type, sequence, payload.data(), payload.size(), wire.data());
  if (n == 0 || !line_.write(std::span(wire).first(n))) ++counts_.line_full;
}

bool RemoteLink::hello(const RobotConfig& config, RemoteHello& answer, std::string& problem) {
  std::array<std::uint8_t, kHelloBytes> p{};
  Packer pack(p);
  pack.u8(OMNIHIL_REMOTE_VERSION).u8(kWheels).u16(0).u32(config.robot_id).four(config.wheel_angle_rad);
  pack.f32(config.wheel_radius_m).f32(config.wheel_center_radius_m).f32(config.gear_ratio);
  pack.f32(config.encoder_counts_per_rotor_turn).f32(config.bus_voltage_nominal_V);
  pack.f32(config.motor_resistance_ohm)
      .f32(config.motor_torque_constant_Nm_per_A)
      .f32(config.command_timeout_s);
  const std::uint8_t clear_line[] = {0, 0};
  line_.write(clear_line);
  const std::int64_t start_ns = monotonic_now_ns();
  std::int64_t next_ns = start_ns;
  std::uint16_t tries = 0;
  while (!greeted_ && failure().empty() && monotonic_now_ns() - start_ns < kHelloPatience_ns) {
    if (monotonic_now_ns() >= next_ns) {
      send(OMNIHIL_REMOTE_HELLO, tries++, p);
      next_ns += kHelloEvery_ns;
    }
    line_.wait(10'000'000);
    poll();
  }
  answer = hello_;
  counts_.line_full = 0;
  if (greeted_) return true;
  problem = !failure().empty()
                ? std::string(failure())
                : fmt::format(
                      "the board does not answer ({} hellos in {} s; {} good frames came, {} with a bad "
                      "checksum, {} otherwise unreadable)",
                      tries, kHelloPatience_ns / 1'000'000'000, decoder_.good, decoder_.bad_crc,
                      decoder_.bad_cobs + decoder_.too_long + decoder_.too_short);
  return false;
}

void RemoteLink::send_sensors(const RobotSensors& s) {
  std::array<std::uint8_t, kSensorsBytes> p{};
  Packer pack(p);
  pack.u32(s.now_us);
  for (const std::int64_t counts : s.encoder_counts) pack.u32(static_cast<std::uint64_t>(counts));
  for (const double current_A : s.motor_current_A) pack.i16(1000.0 * current_A);
  pack.u16(1000.0 * s.bus_voltage_V).i16(1000.0 * s.gyro_z_rad_s);
  pack.i16(1000.0 * s.accel_x_m_s2).i16(1000.0 * s.accel_y_m_s2).u8(s.ball_seen);
  const std::uint64_t number = ++counts_.sensors_sent;
  sent_ns_[number % kWindow] = monotonic_now_ns();
  send(OMNIHIL_REMOTE_SENSORS, static_cast<std::uint16_t>(number), p);
}

void RemoteLink::send_command(const RobotCommand& c) {
  std::array<std::uint8_t, kCommandBytes> p{};
  Packer pack(p);
  pack.u8(c.mode).u8(c.flags).u8(c.kick).u8(c.kick_when);
  pack.f32(c.v_forward_m_s).f32(c.v_left_m_s).f32(c.omega_body_rad_s);
  pack.four(c.omega_wheel_rad_s).four(c.duty_ratio);
  pack.f32(c.yaw_target_rad)
      .f32(c.camera_yaw_rad)
      .f32(c.v_kick_m_s)
      .f32(c.kick_pulse_s)
      .f32(c.dribbler_ratio);
  send(OMNIHIL_REMOTE_COMMAND, static_cast<std::uint16_t>(counts_.sensors_sent), p);
}

void RemoteLink::send_radio(std::span<const std::uint8_t> frame) {
  send(OMNIHIL_REMOTE_RADIO, static_cast<std::uint16_t>(counts_.sensors_sent), frame);
}

void RemoteLink::poll() {
  do {
    bytes_.clear();
    line_.read(bytes_, kBite_bytes);
    for (const std::uint8_t byte : bytes_) {
      omnihil_remote_frame frame{};
      if (omnihil_remote_decode(&decoder_, byte, &frame) != 0) take(frame);
    }
  } while (bytes_.size() == kBite_bytes);
}

void RemoteLink::take(const omnihil_remote_frame& frame) {
  switch (frame.type) {
    case OMNIHIL_REMOTE_HELLO_ANSWER:
      return take_hello(frame);
    case OMNIHIL_REMOTE_DRIVE:
      return take_drive(frame);
    case OMNIHIL_REMOTE_RADIO_OUT:
      if (radio_.size() < kMaxRadioFrames) radio_.emplace_back(frame.payload, frame.payload + frame.bytes);
      return;
    default:
      ++counts_.unknown_type;
  }
}

// 0 version, 1 wheels, 2 u16 control period in us, then two texts that end in 0.
void RemoteLink::take_hello(const omnihil_remote_frame& f) {
  const auto* text = reinterpret_cast<const char*>(f.payload);
  if (f.bytes < 6 || f.payload[0] != OMNIHIL_REMOTE_VERSION || f.payload[1] != kWheels ||
      text[f.bytes - 1] != 0) {
    ++counts_.bad_payload;
    return;
  }
  hello_.control_period_ns = std::int64_t{1000} * omnihil_get_u16(f.payload + 2);
  hello_.name = text + 4;
  const std::size_t radio_at = 4 + hello_.name.size() + 1;
  hello_.radio_format = radio_at < f.bytes ? text + radio_at : "";
  greeted_ = true;
}

// 0 four modes, 4 four i16 duties of 1/32767, 12 flags, 13 dribbler /255, 14 u16 kick us, 16 u16 board us.
void RemoteLink::take_drive(const omnihil_remote_frame& f) {
  bool good = f.bytes == kDriveBytes;
  for (int i = 0; good && i < kWheels; ++i) good = f.payload[i] <= OMNIHIL_DRIVE_DUTY;
  if (!good) {
    ++counts_.bad_payload;
    return;
  }
  // The full number of the sensors that it answers: the newest with these low 16 bits.
  const std::uint64_t newest = counts_.sensors_sent;
  const std::uint64_t behind = (newest - f.sequence) & 0xFFFFU;
  if (behind >= kWindow || behind >= newest || sent_ns_[(newest - behind) % kWindow] == 0 ||
      newest - behind <= drive_answers_) {
    ++counts_.out_of_order;
    return;
  }
  const std::uint64_t number = newest - behind;
  drive_at_ns_ = monotonic_now_ns();
  round_trip_.add(drive_at_ns_ - sent_ns_[number % kWindow]);
  sent_ns_[number % kWindow] = 0;
  const std::uint16_t took_us = omnihil_get_u16(f.payload + 16);
  if (took_us > 0) board_time_.add(std::int64_t{1000} * took_us);
  drive_answers_ = number;
  ++counts_.drives;
  for (int i = 0; i < kWheels; ++i) {
    drive_.mode[i] = f.payload[i];
    const auto duty = static_cast<std::int16_t>(omnihil_get_u16(f.payload + 4 + 2 * i));
    drive_.duty_ratio[i] = std::max(-1.0, duty / 32767.0);
  }
  drive_.charge = f.payload[12] & 1U;
  drive_.kick = f.payload[12] >> 1 & 3U;
  drive_.dribbler_ratio = f.payload[13] / 255.0;
  drive_.kick_pulse_s = 1e-6 * omnihil_get_u16(f.payload + 14);
}

}  // namespace omnihil
