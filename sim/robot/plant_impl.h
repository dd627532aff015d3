// The state of a plant and one mechanical step of it; plant.h says what it does, plant.cc is its outside.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/drive/thermal.h"
#include "sim/robot/electric_wheels.h"
#include "sim/robot/mechanics_group.h"
#include "sim/robot/planar_law.h"
#include "sim/robot/plant.h"
#include "sim/robot/robot_effects.h"
#include "sim/robot/robot_faults.h"
#include "sim/robot/robot_sensing.h"
#include "sim/robot/wheel_drive.h"

namespace omnihil {

inline constexpr double kSpacing_m = 0.3;              // of the robots' starting row
inline constexpr double kDribblerFull_rad_s = 1000.0;  // at ratio 1; guess, +-50 %
// Robots of one Simbody system, where systems run side by side. A choice: a system costs four fifths of a robot by itself (measured).
inline constexpr std::size_t kGroupRobots = 3;
inline constexpr double kStandstill_m_s = 1e-12;  // below it a robot with held wheels stops exactly

// What one robot remembers besides positions and speeds; plain bytes, saved as they are.
struct RobotMemory {
  RobotDrive drive{};
  PerWheel<std::uint32_t> mode{};  // of `drive`, of all wheels
  PerWheel<double> duty_ratio{};
  PerWheel<DcDriveState> winding{};
  PerWheel<double> motor_torque_Nm{};  // mean of the last step
  PerWheel<double> current_sum_A{};    // of the steps since the last sample
  std::int64_t current_steps = 0;
  double accel_x_m_s2 = 0.0, accel_y_m_s2 = 0.0;
  RobotFaults faults{};
  PerWheel<std::int64_t> counts_read{};  // at the last sample
};
static_assert(std::is_trivially_copyable_v<RobotMemory>);

struct Plant::Impl {
  Impl(std::span<const RobotModel> robots_, const PlantOptions& options_)
      : options(options_),
        models(robots_.begin(), robots_.end()),
        effects(make_effects(models, options_)),
        memory(models.size()),
        electrics(models.size()),
        electric_memory(models.size()),
        controls(models.size()),
        wheel_steps(models.size()) {
    make_groups(1);
    layout = groups.front().layout;
    step_ns = mechanics_step_ns(models, options);
    step_s = static_cast<double>(step_ns) * 1e-9;
    substeps = static_cast<int>(step_ns / options.electrical_step_ns);
    const std::vector<RobotModel> moved = models_of_mechanics(models);
    drives.resize(models.size());
    healthy.reserve(models.size());
    for (std::size_t n = 0; n < models.size(); ++n) {
      healthy.push_back(law_of(moved[n]));
      drives[n].fill(healthy[n]);
      bodies.push_back(planar_body(models[n]));
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

  void make_groups(std::size_t count) {
    const std::vector<RobotModel> moved = models_of_mechanics(models);
    const std::vector<const FloorEffects*> floors = floors_of(effects);
    groups.clear();
    group_of.clear();
    for (std::size_t g = 0; g < count; ++g) {
      const std::size_t first = g * models.size() / count, end = (g + 1) * models.size() / count;
      const auto part = [&](const auto& all) {
        return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first),
                           all.begin() + static_cast<std::ptrdiff_t>(end));
      };
      groups.emplace_back(first, make_mechanics(part(moved), options.physics, part(floors)), end - first);
      group_of.resize(end, g);
    }
  }

  // The same robots in so many systems, as they are.
  void regroup(std::size_t count) {
    if (count == groups.size()) return;
    std::vector<double> q, u;
    for (const MechanicsGroup& group : groups) {
      q.insert(q.end(), group.q.begin(), group.q.end());
      u.insert(u.end(), group.u.begin(), group.u.end());
    }
    make_groups(count);
    for (std::size_t n = 0; n < models.size(); ++n) {
      std::copy_n(&q[n * layout.q_per_robot], layout.q_per_robot, pose(n));
      std::copy_n(&u[n * layout.u_per_robot], layout.u_per_robot, speeds(n));
      group(n).lift(n, memory[n].faults.lifted);
    }
  }
  void regroup() {
    const bool apart = workers != nullptr && any_aside() && options.physics != Physics::kPlanar;
    regroup(apart ? (models.size() + kGroupRobots - 1) / kGroupRobots : 1);
  }

