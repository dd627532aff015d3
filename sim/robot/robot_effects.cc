#include "sim/robot/robot_effects.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sim/drive/thermal.h"
#include "sim/robot/link_effect.h"

namespace omnihil {

static_assert(std::is_trivially_copyable_v<RobotEffectMemory>);

DriveParams<double> wheel_drive_params(const RobotModel& model) {
  DriveParams<double> p;
  p.resistance_ohm = model.motor.resistance_ohm;
  p.inductance_H = model.motor.inductance_H;
  p.torque_constant_Nm_per_A = model.motor.torque_constant_Nm_per_A;
  p.rotor_inertia_kg_m2 = model.motor.rotor_inertia_kg_m2;
  p.viscous_friction_Nm_s_per_rad = model.motor.viscous_friction_Nm_s_per_rad;
  p.coulomb_friction_Nm = model.motor.coulomb_friction_Nm;
  p.current_limit_A = model.motor.current_limit_A;
  p.duty_limit_ratio = model.motor.duty_limit_ratio;
  p.gear_ratio = model.gear_ratio;
  p.load_inertia_kg_m2 = model.wheel_inertia_kg_m2;
  p.supply_voltage_V = model.bus_voltage_V;
  p.pole_pairs = model.motor.pole_pairs;
  return p;
}

struct RobotEffects::Link {
  double friction_rotor_Nm = 0.0;            // told: rolling resistance, where rotor and wheel are one
  double friction_wheel_Nm = 0.0;            // the same where they are not, through the gear
  mutable double friction_Nm = 0.0;          // learnt: whole level, the larger direction
  mutable double inverse_limit_per_A = 0.0;  // learnt: of the current
};
struct RobotEffects::Links {
  PerWheel<Link> wheel;
};

// Last in the chains of bridge and torque, by its name. It changes nothing but the friction.
struct RobotEffects::LinkEffect {
  static constexpr EffectInfo kInfo =
      link_info("Link between drive and plant", "level += rolling resistance", "rolling_resistance.cc");

