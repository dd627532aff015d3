#include "firmware_iface/mcu/board/mcu_firmware.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware_iface/mcu/board/can_frames.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/serial_port.h"

namespace omnihil::mcu {

namespace {
// The board's number in the words that are preset after the image, and its own cards.
BoardSpec numbered(BoardSpec spec, int number, const CardOpener& cards) {
  for (DeviceEntry& entry : spec.devices) {
    if (cards && !entry.image.empty()) entry.card = cards(entry, number);
  }
  for (FlashEntry& entry : spec.flash) {
    if (entry.board_number_at < 0) continue;
    entry.words[static_cast<std::size_t>(entry.board_number_at)] = static_cast<std::uint32_t>(number);
  }
  return spec;
}
}  // namespace

McuFirmware::McuFirmware(const BoardSpec& spec, const ElfImage& image, const RobotConfig& config,
                         const CardOpener& cards)
    : name_(fmt::format("image on {} ({})", spec.name,
                        spec.chip_name.empty() ? std::string(spec.chip->name) : spec.chip_name)),
      config_(config),
      spec_(spec) {
  if (spec.boards_per_robot > 1) wheels_per_board_ = static_cast<int>(spec.motors.size());
  for (int b = 0; b < spec.boards_per_robot; ++b) {
    boards_.push_back(std::make_unique<McuBoard>(numbered(spec, b, cards), image));
    for (const PinEntry& entry : spec.pins) {  // the switches that say which robot this is
      if (entry.robot_id_bit < 0) continue;
      const bool level = ((config.robot_id >> entry.robot_id_bit & 1u) != 0) != entry.inverted;
      boards_.back()->chip().port(entry.pin.port)->drive(entry.pin.pin, level);
    }
  }
  for (const MotorEntry& motor : spec.motors) phases_ = phases_ || motor.pwm.size() == 3;
  world_.gear_ratio = config.gear_ratio;
  world_.encoder_counts_per_rotor_turn = config.encoder_counts_per_rotor_turn;
  world_.bus_voltage_V = config.bus_voltage_nominal_V;
}

MotorWire* McuFirmware::wire(int wheel) const {
  const auto board = static_cast<std::size_t>(wheel / wheels_per_board_);
  return board < boards_.size() ? boards_[board]->wire(wheel % wheels_per_board_) : nullptr;
}

void McuFirmware::radio_receive(std::span<const std::uint8_t> frame, std::int64_t) {
  for (const auto& board : boards_) board->radio_receive(frame);
}

std::size_t McuFirmware::radio_transmit(std::span<std::uint8_t> out) {
  std::vector<std::uint8_t> frame;
  for (const auto& board : boards_) {
    if (!board->radio_transmit(frame)) continue;
    const std::size_t n = std::min(frame.size(), out.size());
    std::copy_n(frame.begin(), n, out.begin());
    return n;
  }
  return 0;
}

void McuFirmware::command(const RobotCommand& command, std::int64_t now_ns) {
  const bool speeds = command.mode != OMNIHIL_MODE_WHEEL_DUTY;
  if (spec_.wheel_commands.words.period_ns == 0 || !speeds) ++commands_ignored_;
  command_ = command;
  command_at_ns_ = now_ns;
  commanded_ = speeds;
}

// Eq. (5): rim speed = -v_x sin a + v_y cos a + R omega.
std::array<double, kWheels> McuFirmware::commanded_wheels_rad_s(std::int64_t now_ns) const {
  constexpr std::int64_t kForget_ns = 250'000'000;
  std::array<double, kWheels> omega_rad_s{};
  if (!commanded_ || now_ns - command_at_ns_ > kForget_ns) return omega_rad_s;
  for (std::size_t w = 0; w < kWheels; ++w) {
    if (command_.mode == OMNIHIL_MODE_WHEEL_SPEED) omega_rad_s[w] = command_.omega_wheel_rad_s[w];
    if (command_.mode != OMNIHIL_MODE_BODY_VELOCITY) continue;
    const double angle_rad = config_.wheel_angle_rad[w];
    const double rim_m_s = -command_.v_forward_m_s * std::sin(angle_rad) +
                           command_.v_left_m_s * std::cos(angle_rad) +
                           command_.omega_body_rad_s * config_.wheel_center_radius_m;
    omega_rad_s[w] = rim_m_s / config_.wheel_radius_m;
  }
  return omega_rad_s;
}

// What the main board says to each of its boards, on its own period.
void McuFirmware::speak(std::int64_t now_ns) {
  const WheelCommands& to = spec_.wheel_commands;
  if (to.words.period_ns == 0 || now_ns % to.words.period_ns != 0) return;
  std::array<double, kWheels> speeds_rad_s = commanded_wheels_rad_s(now_ns);
  for (double& speed : speeds_rad_s) speed *= to.sign * config_.gear_ratio;  // of the motor
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    const auto n = std::min(static_cast<std::size_t>(wheels_per_board_), spec_.motors.size());
    std::vector<BusFrame> frames;
    const auto own = std::span(speeds_rad_s).subspan(b * n, n);
    omnihil::speak(to.words, {static_cast<int>(b), static_cast<int>(b * n), now_ns}, own, frames);
    McuBoard& board = *boards_[b];
    for (const BusFrame& frame : frames) {
      if (to.serial) {
        board.chip().find<SerialPort>(to.via)->feed(frame.bytes(), board.now_ns());
      } else {
        board.chip().find<CanPort>(to.via)->receive(can_frame_of(frame));
      }
    }
  }
}

