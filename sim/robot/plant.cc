#include "sim/robot/plant.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>

#include "sim/motor/encoder.h"
#include "sim/robot/chassis.h"
#include "sim/robot/electric_wheels.h"
#include "sim/robot/integrate.h"
#include "sim/robot/plain_bytes.h"
#include "sim/robot/planar.h"
#include "sim/robot/robot_effects.h"
#include "sim/robot/robot_sensing.h"
#include "sim/robot/validate.h"
#include "sim/robot/wheel_drive.h"

namespace omnihil {
namespace {

constexpr double kSpacing_m = 0.3;                        // of the robots' starting row
constexpr double kDribblerFull_rad_s = 1000.0;            // at ratio 1; guess, +-50 %
constexpr double kStandstill_m_s = 1e-12;                 // below it a robot with held wheels stops exactly
constexpr std::uint64_t kStateMark = 0x31544e414c504853;  // layout of save(), version 1

// What one robot remembers besides positions and speeds; plain bytes, saved as they are.
struct RobotMemory {
  RobotDrive drive{};
  std::array<DcDriveState, kWheels> winding{};
  std::array<double, kWheels> motor_torque_Nm{};  // mean of the last step
  std::array<double, kWheels> current_sum_A{};    // of the steps since the last read
  std::int64_t current_steps = 0;
  double accel_x_m_s2 = 0.0, accel_y_m_s2 = 0.0;
};
static_assert(std::is_trivially_copyable_v<RobotMemory>);

using Mechanics = std::variant<PlanarMechanics, Chassis>;

Mechanics make_mechanics(const std::vector<RobotModel>& robots, Physics physics,
                         const std::vector<const FloorEffects*>& effects) {
  if (physics == Physics::kPlanar) return PlanarMechanics(robots, effects);
  return Chassis(robots, physics == Physics::kSimbody ? Chassis::Joint::kPlanar : Chassis::Joint::kFree,
                 effects);
}

}  // namespace

struct Plant::Impl {
  Impl(std::span<const RobotModel> robots_, const PlantOptions& options_)
      : options(options_),
        models(robots_.begin(), robots_.end()),
        effects(make_effects(models, options_)),
        mechanics(make_mechanics(models_of_mechanics(models), options_.physics, floors_of(effects))),
        layout(std::visit([](const auto& m) { return m.layout(); }, mechanics)),
        q(models.size() * layout.q_per_robot),
        u(models.size() * layout.u_per_robot),
        u_before(u.size()),
        scratch(q.size(), u.size()),
        memory(models.size()),
        electrics(models.size()),
        electric_memory(models.size()),
        controls(models.size()),
        torques(models.size()),
        wheel_steps(models.size()) {
    step_ns = mechanics_step_ns(models, options);
    step_s = static_cast<double>(step_ns) * 1e-9;
    substeps = static_cast<int>(step_ns / options.electrical_step_ns);
    for (const RobotModel& m : models_of_mechanics(models)) {
      drives.push_back(wheel_drive_law(m, static_cast<double>(options.electrical_step_ns) * 1e-9, substeps));
    }
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (!electrics_of(models[n]).any()) continue;
      electrics[n] = std::make_unique<ElectricWheels>(
          models[n], static_cast<double>(options.electrical_step_ns) * 1e-9, step_s, options.seed, n);
    }
    effect_memory.resize(models.size());
    histories.resize(models.size());
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (effects[n] && effects[n]->looks_back()) histories[n] = RobotHistory(kLongestAge_s, step_s);
    }
    for (std::size_t n = 0; n < models.size(); ++n) place(n, 0.0, kSpacing_m * static_cast<double>(n), 0.0);
  }

  const double* wheel_angles(std::size_t robot) const {
    return &q[robot * layout.q_per_robot + layout.wheel_q];
  }
  double* wheel_angles(std::size_t robot) { return &q[robot * layout.q_per_robot + layout.wheel_q]; }
  const double* wheel_speeds_of(std::size_t robot) const {
    return &u[robot * layout.u_per_robot + layout.wheel_u];
  }
  double* wheel_speeds_of(std::size_t robot) { return &u[robot * layout.u_per_robot + layout.wheel_u]; }
  // Field-frame v_x of a robot in an array of speeds; v_y follows.
  const double* field_velocity(const std::vector<double>& speeds, std::size_t robot) const {
    return &speeds[robot * layout.u_per_robot + layout.wheel_u - (free() ? 3 : 2)];
  }
  bool free() const { return options.physics == Physics::kSimbodyFree; }

  void place(std::size_t robot, double x_m, double y_m, double yaw_rad) {
    std::array<double, kWheels> angles;
    std::copy_n(wheel_angles(robot), kWheels, angles.begin());
    std::visit([&](const auto& m) { m.place(q, u, robot, x_m, y_m, yaw_rad); }, mechanics);
    std::copy_n(angles.begin(), kWheels, wheel_angles(robot));  // turning a robot by hand turns no rotor
    const RobotDrive kept = memory[robot].drive;
    memory[robot] = RobotMemory{};
    memory[robot].drive = kept;
    state_known = false;
    if (electrics[robot]) electric_memory[robot] = electrics[robot]->initial_memory();
    if (effects[robot]) {
      std::array<double, kWheels> rotors{};
      for (std::size_t i = 0; i < kWheels; ++i) rotors[i] = theta_rotor_rad(robot, i);
      effect_memory[robot] = effects[robot]->initial_memory();
      RobotEffectMemory& mem = effect_memory[robot];
      for (std::size_t i = 0; i < kWheels; ++i) mem.drive[i].theta_rotor_rad = rotors[i];
      mem.seen_s = mem.read_s = now_s();
      for (std::size_t i = 0; i < kWheels; ++i) mem.seen_theta_rotor_rad[i] = theta_rotor_rad(robot, i);
      histories[robot].clear();
      remember(robot);
    }
  }

  double now_s() const { return static_cast<double>(now_ns) * 1e-9; }
  bool two_masses(std::size_t robot) const { return effects[robot] && effects[robot]->two_masses(); }
  double theta_rotor_rad(std::size_t robot, std::size_t wheel) const {
    return two_masses(robot) ? effect_memory[robot].drive[wheel].theta_rotor_rad
                             : models[robot].gear_ratio * wheel_angles(robot)[wheel];
  }
  double omega_rotor_rad_s(std::size_t robot, std::size_t wheel) const {
    return two_masses(robot) ? effect_memory[robot].drive[wheel].omega_rotor_rad_s
                             : models[robot].gear_ratio * wheel_speeds_of(robot)[wheel];
  }

  // What sensors could see now.
  RobotInstant instant(std::size_t n) const {
    RobotInstant p;
    const BodyMotion m = std::visit([&](const auto& back) { return back.motion(q, u, n); }, mechanics);
    p.time_s = now_s();
    p.x_m = m.x_m, p.y_m = m.y_m, p.yaw_rad = m.yaw_rad;
    p.gyro_rad_s = m.velocity.omega_body_rad_s;
    p.accel_x_m_s2 = memory[n].accel_x_m_s2;
    p.accel_y_m_s2 = memory[n].accel_y_m_s2;
    p.bus_voltage_V = effect_memory[n].bus_voltage_V;
    for (std::size_t i = 0; i < kWheels; ++i) {
      p.theta_rotor_rad[i] = theta_rotor_rad(n, i);
      p.omega_rotor_rad_s[i] = omega_rotor_rad_s(n, i);
    }
    p.charge_C = effect_memory[n].charge_C;
    return p;
  }
  void remember(std::size_t n) {
    if (effects[n]->looks_back()) histories[n].push(instant(n));
  }

  Sensing sensing(std::size_t n) const {
    Sensing at{instant(n), now_ns, options.seed, n, {}};
    for (std::size_t i = 0; i < kWheels; ++i) at.current_A[i] = memory[n].winding[i].current_A;
    return at;
  }

  // Brings the mechanics' floor forces up to date with q and u.
  template <typename Back>
  void set_state(Back& back) {
    if (!state_known) back.set_state(q, u);
    state_known = true;
  }

  void begin_wheels(std::size_t n, const WheelContacts<double>& contacts) {
    const RobotModel& model = models[n];
    RobotMemory& mem = memory[n];
    const double* omega_wheel = wheel_speeds_of(n);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double contact_Nm = model.wheel_radius_m * contacts.force_longitudinal_N[i] / model.gear_ratio;
      const BridgeInput bridge{mem.drive.mode[i], mem.drive.duty_ratio[i], model.bus_voltage_V};
      const WheelStep step =
          begin_wheel_step(drives[n], mem.winding[i], bridge, model.gear_ratio * omega_wheel[i], contact_Nm);
      wheel_steps[n][i] = step;
      torques[n][i] = step.torque;
    }
  }

  void begin_electric_wheels(std::size_t n, const std::array<WheelDriveInput, kWheels>& inputs) {
    electrics[n]->begin_step(electric_memory[n], inputs, now_ns, controls[n], wheel_steps[n]);
    if (effects[n]) effect_memory[n].bus_voltage_V = electric_memory[n].supply.bus_voltage_V;
    for (std::size_t i = 0; i < kWheels; ++i) torques[n][i] = wheel_steps[n][i].torque;
  }

  // `more`: of floor effects; null: none.
  std::array<WheelDriveInput, kWheels> wheel_inputs(std::size_t n, const WheelContacts<double>& contacts,
                                                    const FloorForces* more) const {
    const RobotModel& model = models[n];
    const RobotMemory& mem = memory[n];
    const double* omega_wheel = wheel_speeds_of(n);
    std::array<WheelDriveInput, kWheels> inputs;
    for (std::size_t i = 0; i < kWheels; ++i) {
      WheelDriveInput& in = inputs[i];
      in.bridge = {mem.drive.mode[i], mem.drive.duty_ratio[i], model.bus_voltage_V};
      in.omega_wheel_rad_s = omega_wheel[i];
      in.theta_wheel_rad = wheel_angles(n)[i];
      const double radius_m = more != nullptr ? more->wheel_radius_m[i] : model.wheel_radius_m;
      in.contact_Nm = radius_m * contacts.force_longitudinal_N[i] / model.gear_ratio;
      if (more != nullptr) in.friction_rotor_Nm = more->friction_wheel_Nm[i] / model.gear_ratio;
    }
    return inputs;
  }

  void begin_wheels_with_effects(std::size_t n, const std::array<WheelDriveInput, kWheels>& inputs) {
    effects[n]->begin_step(drives[n], effect_memory[n], inputs, wheel_steps[n]);
    for (std::size_t i = 0; i < kWheels; ++i) torques[n][i] = wheel_steps[n][i].torque;
  }

  template <typename Back>
  void step(Back& back) {
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (effects[n]) effects[n]->floor.dribbler_rad_s = memory[n].drive.dribbler_ratio * kDribblerFull_rad_s;
    }
    set_state(back);
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (electrics[n]) {
        const FloorForces* more = effects[n] ? &back.floor_forces(n) : nullptr;
        begin_electric_wheels(n, wheel_inputs(n, back.contacts(n), more));
      } else if (effects[n]) {
        begin_wheels_with_effects(n, wheel_inputs(n, back.contacts(n), &back.floor_forces(n)));
      } else {
        begin_wheels(n, back.contacts(n));
      }
    }
    u_before = u;
    integrate(options.integrator, back, torques, step_s, q, u, scratch);
    state_known = false;
    for (std::size_t n = 0; n < models.size(); ++n) end_robot(back, n);
    now_ns += step_ns;
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (effects[n]) remember(n);
    }
  }

  template <typename Back>
  void end_robot(const Back& back, std::size_t n) {
    const double* before = &u_before[n * layout.u_per_robot + layout.wheel_u];
    double* after = wheel_speeds_of(n);
    bool held = true;
    for (std::size_t i = 0; i < kWheels; ++i) {
      WheelStep& step = wheel_steps[n][i];
      if (electrics[n]) {
        after[i] = electrics[n]->end_wheel(i, step, before[i], after[i]);
        memory[n].winding[i].current_A = electrics[n]->motor_current_A(electric_memory[n], i);
        effect_memory[n].charge_C[i] += step.drive.mean_current_A * step_s;
      } else if (effects[n]) {
        after[i] = effects[n]->end_wheel(drives[n], effect_memory[n], i, step, before[i], after[i]);
        memory[n].winding[i].current_A = effect_memory[n].drive[i].current_A;
      } else {
        after[i] = end_wheel_step(drives[n], memory[n].winding[i], step, before[i], after[i]);
      }
      memory[n].motor_torque_Nm[i] = step.drive.mean_torque_Nm;
      memory[n].current_sum_A[i] += step.drive.mean_current_A;
      held = held && (step.torque.locked || (two_masses(n) && step.rotor_held));
    }
    ++memory[n].current_steps;
    if (held && !free()) come_to_rest(n);
    const double* v0 = field_velocity(u_before, n);
    const double* v1 = field_velocity(u, n);
    const double ax = (v1[0] - v0[0]) / step_s, ay = (v1[1] - v0[1]) / step_s;
    const double yaw_rad = back.motion(q, u, n).yaw_rad;
    memory[n].accel_x_m_s2 = std::cos(yaw_rad) * ax + std::sin(yaw_rad) * ay;
    memory[n].accel_y_m_s2 = -std::sin(yaw_rad) * ax + std::cos(yaw_rad) * ay;
  }

  // The floor's viscous hold would let the speed fade for ever, into numbers that cost time to compute with.
  void come_to_rest(std::size_t n) {
    double* body = &u[n * layout.u_per_robot];
    double* wheels = wheel_speeds_of(n);
    const auto stands = [](double v_m_s) { return std::abs(v_m_s) < kStandstill_m_s; };
    const bool rims_stand = std::all_of(
        wheels, wheels + kWheels, [&](double omega) { return stands(omega * models[n].wheel_radius_m); });
    if (stands(body[0] * models[n].wheel_center_radius_m) && stands(body[1]) && stands(body[2]) &&
        rims_stand) {
      body[0] = body[1] = body[2] = 0.0;
      std::fill_n(wheels, kWheels, 0.0);
    }
  }

  void report(std::size_t robot, std::string_view signal, std::size_t index) {
    if (!fault) fault = PlantFault{now_ns, static_cast<int>(robot), signal, static_cast<int>(index)};
  }

  void look_for_fault() {
    for (std::size_t n = 0; n < models.size() && !fault; ++n) {
      const auto scan = [&](const double* values, std::size_t count, std::string_view signal) {
        for (std::size_t i = 0; i < count; ++i) {
          if (!std::isfinite(values[i])) report(n, signal, i);
        }
      };
      for (const auto& legs : electric_memory[n].legs.leg_duty_ratio) scan(legs, kLegs, "leg_duty_ratio");
      for (std::size_t i = 0; i < kWheels; ++i) {
        if (!std::isfinite(memory[n].drive.duty_ratio[i])) report(n, "duty_ratio", i);
        if (!std::isfinite(memory[n].winding[i].current_A)) report(n, "motor_current_A", i);
      }
      scan(wheel_speeds_of(n), kWheels, "omega_wheel_rad_s");
      scan(wheel_angles(n), kWheels, "theta_wheel_rad");
      scan(&u[n * layout.u_per_robot], layout.wheel_u, "body_velocity");
      scan(&q[n * layout.q_per_robot], layout.wheel_q, "pose");
    }
  }

  PlantOptions options;
  std::vector<RobotModel> models;
  AllEffects effects;  // before the mechanics, which points into it
  Mechanics mechanics;
  StateLayout layout;
  std::int64_t step_ns = 0;  // of the mechanics: that of the options, or a part of it
  double step_s = 0.0;
  int substeps = 1;
  std::int64_t now_ns = 0;
  std::vector<double> q, u, u_before;
  IntegratorScratch scratch;
  std::vector<RobotMemory> memory;
  std::vector<RobotEffectMemory> effect_memory;
  std::vector<RobotHistory> histories;
  std::vector<std::unique_ptr<ElectricWheels>> electrics;  // null: DC-equivalent on a constant bus
  std::vector<ElectricMemory> electric_memory;
  std::vector<MotorControl*> controls;
  std::vector<WheelDriveLaw> drives;
  std::vector<WheelTorques> torques;
  std::vector<std::array<WheelStep, kWheels>> wheel_steps;
  bool state_known = false;
  std::optional<PlantFault> fault;
};

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
  impl_->memory[static_cast<std::size_t>(robot)].drive = drive;
}