  static void bridge(const void* context, const double*, double*, BridgePort<double>& port) {
    static_cast<const Link*>(context)->inverse_limit_per_A = port.inverse_current_limit_per_A;
  }
  static void torque(const void* context, const double*, double*, TorquePort<double>& port) {
    const Link& link = *static_cast<const Link*>(context);
    port.add_friction(link.friction_rotor_Nm);
    link.friction_Nm = std::max(port.friction_positive_Nm, port.friction_negative_Nm);
  }
};

RobotEffects::RobotEffects(const RobotModel& model, double electrical_step_s, int substeps, double step_s)
    : floor(nullptr, model, step_s),
      set_(std::make_shared<EffectSet<double>>(*model.effects)),
      links_(std::make_shared<Links>()),
      substeps_(substeps),
      bus_voltage_V_(model.bus_voltage_V) {
  floor = FloorEffects(set_, model, step_s);
  for (std::size_t i = 0; i < model.wheels; ++i) {
    auto entry = std::make_shared<EffectEntry>();
    entry->info = &LinkEffect::kInfo;
    entry->simulate.bridge = LinkEffect::bridge;
    entry->simulate.torque = LinkEffect::torque;
    entry->context = &links_->wheel[i];
    std::vector<EffectUse> uses = *model.effects;
    uses.push_back({.entry = entry.get(), .values = {1.0}, .tolerances = {}, .name = {}, .owner = {}});
    drives_.emplace_back(wheel_drive_params(model), EffectSet<double>(uses), electrical_step_s);
  }
}

std::vector<RobotModel> models_with_effects(std::span<const RobotModel> robots) {
  std::vector<RobotModel> models(robots.begin(), robots.end());
  for (RobotModel& m : models) {
    if (m.effects == nullptr) continue;
    const EffectSet<double> set(*m.effects);
    if (set.none()) {
      m.effects = nullptr;
    } else {
      m = robot_with_effects(m, set);
    }
  }
  return models;
}

bool has_shaft(const RobotModel& model) {
  return model.effects != nullptr && !EffectSet<double>(*model.effects).shaft.empty();
}

std::vector<RobotModel> models_of_mechanics(std::span<const RobotModel> robots) {
  std::vector<RobotModel> models(robots.begin(), robots.end());
  for (RobotModel& m : models) {
    if (has_shaft(m)) m.motor.rotor_inertia_kg_m2 = m.motor.viscous_friction_Nm_s_per_rad = 0.0;
  }
  return models;
}

std::int64_t mechanics_step_ns(std::span<const RobotModel> robots, const PlantOptions& options) {
  return std::any_of(robots.begin(), robots.end(), has_shaft) ? options.electrical_step_ns
                                                              : options.mechanical_step_ns;
}

AllEffects make_effects(const std::vector<RobotModel>& models, const PlantOptions& o) {
  AllEffects all(models.size());
  const std::int64_t step_ns = mechanics_step_ns(models, o);
  for (std::size_t n = 0; n < models.size(); ++n) {
    if (models[n].effects == nullptr) continue;
    all[n] = std::make_unique<RobotEffects>(models[n], static_cast<double>(o.electrical_step_ns) * 1e-9,
                                            static_cast<int>(step_ns / o.electrical_step_ns),
                                            static_cast<double>(step_ns) * 1e-9);
  }
  return all;
}

std::vector<const FloorEffects*> floors_of(const AllEffects& all) {
  std::vector<const FloorEffects*> floors;
  for (const auto& e : all) floors.push_back(e ? &e->floor : nullptr);
  return floors;
}

RobotEffectMemory RobotEffects::initial_memory() const {
  RobotEffectMemory memory;
  for (std::size_t i = 0; i < drives_.size(); ++i) memory.drive[i] = drives_[i].initial_state();
  memory.timing = memory.drive[0].effects;
  memory.bus_voltage_V = bus_voltage_V_;
  return memory;
}

void RobotEffects::set_faults(const RobotFaults& faults) {
  supply_ratio_ = faults.supply_ratio;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (faults.winding_rise_K[i] == built_.winding_rise_K[i]) continue;
    DriveParams<double> p = drives_[i].params();
    p.resistance_ohm *= warm_resistance_ohm(1.0, kCopperPerK, faults.winding_rise_K[i]) /
                        warm_resistance_ohm(1.0, kCopperPerK, built_.winding_rise_K[i]);
    drives_[i] = DriveSim<double>(p, drives_[i].effects(), drives_[i].step_s());
  }
  built_ = faults;
}

// ------------------------------------------------------------------------------------------ the drives

void RobotEffects::advance(RobotEffectMemory& memory, const PerWheel<WheelDriveInput>& inputs,
                           PerWheel<DriveResult<double>>& results) const {
  PerWheel<DriveInput<double>> in;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    in[i].kind = CommandKind::kDuty;
    in[i].enabled = inputs[i].bridge.mode == OMNIHIL_DRIVE_DUTY;
    in[i].setpoint = inputs[i].bridge.duty_ratio;
    in[i].tau_outside_Nm = -inputs[i].contact_Nm;
    in[i].wheel = static_cast<int>(i);
    in[i].bus_is_measured = supply_ratio_ != 1.0;
    in[i].bus_voltage_V = supply_ratio_ * bus_voltage_V_;
  }
  if (set_->supply.empty()) {
    for (std::size_t i = 0; i < drives_.size(); ++i)
      results[i] = drives_[i].advance(memory.drive[i], in[i], substeps_);
    return;
  }
  PerWheel<double> bus_A{};
  const double share = 1.0 / substeps_;
  for (int n = 0; n < substeps_; ++n) {
    // what each takes from the bus at the sub-step's start: duty times current
    double sum_A = 0.0;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      const double limit = drives_[i].params().duty_limit_ratio;
      bus_A[i] = in[i].enabled ? std::clamp(in[i].setpoint, -limit, limit) * memory.drive[i].current_A : 0.0;
      sum_A += bus_A[i];
    }
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      in[i].other_bus_current_A = sum_A - bus_A[i];
      const DriveResult<double> r = drives_[i].advance(memory.drive[i], in[i], 1);
      DriveResult<double>& sum = results[i];
      sum.held = r.held && (n == 0 || sum.held);
      sum.mean_current_A += share * r.mean_current_A;
      sum.mean_shaft_torque_Nm += share * r.mean_shaft_torque_Nm;
      sum.bus_voltage_V = r.bus_voltage_V;
    }
  }
}