  MechanicsGroup& group(std::size_t n) { return groups[group_of[n]]; }
  const MechanicsGroup& group(std::size_t n) const { return groups[group_of[n]]; }
  double* pose(std::size_t n) { return group(n).pose(n); }
  const double* pose(std::size_t n) const { return group(n).pose(n); }
  double* speeds(std::size_t n) { return group(n).speeds(n); }
  const double* speeds(std::size_t n) const { return group(n).speeds(n); }
  BodyMotion motion(std::size_t n) const { return group(n).motion(n); }
  void forget_states() {
    for (MechanicsGroup& of : groups) of.state_known = false;
  }

  WheelDriveLaw law_of(const RobotModel& moved) const {
    return wheel_drive_law(moved, static_cast<double>(options.electrical_step_ns) * 1e-9, substeps);
  }

  // Brings laws and mechanics to memory[n].faults; `before`: those in force so far.
  void apply_faults(std::size_t n, const RobotFaults& before) {
    const RobotFaults& faults = memory[n].faults;
    for (std::size_t i = 0; i < wheels(n); ++i) {
      drives[n][i] = healthy[n];
      if (faults.winding_rise_K[i] != 0.0) {
        RobotModel warm = models_of_mechanics({&models[n], 1}).front();
        warm.motor.resistance_ohm =
            warm_resistance_ohm(warm.motor.resistance_ohm, kCopperPerK, faults.winding_rise_K[i]);
        drives[n][i] = law_of(warm);
      }
      if (!faults.blocked[i]) continue;
      drives[n][i].coulomb_Nm = kBlocked_Nm;
      wheel_speeds_of(n)[i] = 0.0;
    }
    if (effects[n]) effects[n]->set_faults(faults);
    if (electrics[n]) electrics[n]->set_faults(faults, before, electric_memory[n]);
    group(n).lift(n, faults.lifted);
  }

  // An impulse that changes body speeds so; the accelerometer sees it as its mean over the step.
  void add_velocity(std::size_t n, double v_x_m_s, double v_y_m_s, double omega_rad_s) {
    double* v = field_velocity(n);
    v[0] += v_x_m_s;
    v[1] += v_y_m_s;
    speeds(n)[free() ? 2 : 0] += omega_rad_s;
    const double yaw_rad = motion(n).yaw_rad;
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    memory[n].accel_x_m_s2 += (c * v_x_m_s + s * v_y_m_s) / step_s;
    memory[n].accel_y_m_s2 += (-s * v_x_m_s + c * v_y_m_s) / step_s;
    group(n).state_known = false;
  }

  // v += a h, omega += alpha h of the force alone (planar_law.h).
  void disturb(std::size_t n, const Heading& to) {
    const RobotFaults& f = memory[n].faults;
    if (f.force_forward_N == 0.0 && f.force_left_N == 0.0 && f.moment_Nm == 0.0) return;
    const auto a = body_acceleration(bodies[n], f.force_forward_N, f.force_left_N, f.moment_Nm, 0.0);
    double* v = field_velocity(n);
    v[0] += step_s * (to.cos_yaw * a.x_m_s2 - to.sin_yaw * a.y_m_s2);
    v[1] += step_s * (to.sin_yaw * a.x_m_s2 + to.cos_yaw * a.y_m_s2);
    speeds(n)[free() ? 2 : 0] += step_s * a.yaw_rad_s2;
  }

  std::size_t wheels(std::size_t robot) const { return models[robot].wheels; }
  const double* wheel_angles(std::size_t robot) const { return pose(robot) + layout.wheel_q; }
  double* wheel_angles(std::size_t robot) { return pose(robot) + layout.wheel_q; }
  const double* wheel_speeds_of(std::size_t robot) const { return speeds(robot) + layout.wheel_u; }
  double* wheel_speeds_of(std::size_t robot) { return speeds(robot) + layout.wheel_u; }
  // Field-frame v_x of a robot; v_y follows.
  std::size_t field_u() const { return layout.wheel_u - (free() ? 3 : 2); }
  const double* field_velocity(std::size_t robot) const { return speeds(robot) + field_u(); }
  double* field_velocity(std::size_t robot) { return speeds(robot) + field_u(); }
  bool free() const { return options.physics == Physics::kSimbodyFree; }