void Plant::set_motor_control(int robot, MotorControl* control) {
  impl_->controls[static_cast<std::size_t>(robot)] = control;
}

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

void Plant::advance(std::int64_t duration_ns) {
  Impl& p = *impl_;
  if (duration_ns < 0 || duration_ns % p.options.mechanical_step_ns != 0) {
    throw std::logic_error("Plant::advance: " + std::to_string(duration_ns) +
                           " ns is not a multiple of the step of " +
                           std::to_string(p.options.mechanical_step_ns) + " ns");
  }
  if (!p.fault) p.look_for_fault();  // what was written since
  if (p.fault) return;
  std::visit(
      [&](auto& back) {
        for (std::int64_t n = duration_ns / p.step_ns; n > 0; --n) p.step(back);
      },
      p.mechanics);
  p.look_for_fault();
}

RobotSensors Plant::read(int robot) const {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  const RobotModel& model = p.models[n];
  if (p.effects[n]) {
    return read_sensors(*p.effects[n], p.effect_memory[n], p.histories[n], model, p.sensing(n));
  }
  RobotMemory& mem = p.memory[n];
  RobotSensors s{};
  s.now_us = static_cast<std::uint64_t>(p.now_ns / 1000);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double theta_rotor_rad = model.gear_ratio * p.wheel_angles(n)[i];
    if (std::isfinite(theta_rotor_rad)) s.encoder_counts[i] = encoder_counts(model.encoder, theta_rotor_rad);
    s.motor_current_A[i] = mem.current_steps > 0
                               ? mem.current_sum_A[i] / static_cast<double>(mem.current_steps)
                               : mem.winding[i].current_A;
    mem.current_sum_A[i] = 0.0;
  }
  mem.current_steps = 0;
  s.bus_voltage_V = p.electrics[n] ? p.electric_memory[n].supply.bus_voltage_V : model.bus_voltage_V;
  s.gyro_z_rad_s =
      std::visit([&](const auto& m) { return m.motion(p.q, p.u, n).velocity.omega_body_rad_s; }, p.mechanics);
  s.accel_x_m_s2 = mem.accel_x_m_s2;
  s.accel_y_m_s2 = mem.accel_y_m_s2;
  return s;
}