namespace {

// Profile of the torque within the step for the mechanics, which takes viscous friction of its own.
WheelTorque torque_profile(const WheelDriveLaw& law, const DriveResult<double>& r, double start_A,
                           const DriveState<double>& end, const WheelDriveInput& in, double inertia_kg_m2) {
  const auto& motor = law.turning.constants;
  const double k = motor.torque_constant_Nm_per_A;
  const double rest_Nm = r.mean_shaft_torque_Nm - k * r.mean_current_A;
  const double mean_Nm = r.mean_shaft_torque_Nm;
  const double end_Nm = k * end.current_A + rest_Nm;
  // without inductance the current before the step says nothing: a straight line through mean and end
  const double start_Nm = motor.inductance_H > 0.0 ? k * start_A + rest_Nm : 2.0 * mean_Nm - end_Nm;
  const double middle_Nm = (6.0 * mean_Nm - start_Nm - end_Nm) / 4.0;  // Simpson's rule
  // first half of the parabola through the three: (5 start + 8 middle - end) / 24
  const double half_Nm = (5.0 * start_Nm + 8.0 * middle_Nm - end_Nm) / 24.0 - 0.5 * in.contact_Nm;
  const double start_rad_s = law.gear_ratio * in.omega_wheel_rad_s;
  WheelTorque profile;
  profile.omega_rad_s = {start_rad_s, start_rad_s + half_Nm * law.step_s / inertia_kg_m2,
                         end.omega_rotor_rad_s, start_rad_s};
  profile.torque_Nm = {start_Nm, middle_Nm, end_Nm, mean_Nm};
  // the mechanics takes b omega off again
  for (std::size_t part = 0; part < 4; ++part) {
    profile.torque_Nm[part] += law.viscous_Nm_s_per_rad * profile.omega_rad_s[part];
  }
  return profile;
}

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

// A wheel behind its shaft: pushed by it, and held at zero by its own friction.
void push_wheel(double shaft_Nm, double contact_Nm, double friction_Nm, WheelStep& step) {
  const double applied_Nm = shaft_Nm - contact_Nm;
  if (step.direction == 0.0 && friction_Nm > 0.0) {
    step.torque.locked = std::abs(applied_Nm) <= friction_Nm;
    if (step.torque.locked) return;
    step.direction = sign(applied_Nm);
  }
  step.torque.torque_Nm.fill(shaft_Nm - step.direction * friction_Nm);
}

}  // namespace

// Where rotor and wheel are one, the mechanics' wheel says where the rotor is; else it is the drive's output.
void RobotEffects::set_motion(const WheelDriveLaw& law, RobotEffectMemory& memory,
                              const PerWheel<WheelDriveInput>& inputs) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    DriveState<double>& state = memory.drive[i];
    Link& link = links_->wheel[i];
    if (two_masses()) {
      state.omega_output_rad_s = inputs[i].omega_wheel_rad_s;
      state.theta_output_rad = inputs[i].theta_wheel_rad;
      state.has_output = true;
      link.friction_wheel_Nm = inputs[i].friction_rotor_Nm;
    } else {
      state.omega_rotor_rad_s = law.gear_ratio * inputs[i].omega_wheel_rad_s;
      state.theta_rotor_rad = law.gear_ratio * inputs[i].theta_wheel_rad;
      link.friction_rotor_Nm = inputs[i].friction_rotor_Nm;
    }
  }
}