  void place(std::size_t robot, double x_m, double y_m, double yaw_rad) {
    PerWheel<double> angles;
    std::copy_n(wheel_angles(robot), wheels(robot), angles.begin());
    group(robot).place(robot, x_m, y_m, yaw_rad);
    std::copy_n(angles.begin(), wheels(robot),
                wheel_angles(robot));  // turning a robot by hand turns no rotor
    const RobotMemory kept = memory[robot];
    memory[robot] = RobotMemory{};
    memory[robot].drive = kept.drive;
    memory[robot].mode = kept.mode;
    memory[robot].duty_ratio = kept.duty_ratio;
    memory[robot].faults = kept.faults;
    if (electrics[robot]) electric_memory[robot] = electrics[robot]->initial_memory();
    if (effects[robot]) {
      PerWheel<double> rotors{};
      for (std::size_t i = 0; i < wheels(robot); ++i) rotors[i] = theta_rotor_rad(robot, i);
      effect_memory[robot] = effects[robot]->initial_memory();
      RobotEffectMemory& mem = effect_memory[robot];
      for (std::size_t i = 0; i < wheels(robot); ++i) mem.drive[i].theta_rotor_rad = rotors[i];
      mem.seen_s = mem.read_s = now_s();
      for (std::size_t i = 0; i < wheels(robot); ++i) mem.seen_theta_rotor_rad[i] = theta_rotor_rad(robot, i);
      histories[robot].clear();
      remember(robot);
    }
    apply_faults(robot, {});
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
    const BodyMotion m = motion(n);
    p.time_s = now_s();
    p.x_m = m.x_m, p.y_m = m.y_m, p.yaw_rad = m.yaw_rad;
    p.gyro_rad_s = m.velocity.omega_body_rad_s;
    p.accel_x_m_s2 = memory[n].accel_x_m_s2;
    p.accel_y_m_s2 = memory[n].accel_y_m_s2;
    p.bus_voltage_V = effect_memory[n].bus_voltage_V;
    for (std::size_t i = 0; i < wheels(n); ++i) {
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
    for (std::size_t i = 0; i < wheels(n); ++i) at.current_A[i] = memory[n].winding[i].current_A;
    return at;
  }

  BridgeInput bridge_input(std::size_t n, std::size_t i) const {
    const RobotMemory& mem = memory[n];
    const bool open = mem.faults.phase_lost[i] && !electrics[n];
    const std::uint32_t mode = open ? std::uint32_t{OMNIHIL_DRIVE_COAST} : mem.mode[i];
    return {mode, mem.duty_ratio[i], mem.faults.supply_ratio * models[n].bus_voltage_V};
  }

  WheelTorques& torques_of(std::size_t n) { return group(n).torques[n - group(n).first]; }

  void begin_wheels(std::size_t n, const WheelContacts<double>& contacts) {
    const RobotModel& model = models[n];
    RobotMemory& mem = memory[n];
    const double* omega_wheel = wheel_speeds_of(n);
    for (std::size_t i = 0; i < wheels(n); ++i) {
      const double contact_Nm = model.wheel_radius_m * contacts.force_longitudinal_N[i] / model.gear_ratio;
      const BridgeInput bridge = bridge_input(n, i);
      const WheelStep step = begin_wheel_step(drives[n][i], mem.winding[i], bridge,
                                              model.gear_ratio * omega_wheel[i], contact_Nm);
      wheel_steps[n][i] = step;
      torques_of(n)[i] = step.torque;
    }
  }

  void begin_electric_wheels(std::size_t n, const PerWheel<WheelDriveInput>& inputs) {
    electrics[n]->begin_step(electric_memory[n], inputs, now_ns, controls[n], wheel_steps[n]);
    if (effects[n]) effect_memory[n].bus_voltage_V = electric_memory[n].at_bridges_V();
    for (std::size_t i = 0; i < wheels(n); ++i) torques_of(n)[i] = wheel_steps[n][i].torque;
  }

  // `more`: of floor effects; null: none.
  PerWheel<WheelDriveInput> wheel_inputs(std::size_t n, const WheelContacts<double>& contacts,
                                         const FloorForces* more) const {
    const RobotModel& model = models[n];
    const double* omega_wheel = wheel_speeds_of(n);
    PerWheel<WheelDriveInput> inputs;
    for (std::size_t i = 0; i < wheels(n); ++i) {
      WheelDriveInput& in = inputs[i];
      in.bridge = bridge_input(n, i);
      in.phase_lost = memory[n].faults.phase_lost[i];
      in.omega_wheel_rad_s = omega_wheel[i];
      in.theta_wheel_rad = wheel_angles(n)[i];
      const double radius_m = more != nullptr ? more->wheel_radius_m[i] : model.wheel_radius_m;
      in.contact_Nm = radius_m * contacts.force_longitudinal_N[i] / model.gear_ratio;
      if (more != nullptr) in.friction_rotor_Nm = more->friction_wheel_Nm[i] / model.gear_ratio;
      if (memory[n].faults.blocked[i]) in.friction_rotor_Nm = kBlocked_Nm;
    }
    return inputs;
  }

  void begin_wheels_with_effects(std::size_t n, const PerWheel<WheelDriveInput>& inputs) {
    effects[n]->begin_step(healthy[n], effect_memory[n], inputs, wheel_steps[n]);
    for (std::size_t i = 0; i < wheels(n); ++i) torques_of(n)[i] = wheel_steps[n][i].torque;
  }

  // Touches nothing of another robot's.
  template <typename Back>
  void begin_robot(const Back& back, std::size_t n) {
    const std::size_t i = n - group(n).first;
    if (electrics[n]) {
      const FloorForces* more = effects[n] ? &back.floor_forces(i) : nullptr;
      begin_electric_wheels(n, wheel_inputs(n, back.contacts(i), more));
    } else if (effects[n]) {
      begin_wheels_with_effects(n, wheel_inputs(n, back.contacts(i), &back.floor_forces(i)));
    } else {
      begin_wheels(n, back.contacts(i));
    }
  }
  void begin_robot(std::size_t n) {
    std::visit([&](const auto& back) { begin_robot(back, n); }, group(n).mechanics);
  }

  // Some control runs aside, and none that there is does not.
  bool any_aside() const {
    bool any = false;
    for (const MotorControl* control : controls) {
      if (control != nullptr && !control->runs_aside()) return false;
      any = any || control != nullptr;
    }
    return any;
  }

  void each_robot(bool aside, auto&& work) {
    if (aside) {
      workers->each(models.size(), work);
    } else {
      for (std::size_t n = 0; n < models.size(); ++n) work(n);
    }
  }

  void step() {
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (effects[n]) effects[n]->floor.dribbler_rad_s = memory[n].drive.dribbler_ratio * kDribblerFull_rad_s;
    }
    for (MechanicsGroup& of : groups) of.set_state();
    each_robot(workers != nullptr && any_aside(), [&](std::size_t n) { begin_robot(n); });
    if (groups.size() > 1) {
      workers->each(groups.size(), [&](std::size_t g) { move(groups[g]); });
    } else {
      move(groups.front());
    }
    now_ns += step_ns;
    for (std::size_t n = 0; n < models.size(); ++n) {
      if (effects[n]) remember(n);
    }
  }

