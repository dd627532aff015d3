#include "sim/robot/plant.h"

#include <algorithm>
#include <stdexcept>

#include "sim/drive/encoder.h"
#include "sim/robot/plain_bytes.h"
#include "sim/robot/plant_impl.h"
#include "sim/robot/validate.h"

namespace omnihil {
namespace {

constexpr std::uint64_t kStateMark = 0x34544e414c504853;  // layout of save(), version 4

// The board's four are the first of all.
PlantSensors with_stuck_counts(RobotMemory& mem, PlantSensors s) {
  for (std::size_t i = 0; i < kMaxWheels; ++i) {
    if (mem.faults.encoder_stuck[i]) s.encoder_counts[i] = mem.counts_read[i];
    mem.counts_read[i] = s.encoder_counts[i];
  }
  std::copy_n(s.encoder_counts.begin(), kWheels, s.board.encoder_counts);
  std::copy_n(s.motor_current_A.begin(), kWheels, s.board.motor_current_A);
  return s;
}

}  // namespace

Plant::Plant(std::span<const RobotModel> robots, const PlantOptions& options) {
  const std::vector<RobotModel> models = models_with_effects(robots);
  require_valid(models, options);
  impl_ = std::make_unique<Impl>(models, options);
}
Plant::~Plant() = default;
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;

int Plant::robot_count() const { return static_cast<int>(impl_->models.size()); }
const PlantOptions& Plant::options() const { return impl_->options; }
std::int64_t Plant::now_ns() const { return impl_->now_ns; }
const std::optional<PlantFault>& Plant::fault() const { return impl_->fault; }

void Plant::set_pose(int robot, double x_m, double y_m, double yaw_rad) {
  impl_->place(static_cast<std::size_t>(robot), x_m, y_m, yaw_rad);
}

void Plant::write(int robot, const RobotDrive& drive) {
  RobotMemory& mem = impl_->memory[static_cast<std::size_t>(robot)];
  mem.drive = drive;
  std::copy_n(drive.mode, kWheels, mem.mode.begin());
  std::copy_n(drive.duty_ratio, kWheels, mem.duty_ratio.begin());
}

void Plant::write_duties(int robot, const PerWheel<double>& duty_ratio) {
  write(robot, {});
  RobotMemory& mem = impl_->memory[static_cast<std::size_t>(robot)];
  mem.mode.fill(OMNIHIL_DRIVE_DUTY);
  mem.duty_ratio = duty_ratio;
}

void Plant::set_faults(int robot, const RobotFaults& faults) {
  const auto n = static_cast<std::size_t>(robot);
  const RobotFaults before = impl_->memory[n].faults;
  impl_->memory[n].faults = faults;
  impl_->apply_faults(n, before);
}

const RobotFaults& Plant::faults(int robot) const {
  return impl_->memory[static_cast<std::size_t>(robot)].faults;
}

void Plant::set_motor_control(int robot, MotorControl* control) {
  impl_->controls[static_cast<std::size_t>(robot)] = control;
}

void Plant::set_workers(Workers* workers) { impl_->workers = workers; }

void Plant::write_legs(int robot, const MotorDrive& legs) {
  impl_->electric_memory[static_cast<std::size_t>(robot)].legs = legs;
}

MotorSensors Plant::motor_sensors(int robot) const {
  return impl_->electric_memory[static_cast<std::size_t>(robot)].seen;
}

ElectricTruth Plant::electric_truth(int robot) const {
  const auto n = static_cast<std::size_t>(robot);
  return impl_->electrics[n] ? impl_->electrics[n]->truth(impl_->electric_memory[n]) : ElectricTruth{};
}

void Plant::advance(std::int64_t duration_ns, StepListener* listener) {
  Impl& p = *impl_;
  if (duration_ns < 0 || duration_ns % p.options.mechanical_step_ns != 0) {
    throw std::logic_error("Plant::advance: " + std::to_string(duration_ns) +
                           " ns is not a multiple of the step of " +
                           std::to_string(p.options.mechanical_step_ns) + " ns");
  }
  if (!p.fault) p.look_for_fault();  // what was written since
  if (p.fault) return;
  p.regroup();
  for (std::int64_t n = duration_ns / p.step_ns; n > 0; --n) {
    p.step();
    if (listener != nullptr) listener->after_step(*this, p.step_s);
  }
  p.look_for_fault();
}

PlanarState Plant::planar_state(int robot) const {
  const Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  const double* v = p.field_velocity(n);
  if (!p.free()) {
    const double* at = p.pose(n);  // yaw, x, y
    return {at[1], at[2], at[0], v[0], v[1], p.speeds(n)[0]};
  }
  const BodyMotion m = p.motion(n);
  return {m.x_m, m.y_m, m.yaw_rad, v[0], v[1], m.velocity.omega_body_rad_s};
}

double Plant::tilt_rad(int robot) const {
  const Impl& p = *impl_;
  if (!p.free()) return 0.0;
  // The body's vertical axis against the floor's: cos = 1 - 2 (x^2 + y^2) of the unit quaternion (w, x, y, z).
  const double* at = p.pose(static_cast<std::size_t>(robot));
  return std::acos(std::clamp(1.0 - 2.0 * (at[1] * at[1] + at[2] * at[2]), -1.0, 1.0));
}

void Plant::add_velocity(int robot, double v_x_m_s, double v_y_m_s, double omega_rad_s) {
  impl_->add_velocity(static_cast<std::size_t>(robot), v_x_m_s, v_y_m_s, omega_rad_s);
}

void Plant::shift(int robot, double x_m, double y_m) {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  double* at = p.pose(n) + (p.free() ? 4 : 1);
  at[0] += x_m;
  at[1] += y_m;
  p.group(n).state_known = false;
}

void Plant::set_other_current(int robot, double current_A) {
  impl_->electric_memory[static_cast<std::size_t>(robot)].other_current_A = current_A;
}

PlantSensors Plant::sample_all(int robot) {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  const RobotModel& model = p.models[n];
  RobotMemory& mem = p.memory[n];
  if (p.effects[n]) {
    return with_stuck_counts(
        mem, read_sensors(*p.effects[n], p.effect_memory[n], p.histories[n], model, p.sensing(n)));
  }
  PlantSensors s;
  s.board.now_us = static_cast<std::uint64_t>(p.now_ns / 1000);
  const double* theta_wheel_rad = p.wheel_angles(n);
  for (std::size_t i = 0; i < model.wheels; ++i) {
    const double theta_rotor_rad = model.gear_ratio * theta_wheel_rad[i];
    if (std::isfinite(theta_rotor_rad)) s.encoder_counts[i] = encoder_counts(model.encoder, theta_rotor_rad);
    s.motor_current_A[i] = mem.current_steps > 0
                               ? mem.current_sum_A[i] / static_cast<double>(mem.current_steps)
                               : mem.winding[i].current_A;
    mem.current_sum_A[i] = 0.0;
  }
  mem.current_steps = 0;
  s.board.bus_voltage_V =
      p.electrics[n] ? p.electric_memory[n].at_bridges_V() : mem.faults.supply_ratio * model.bus_voltage_V;
  s.board.gyro_z_rad_s = p.motion(n).velocity.omega_body_rad_s;
  s.board.accel_x_m_s2 = mem.accel_x_m_s2;
  s.board.accel_y_m_s2 = mem.accel_y_m_s2;
  return with_stuck_counts(mem, s);
}

RobotTruth Plant::truth(int robot) const {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  RobotTruth t;
  MechanicsGroup& of = p.group(n);
  of.set_state();
  std::visit(
      [&](const auto& back) {
        const BodyMotion m = back.motion(of.q, of.u, n - of.first);
        t.x_m = m.x_m, t.y_m = m.y_m, t.yaw_rad = m.yaw_rad;
        t.v_forward_m_s = m.velocity.v_forward_m_s;
        t.v_left_m_s = m.velocity.v_left_m_s;
        t.omega_body_rad_s = m.velocity.omega_body_rad_s;
        const WheelContacts<double>& c = back.contacts(n - of.first);
        t.slip_longitudinal_ratio = c.slip_longitudinal_ratio;
        t.force_longitudinal_N = c.force_longitudinal_N;
        t.force_lateral_N = c.force_lateral_N;
        t.load_N = c.load_N;
      },
      of.mechanics);
  for (std::size_t i = 0; i < p.wheels(n); ++i) {
    t.theta_wheel_rad[i] = p.wheel_angles(n)[i];
    t.omega_wheel_rad_s[i] = p.wheel_speeds_of(n)[i];
    t.omega_rotor_rad_s[i] = p.omega_rotor_rad_s(n, i);
    t.theta_rotor_rad[i] = p.theta_rotor_rad(n, i);
    t.motor_current_A[i] = p.memory[n].winding[i].current_A;
    t.motor_torque_Nm[i] = p.memory[n].motor_torque_Nm[i];
  }
  return t;
}

VisionPose Plant::vision(int robot) const {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  const BodyMotion m = p.motion(n);
  if (!p.effects[n] || !p.effects[n]->looks_back()) return {m.x_m, m.y_m, m.yaw_rad};
  const RobotInstant seen = seen_by_camera(*p.effects[n], p.effect_memory[n], p.histories[n], p.sensing(n));
  return {seen.x_m, seen.y_m, seen.yaw_rad};
}

namespace {
// All that changes as time goes on, in the order in which it is kept: visit(first, count).
template <typename Impl, typename Visit>
void each_memory(Impl& p, Visit visit) {
  visit(&p.now_ns, 1);
  for (auto& of : p.groups) visit(of.q.data(), of.q.size());
  for (auto& of : p.groups) visit(of.u.data(), of.u.size());
  visit(p.memory.data(), p.memory.size());
  for (std::size_t n = 0; n < p.models.size(); ++n) {
    if (p.electrics[n]) visit(&p.electric_memory[n], 1);
    if (!p.effects[n]) continue;
    visit(&p.effect_memory[n], 1);
    visit(&p.histories[n].count(), 1);
    visit(p.histories[n].points().data(), p.histories[n].points().size());
  }
}
}  // namespace

std::vector<std::uint8_t> Plant::save() const {
  const Impl& p = *impl_;
  const std::uint64_t head[3] = {kStateMark, plant_fingerprint(p.models, p.options), p.fault ? 1u : 0u};
  std::vector<std::uint8_t> out;
  append(out, head, 3);
  each_memory(p, [&](const auto* first, std::size_t count) { append(out, first, count); });
  return out;
}

bool Plant::restore(std::span<const std::uint8_t> bytes) {
  Impl& p = *impl_;
  if (bytes.size() != save().size()) return false;
  std::uint64_t head[3];
  take(bytes, head, 3);
  if (head[0] != kStateMark || head[1] != plant_fingerprint(p.models, p.options)) return false;
  each_memory(p, [&](auto* first, std::size_t count) { take(bytes, first, count); });
  for (std::size_t n = 0; n < p.models.size(); ++n) p.apply_faults(n, p.memory[n].faults);
  p.fault.reset();
  if (head[2] != 0) p.look_for_fault();
  p.forget_states();
  return true;
}

}  // namespace omnihil
