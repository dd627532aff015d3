#include "firmware_iface/mcu/board/mcu_firmware.h"

#include <fmt/format.h>

#include <algorithm>

namespace omnihil::mcu {

McuFirmware::McuFirmware(const BoardSpec& spec, const ElfImage& image, const RobotConfig& config)
    : name_(fmt::format("image on {} ({})", spec.name, spec.chip->name)),
      config_(config),
      board_(spec, image) {
  for (const PinEntry& entry : spec.pins) {  // the switches that say which robot this is
    if (entry.robot_id_bit < 0) continue;
    const bool level = (config.robot_id >> entry.robot_id_bit & 1u) != 0;
    board_.chip().port(entry.pin.port)->drive(entry.pin.pin, level);
  }
  for (const MotorEntry& motor : spec.motors) phases_ = phases_ || motor.pwm.size() == 3;
  world_.gear_ratio = config.gear_ratio;
  world_.encoder_counts_per_rotor_turn = config.encoder_counts_per_rotor_turn;
  world_.bus_voltage_V = config.bus_voltage_nominal_V;
}

void McuFirmware::radio_receive(std::span<const std::uint8_t> frame, std::int64_t) {
  board_.radio_receive(frame);
}

std::size_t McuFirmware::radio_transmit(std::span<std::uint8_t> out) {
  std::vector<std::uint8_t> frame;
  if (!board_.radio_transmit(frame)) return 0;
  const std::size_t n = std::min(frame.size(), out.size());
  std::copy_n(frame.begin(), n, out.begin());
  return n;
}

// The world at this tick. Where the sensed count differs from the exact one (an effect of the model), the
// image sees the sensed one.
void McuFirmware::look(const RobotSensors& sensors) {
  constexpr double kTwoPi = 6.283185307179586;
  const auto now_ns = static_cast<std::int64_t>(sensors.now_us) * 1000;
  world_.at_ns = now_ns;
  for (std::size_t w = 0; w < kWheels; ++w) {
    world_.theta_rotor_rad[w] = exact_.theta_rotor_rad[w];
    world_.omega_rotor_rad_s[w] = exact_.omega_rotor_rad_s[w];
    world_.motor_current_A[w] = sensors.motor_current_A[w];
    const std::int64_t off =
        sensors.encoder_counts[w] - world_.encoder_counts(static_cast<int>(w), world_.at_ns);
    const double per_count_rad = kTwoPi / config_.encoder_counts_per_rotor_turn;
    if (off > 1 || off < -1) world_.theta_rotor_rad[w] += static_cast<double>(off) * per_count_rad;
  }
  world_.bus_voltage_V = sensors.bus_voltage_V;
  world_.gyro_z_rad_s = sensors.gyro_z_rad_s;
  world_.accel_x_m_s2 = sensors.accel_x_m_s2;
  world_.accel_y_m_s2 = sensors.accel_y_m_s2;
  board_.set_world(world_);
}

RobotDrive McuFirmware::tick(const RobotSensors& sensors) {
  look(sensors);
  RobotDrive drive{};
  feedback_ = {};
  feedback_.now_us = sensors.now_us;
  feedback_.battery_V = sensors.bus_voltage_V;
  for (std::size_t w = 0; w < kWheels; ++w) {
    feedback_.omega_wheel_rad_s[w] = exact_.omega_rotor_rad_s[w] / config_.gear_ratio;
  }
  if (phases_) {  // the image runs on from PWM period to PWM period
    for (std::size_t w = 0; w < kWheels; ++w) {
      if (board_.wire(static_cast<int>(w)) != nullptr) drive.mode[w] = OMNIHIL_DRIVE_PHASES;
    }
    return drive;
  }
  const std::int64_t from_ns = world_.at_ns, to_ns = from_ns + board_.spec().coupling_ns;
  for (int w = 0; w < kWheels; ++w) {
    if (MotorWire* wire = board_.wire(w)) wire->begin(from_ns);
  }
  board_.run_until_ns(to_ns);
  for (int w = 0; w < kWheels; ++w) {
    MotorWire* wire = board_.wire(w);
    if (wire == nullptr) continue;
    const BridgeDrive mean = wire->end(to_ns);
    const auto i = static_cast<std::size_t>(w);
    drive.mode[i] = mean.driven ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
    drive.duty_ratio[i] = mean.duty_ratio;
    feedback_.duty_ratio[i] = mean.duty_ratio;
  }
  return drive;
}

MotorDrive McuFirmware::motor_tick(const MotorSensors& sensors) {
  const auto now_ns = static_cast<std::int64_t>(sensors.now_ns);
  board_.run_until_ns(now_ns);
  world_.bus_voltage_V = sensors.bus_voltage_V;
  board_.set_world(world_);
  MotorDrive drive{};
  for (int w = 0; w < kWheels; ++w) {
    if (const MotorWire* wire = board_.wire(w)) {
      wire->legs(drive.leg[static_cast<std::size_t>(w)], drive.leg_duty_ratio[static_cast<std::size_t>(w)]);
    }
  }
  return drive;
}

std::uint64_t McuFirmware::missed_control_periods() const {
  const std::string& name = board_.spec().control_timer;
  return name.empty() ? 0 : board_.chip().find<Timer>(name)->updates_lost();
}

std::vector<std::string> board_report(const McuBoard& board, const ElfImage& image) {
  const MachineReport report = board.machine().report();
  std::vector<std::string> lines;
  const auto where = [&image](std::uint32_t pc) {
    const std::string function = image.function_at(pc);
    return function.empty() ? fmt::format("0x{:08x}", pc) : fmt::format("0x{:08x} {}", pc, function);
  };
  if (report.locked_up) lines.push_back(fmt::format("locked up at {}", where(report.lock_up_pc)));
  for (const FaultRecord& fault : report.faults) lines.push_back("fault: " + fault.text());
  for (std::size_t i = 1; i < report.resets.size(); ++i) {
    const double at_s = static_cast<double>(board.machine().to_ns(report.resets[i].at)) * 1e-9;
    lines.push_back(fmt::format("reset by {} at {:.6f} s", report.resets[i].cause, at_s));
  }
  if (report.null_access_count > 0) {
    lines.push_back(fmt::format("{} accesses through null pointers, first at {}", report.null_access_count,
                                where(report.null_accesses.front().pc)));
  }
  for (const Unmodelled& u : report.unmodelled) {
    lines.push_back(fmt::format("not modelled: {}: {} ({} times, first at {})", u.peripheral, u.what, u.count,
                                where(u.pc)));
  }
  return lines;
}

}  // namespace omnihil::mcu