void McuFirmware::show_world() {
  if (boards_.size() == 1) return boards_[0]->set_world(world_);
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    WorldState seen = world_;
    for (std::size_t w = b * static_cast<std::size_t>(wheels_per_board_), i = 0; w < kWheels; ++w, ++i) {
      seen.theta_rotor_rad[i] = world_.theta_rotor_rad[w];
      seen.omega_rotor_rad_s[i] = world_.omega_rotor_rad_s[w];
      seen.motor_current_A[i] = world_.motor_current_A[w];
      seen.phase_current_A[i] = world_.phase_current_A[w];
      seen.phase_rate_A_s[i] = world_.phase_rate_A_s[w];
      seen.leg_V[i] = world_.leg_V[w];
    }
    boards_[b]->set_world(seen);
  }
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
  for (const PinEntry& entry : spec_.pins) {
    if (!entry.break_beam) continue;
    const bool level = (sensors.ball_seen != 0) == entry.level;
    for (const auto& board : boards_) board->chip().port(entry.pin.port)->drive(entry.pin.pin, level);
  }
  world_.bus_voltage_V = sensors.bus_voltage_V;
  world_.gyro_z_rad_s = sensors.gyro_z_rad_s;
  world_.accel_x_m_s2 = sensors.accel_x_m_s2;
  world_.accel_y_m_s2 = sensors.accel_y_m_s2;
  show_world();
}

RobotDrive McuFirmware::tick(const RobotSensors& sensors) {
  begin_tick(sensors);
  for (std::size_t part = 0; part < tick_parts(); ++part) run_part(part);
  return end_tick();
}

void McuFirmware::begin_tick(const RobotSensors& sensors) {
  look(sensors);
  speak(world_.at_ns);
  feedback_ = feedback_of(exact_, sensors, config_.gear_ratio);
  for (int w = 0; w < kWheels && !phases_; ++w) {
    if (MotorWire* motor = wire(w)) motor->begin(world_.at_ns);
  }
}

void McuFirmware::run_part(std::size_t part) {
  if (!phases_) boards_[part]->run_until_ns(world_.at_ns + spec_.coupling_ns);
}

RobotDrive McuFirmware::end_tick() {
  RobotDrive drive{};
  for (int w = 0; w < kWheels; ++w) {
    MotorWire* motor = wire(w);
    if (motor == nullptr) continue;
    const auto i = static_cast<std::size_t>(w);
    if (phases_) {  // the image runs on from PWM period to PWM period
      drive.mode[i] = OMNIHIL_DRIVE_PHASES;
      continue;
    }
    const BridgeDrive mean = motor->end(world_.at_ns + spec_.coupling_ns);
    drive.mode[i] = mean.driven ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
    drive.duty_ratio[i] = mean.duty_ratio;
    feedback_.duty_ratio[i] = mean.duty_ratio;
  }
  return drive;
}