  // Touches nothing of another group's. What no effect acts on is looked at once more by whoever comes next, and is
  // therefore brought up to date here, where groups run side by side.
  void move(MechanicsGroup& of) {
    of.u_before = of.u;
    std::visit(
        [&](auto& back) {
          integrate(options.integrator, back, of.torques, step_s, of.q, of.u, of.scratch);
          for (std::size_t i = 0; i < of.robots; ++i) end_robot(back, of.first + i);
        },
        of.mechanics);
    of.state_known = false;
    if (groups.size() > 1 && std::none_of(effects.begin(), effects.end(), [](const auto& e) { return !!e; }))
      of.set_state();
  }

  template <typename Back>
  void end_robot(Back& back, std::size_t n) {
    const MechanicsGroup& of = group(n);
    const double* u_before = &of.u_before[(n - of.first) * layout.u_per_robot];
    const double* before = u_before + layout.wheel_u;
    double* after = wheel_speeds_of(n);
    bool held = true;
    for (std::size_t i = 0; i < wheels(n); ++i) {
      WheelStep& step = wheel_steps[n][i];
      if (electrics[n]) {
        after[i] = electrics[n]->end_wheel(i, step, before[i], after[i]);
        memory[n].winding[i].current_A = electrics[n]->motor_current_A(electric_memory[n], i);
        effect_memory[n].charge_C[i] += step.drive.mean_current_A * step_s;
      } else if (effects[n]) {
        after[i] = effects[n]->end_wheel(healthy[n], effect_memory[n], i, step, before[i], after[i]);
        memory[n].winding[i].current_A = effect_memory[n].drive[i].current_A;
      } else {
        after[i] = end_wheel_step(drives[n][i], memory[n].winding[i], step, before[i], after[i]);
      }
      memory[n].motor_torque_Nm[i] = step.drive.mean_torque_Nm;
      memory[n].current_sum_A[i] += step.drive.mean_current_A;
      held = held && (step.torque.locked || (two_masses(n) && step.rotor_held));
    }
    ++memory[n].current_steps;
    if (held && !free()) come_to_rest(n);
    const Heading to = back.heading(of.q, n - of.first);
    disturb(n, to);
    const double* v0 = u_before + field_u();
    const double* v1 = field_velocity(n);
    const double ax = (v1[0] - v0[0]) / step_s, ay = (v1[1] - v0[1]) / step_s;
    memory[n].accel_x_m_s2 = to.cos_yaw * ax + to.sin_yaw * ay;
    memory[n].accel_y_m_s2 = -to.sin_yaw * ax + to.cos_yaw * ay;
  }