RobotTruth Plant::truth(int robot) const {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(robot);
  RobotTruth t;
  std::visit(
      [&](auto& back) {
        p.set_state(back);
        const BodyMotion m = back.motion(p.q, p.u, n);
        t.x_m = m.x_m, t.y_m = m.y_m, t.yaw_rad = m.yaw_rad;
        t.v_forward_m_s = m.velocity.v_forward_m_s;
        t.v_left_m_s = m.velocity.v_left_m_s;
        t.omega_body_rad_s = m.velocity.omega_body_rad_s;
        const WheelContacts<double>& c = back.contacts(n);
        t.slip_longitudinal_ratio = c.slip_longitudinal_ratio;
        t.force_longitudinal_N = c.force_longitudinal_N;
        t.force_lateral_N = c.force_lateral_N;
        t.load_N = c.load_N;
      },
      p.mechanics);
  for (std::size_t i = 0; i < kWheels; ++i) {
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
  const BodyMotion m = std::visit([&](const auto& back) { return back.motion(p.q, p.u, n); }, p.mechanics);
  if (!p.effects[n] || !p.effects[n]->looks_back()) return {m.x_m, m.y_m, m.yaw_rad};
  const RobotInstant seen = seen_by_camera(*p.effects[n], p.effect_memory[n], p.histories[n], p.sensing(n));
  return {seen.x_m, seen.y_m, seen.yaw_rad};
}

std::vector<std::uint8_t> Plant::save() const {
  const Impl& p = *impl_;
  const std::uint64_t head[3] = {kStateMark, plant_fingerprint(p.models, p.options), p.fault ? 1u : 0u};
  std::vector<std::uint8_t> out;
  append(out, head, 3);
  append(out, &p.now_ns, 1);
  append(out, p.q.data(), p.q.size());
  append(out, p.u.data(), p.u.size());
  append(out, p.memory.data(), p.memory.size());
  for (std::size_t n = 0; n < p.models.size(); ++n) {
    if (p.electrics[n]) append(out, &p.electric_memory[n], 1);
    if (!p.effects[n]) continue;
    append(out, &p.effect_memory[n], 1);
    append(out, &p.histories[n].count(), 1);
    append(out, p.histories[n].points().data(), p.histories[n].points().size());
  }
  return out;
}

bool Plant::restore(std::span<const std::uint8_t> bytes) {
  Impl& p = *impl_;
  if (bytes.size() != save().size()) return false;
  std::uint64_t head[3];
  take(bytes, head, 3);
  if (head[0] != kStateMark || head[1] != plant_fingerprint(p.models, p.options)) return false;
  take(bytes, &p.now_ns, 1);
  take(bytes, p.q.data(), p.q.size());
  take(bytes, p.u.data(), p.u.size());
  take(bytes, p.memory.data(), p.memory.size());
  for (std::size_t n = 0; n < p.models.size(); ++n) {
    if (p.electrics[n]) take(bytes, &p.electric_memory[n], 1);
    if (!p.effects[n]) continue;
    take(bytes, &p.effect_memory[n], 1);
    take(bytes, &p.histories[n].count(), 1);
    take(bytes, p.histories[n].points().data(), p.histories[n].points().size());
  }
  p.fault.reset();
  if (head[2] != 0) p.look_for_fault();
  p.state_known = false;
  return true;
}

}  // namespace omnihil