void RobotEffects::begin_step(const WheelDriveLaw& law, RobotEffectMemory& memory,
                              const PerWheel<WheelDriveInput>& inputs, PerWheel<WheelStep>& steps) {
  PerWheel<double> start_A;
  for (std::size_t i = 0; i < drives_.size(); ++i) start_A[i] = memory.drive[i].current_A;
  set_motion(law, memory, inputs);
  PerWheel<DriveResult<double>> results{};
  advance(memory, inputs, results);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveState<double>& end = memory.drive[i];
    const DriveResult<double>& r = results[i];
    WheelStep step;
    step.direction = sign(inputs[i].omega_wheel_rad_s);
    step.rotor_held = r.held;
    step.drive.mean_current_A = r.mean_current_A;
    step.drive.mean_torque_Nm = law.turning.constants.torque_constant_Nm_per_A * r.mean_current_A;
    step.drive.omega_end_rad_s = end.omega_rotor_rad_s;
    if (two_masses()) {
      push_wheel(r.mean_shaft_torque_Nm, inputs[i].contact_Nm, links_->wheel[i].friction_wheel_Nm, step);
    } else if (r.held) {
      step.torque.locked = true;
    } else {
      step.torque = torque_profile(law, r, start_A[i], end, inputs[i], drives_[i].inertia_kg_m2());
      const double used = std::abs(end.current_A) * links_->wheel[i].inverse_limit_per_A;
      if (inputs[i].bridge.mode == OMNIHIL_DRIVE_DUTY && used < 1.0 - 1e-9) {
        step.torque.slope_Nm_s_per_rad =
            law.turning.constants.torque_constant_Nm_per_A * law.mean_sensitivity_A_s_per_rad;
      }
    }
    steps[i] = step;
  }
  memory.bus_voltage_V = results[0].bus_voltage_V;
}

double RobotEffects::end_wheel(const WheelDriveLaw& law, RobotEffectMemory& memory, std::size_t wheel,
                               WheelStep& step, double omega_wheel_before_rad_s,
                               double omega_wheel_after_rad_s) const {
  DriveState<double>& state = memory.drive[wheel];
  if (!step.torque.locked && step.torque.slope_Nm_s_per_rad > 0.0) {
    const double departed_rad_s = law.gear_ratio * omega_wheel_after_rad_s - step.drive.omega_end_rad_s;
    state.current_A -= law.end_sensitivity_A_s_per_rad * departed_rad_s;
    const double mean_A = -law.mean_sensitivity_A_s_per_rad * 0.5 * departed_rad_s;
    step.drive.mean_current_A += mean_A;
    step.drive.mean_torque_Nm += law.turning.constants.torque_constant_Nm_per_A * mean_A;
  }
  memory.charge_C[wheel] += step.drive.mean_current_A * law.step_s;
  const Link& link = links_->wheel[wheel];
  const double friction_Nm = two_masses() ? link.friction_wheel_Nm : link.friction_Nm;
  if (step.torque.locked || friction_Nm == 0.0) return omega_wheel_after_rad_s;
  const double predicted_rad_s = two_masses() ? step.direction : step.drive.omega_end_rad_s;
  if (predicted_rad_s == 0.0) return 0.0;  // friction stopped it within the step
  if (predicted_rad_s * omega_wheel_after_rad_s >= 0.0) return omega_wheel_after_rad_s;
  // net torque before zero |net|; past zero |net| - 2 tau_c, never against the motion
  const double net_Nm = std::abs(omega_wheel_after_rad_s - omega_wheel_before_rad_s) / law.step_s *
                        law.spin_inertia_kg_m2 / law.gear_ratio;
  return omega_wheel_after_rad_s * std::max(0.0, 1.0 - 2.0 * friction_Nm / net_Nm);
}

}  // namespace omnihil