PhaseLegs McuFirmware::phase_period(const PhasePeriod& period) {
  const MotorSensors& begin = period.begin;
  world_.phases_at_ns = static_cast<std::int64_t>(begin.now_ns);
  const double duration_s = 1e-9 * static_cast<double>(period.end_ns - world_.phases_at_ns);
  world_.bus_voltage_V = begin.bus_voltage_V;
  for (std::size_t w = 0; w < kWheels; ++w) {
    std::copy_n(begin.phase_current_A[w], kLegs, world_.phase_current_A[w].begin());
    std::copy_n(begin.leg_V[w], kLegs, world_.leg_V[w].begin());
    for (std::size_t x = 0; x < kLegs; ++x) {
      world_.phase_rate_A_s[w][x] =
          (period.end_phase_current_A[w][x] - begin.phase_current_A[w][x]) / duration_s;
    }
  }
  show_world();
  for (int w = 0; w < kWheels; ++w) {
    if (MotorWire* motor = wire(w)) motor->begin(world_.phases_at_ns);
  }
  for (const auto& board : boards_) board->run_until_ns(period.end_ns);
  PhaseLegs legs;
  const auto put = [](const BridgeLegs& from, MotorDrive& to, std::size_t w) {
    std::copy_n(from.leg, kLegs, to.leg[w]);
    std::copy_n(from.duty_ratio, kLegs, to.leg_duty_ratio[w]);
  };
  for (int w = 0; w < kWheels; ++w) {
    MotorWire* motor = wire(w);
    if (motor == nullptr) continue;
    put(motor->end_legs(period.end_ns), legs.mean, static_cast<std::size_t>(w));
    put(motor->held_legs(), legs.end, static_cast<std::size_t>(w));
  }
  return legs;
}

std::uint64_t McuFirmware::missed_control_periods() const {
  if (spec_.control_timer.empty()) return 0;
  std::uint64_t missed = 0;
  for (const auto& board : boards_)
    missed += board->chip().find<PwmOutputs>(spec_.control_timer)->updates_lost();
  return missed;
}

std::string board_failure(const McuBoard& board, const ElfImage& image) {
  // A fault once may be a scenario's doing and be got over; twice in a row with nothing else between is a loop. A
  // handler that has held the core for this long has not kept up with any radio (teams time out after 0.1 to 0.5 s).
  constexpr int kResets = 2;
  constexpr std::int64_t kHeld_ns = 250'000'000;
  const Machine& machine = board.machine();
  if (machine.stopped()) return "the emulated core has locked up";
  const Cycles since = machine.in_fault_handler_since();
  const bool held = since != kNever && board.now_ns() - machine.to_ns(since) > kHeld_ns;
  if (!held && machine.resets_after_faults() < kResets) return {};
  const MachineReport report = machine.report();
  const FaultRecord& last = report.faults.back();
  const std::string fault = last.text(image.function_at(last.pc));
  return held ? fmt::format("stays in its fault handler: {}", fault)
              : fmt::format("faults and is reset, twice in a row: {}", fault);
}

std::vector<std::string> board_report(const McuBoard& board, const ElfImage& image) {
  const MachineReport report = board.machine().report();
  std::vector<std::string> lines;
  const auto where = [&image](std::uint32_t pc) {
    const std::string function = image.function_at(pc);
    return function.empty() ? fmt::format("0x{:08x}", pc) : fmt::format("0x{:08x} {}", pc, function);
  };
  if (report.locked_up) lines.push_back(fmt::format("locked up at {}", where(report.lock_up_pc)));
  const auto seconds = [&board](Cycles at) { return static_cast<double>(board.machine().to_ns(at)) * 1e-9; };
  for (const FaultRecord& fault : report.faults) {
    const std::string text = "fault: " + fault.text(image.function_at(fault.pc));
    lines.push_back(fault.count == 1 ? fmt::format("{}, at {:.6f} s", text, seconds(fault.at))
                                     : fmt::format("{}, {} times, first at {:.6f} s", text, fault.count,
                                                   seconds(fault.at)));
  }
  for (std::size_t i = 1; i < report.resets.size(); ++i) {
    const ResetRecord& reset = report.resets[i];
    lines.push_back(reset.count == 1
                        ? fmt::format("reset by {} at {:.6f} s", reset.cause, seconds(reset.at))
                        : fmt::format("reset by {} {} times, first at {:.6f} s, last at {:.6f} s",
                                      reset.cause, reset.count, seconds(reset.at), seconds(reset.last)));
  }
  if (report.null_access_count > 0) {
    lines.push_back(fmt::format("{} accesses through null pointers, first at {}", report.null_access_count,
                                where(report.null_accesses.front().pc)));
  }
  for (const Unmodelled& u : report.unmodelled) {
    lines.push_back(fmt::format("not modelled: {}: {} ({} times, first at {})", u.peripheral, u.what, u.count,
                                where(u.pc)));
  }
  for (const Chip::Mapped& block : board.chip().blocks()) {
    const auto* end = dynamic_cast<const BusEnd*>(block.peripheral);
    for (const BusLoss& loss : end != nullptr ? end->ledger().losses() : std::vector<BusLoss>{}) {
      lines.push_back(fmt::format("{}: {} {}{} {}, the first at {:.6f} s", block.peripheral->name(),
                                  loss.count, loss.unit, loss.count == 1 ? "" : "s", loss.what,
                                  seconds(loss.first)));
    }
  }
  return lines;
}

}  // namespace omnihil::mcu