  // The floor's viscous hold would let the speed fade for ever, into numbers that cost time to compute with.
  void come_to_rest(std::size_t n) {
    double* body = speeds(n);
    double* omega_wheel = wheel_speeds_of(n);
    const auto stands = [](double v_m_s) { return std::abs(v_m_s) < kStandstill_m_s; };
    const bool rims_stand = std::all_of(omega_wheel, omega_wheel + wheels(n), [&](double omega) {
      return stands(omega * models[n].wheel_radius_m);
    });
    if (stands(body[0] * models[n].wheel_center_radius_m) && stands(body[1]) && stands(body[2]) &&
        rims_stand) {
      body[0] = body[1] = body[2] = 0.0;
      std::fill_n(omega_wheel, wheels(n), 0.0);
    }
  }

  void report(std::size_t robot, std::string_view signal, std::size_t index) {
    if (!fault) fault = PlantFault{now_ns, static_cast<int>(robot), signal, static_cast<int>(index)};
  }

  // All of a robot's numbers at once, two by two: x - x is 0 of a finite one, and of no other.
  bool all_finite(std::size_t n) const {
    using Pair [[gnu::vector_size(16)]] = double;
    Pair rest{};
    const auto add = [&rest](const double* values, std::size_t count) {
      std::size_t i = 0;
      for (; i + 1 < count; i += 2) {
        const Pair two{values[i], values[i + 1]};
        rest += two - two;
      }
      if (i < count) rest[0] += values[i] - values[i];
    };
    const RobotMemory& mem = memory[n];
    const MechanicsGroup& of = group(n);
    const std::size_t count = wheels(n);
    add(&electric_memory[n].legs.leg_duty_ratio[0][0], kWheels * kLegs);  // wheel after wheel
    add(mem.duty_ratio.data(), kMaxWheels);
    for (std::size_t i = 0; i < kMaxWheels; ++i)
      rest[0] += mem.winding[i].current_A - mem.winding[i].current_A;
    add(of.pose(n), layout.wheel_q + count);
    add(of.speeds(n), layout.wheel_u + count);
    return rest[0] + rest[1] == 0.0;
  }

  void look_for_fault() {
    for (std::size_t n = 0; n < models.size() && !fault; ++n) {
      if (all_finite(n)) continue;
      const auto scan = [&](const double* values, std::size_t count, std::string_view signal) {
        for (std::size_t i = 0; i < count; ++i) {
          if (!std::isfinite(values[i])) report(n, signal, i);
        }
      };
      for (const auto& legs : electric_memory[n].legs.leg_duty_ratio) scan(legs, kLegs, "leg_duty_ratio");
      for (std::size_t i = 0; i < wheels(n); ++i) {
        if (!std::isfinite(memory[n].duty_ratio[i])) report(n, "duty_ratio", i);
        if (!std::isfinite(memory[n].winding[i].current_A)) report(n, "motor_current_A", i);
      }
      scan(wheel_speeds_of(n), wheels(n), "omega_wheel_rad_s");
      scan(wheel_angles(n), wheels(n), "theta_wheel_rad");
      scan(speeds(n), layout.wheel_u, "body_velocity");
      scan(pose(n), layout.wheel_q, "pose");
    }
  }

  PlantOptions options;
  std::vector<RobotModel> models;
  AllEffects effects;  // before the mechanics, which points into it
  std::vector<MechanicsGroup> groups;
  std::vector<std::size_t> group_of;  // of each robot
  StateLayout layout;
  std::int64_t step_ns = 0;  // of the mechanics: that of the options, or a part of it
  double step_s = 0.0;
  int substeps = 1;
  std::int64_t now_ns = 0;
  std::vector<RobotMemory> memory;
  std::vector<RobotEffectMemory> effect_memory;
  std::vector<RobotHistory> histories;
  std::vector<std::unique_ptr<ElectricWheels>> electrics;  // null: DC-equivalent on a constant bus
  std::vector<ElectricMemory> electric_memory;
  std::vector<MotorControl*> controls;
  Workers* workers = nullptr;
  std::vector<WheelDriveLaw> healthy;           // per robot
  std::vector<PerWheel<WheelDriveLaw>> drives;  // with the faults in force
  std::vector<PlanarBody<double>> bodies;
  std::vector<PerWheel<WheelStep>> wheel_steps;
  std::optional<PlantFault> fault;
};

}  // namespace omnihil
