#include "sim/robot/electric_wheels.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sim/drive/encoder.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

static_assert(std::is_trivially_copyable_v<ElectricMemory>);

double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

BridgeCommand with_faults(BridgeCommand legs, const WheelDriveInput& in) {
  if (in.phase_lost) legs[0] = {};
  return legs;
}

std::int64_t whole_ns(double time_s) { return std::llround(time_s * 1e9); }

}  // namespace

struct ElectricWheels::StepIntegrals {
  double start_rad_s = 0.0;
  double angle_rad = 0.0, impulse_Nm_s = 0.0, heat_J = 0.0;
  bool held = true;  // in every period
};

ElectricWheels::ElectricWheels(const RobotModel& model, double electrical_step_s, double step_s,
                               std::uint64_t seed, std::size_t robot)
    : model_(model),
      electric_(electrics_of(model)),
      wheels_(model.wheels, WheelElectrics(model, electrical_step_s)),
      step_s_(step_s),
      seed_(seed),
      robot_(robot) {
  periods_ = static_cast<int>(std::lround(step_s / wheels_.front().period_s()));
  const HeatModel& h = electric_.heat;
  if (electric_.has_heat()) {
    thermal_ = thermal_of_datasheet(h.winding_to_housing_K_per_W, h.housing_to_ambient_K_per_W,
                                    h.winding_time_constant_s, h.housing_time_constant_s);
  }
}

ElectricMemory ElectricWheels::initial_memory() const {
  ElectricMemory memory = ElectricMemory();
  const ElectricModel& e = electric_;
  memory.supply.bus_voltage_V = model_.bus_voltage_V;
  if (e.has_battery()) {
    memory.supply.charge_C = e.battery_charge_ratio * e.battery.capacity_C;
    memory.supply.bus_voltage_V = open_circuit_V(e.battery, memory.supply.charge_C);
  }
  return memory;
}

void ElectricWheels::set_faults(const RobotFaults& faults, const RobotFaults& before,
                                ElectricMemory& memory) const {
  memory.supply_ratio = faults.supply_ratio;
  memory.encoder_stuck = faults.encoder_stuck;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    if (faults.winding_rise_K[i] == before.winding_rise_K[i]) continue;
    memory.wheel[i].rise.winding_K = faults.winding_rise_K[i];
  }
}

double ElectricWheels::motor_current_A(const ElectricMemory& memory, std::size_t wheel) const {
  return wheels_[wheel].torque_Nm(memory.wheel[wheel]) / wheels_[wheel].torque_constant_Nm_per_A();
}

ElectricTruth ElectricWheels::truth(const ElectricMemory& memory) const {
  ElectricTruth t;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const WheelElectricState& x = memory.wheel[i];
    t.phase_current_A[i] = wheels_[i].phase_current_A(x);
    t.winding_K[i] = x.rise.winding_K;
    t.housing_K[i] = x.rise.housing_K;
    t.in_inductances_J += wheels_[i].stored_J(x);
  }
  t.bus_voltage_V = memory.supply.bus_voltage_V;
  t.battery_charge_C = memory.supply.charge_C;
  t.book = memory.book;
  return t;
}

int ElectricWheels::hall(std::size_t wheel, double theta_rotor_rad, std::int64_t at_ns) const {
  const HallParams& p = electric_.hall;
  const int code = hall_code(p, model_.motor.pole_pairs * theta_rotor_rad);
  if (p.glitch_probability == 0.0) return code;
  return hall_with_glitches(
      p, code, {seed_, stream_of("hall") + kWheels * robot_ + wheel, static_cast<std::uint64_t>(at_ns)});
}

// One period of one wheel, with the friction that holds or brakes it.
PeriodFlow ElectricWheels::advance_wheel(ElectricMemory& memory, std::size_t wheel, const WheelDriveInput& in,
                                         std::int64_t now_ns, double sample_ratio,
                                         StepIntegrals& integrals) const {
  const WheelElectrics& drive = wheels_[wheel];
  WheelElectricState& x = memory.wheel[wheel];
  const double level_Nm = friction_Nm_[wheel];
  double direction = sign_of(x.omega_rotor_rad_s);
  PeriodInput period{
      .bus_voltage_V = memory.at_bridges_V(), .tau_load_Nm = in.contact_Nm, .sample_ratio = sample_ratio};
  if (direction == 0.0 && level_Nm > 0.0) {
    const double applied_Nm = x.mean_torque_Nm - in.contact_Nm;
    period.held = std::abs(applied_Nm) <= level_Nm;
    direction = sign_of(applied_Nm);
  }
  if (!period.held) period.tau_load_Nm += direction * level_Nm;
  BridgeInput bridge = in.bridge;
  bridge.bus_voltage_V = period.bus_voltage_V;
  if (in.phase_lost && !electric_.three_phase()) bridge.mode = OMNIHIL_DRIVE_COAST;
  PeriodFlow f;
  if (!electric_.three_phase()) {
    f = drive.advance_dc(x, bridge, period);
  } else if (bridge.mode == OMNIHIL_DRIVE_PHASES) {
    f = drive.advance(x, with_faults(drive.firmware_command(x, memory.legs, wheel), in), period);
  } else {
    const int code = hall(wheel, x.theta_rotor_rad, now_ns);
    f = drive.advance(x, with_faults(drive.own_command(x, bridge, code), in), period);
  }
  if (level_Nm > 0.0 && x.omega_rotor_rad_s * direction < 0.0) x.omega_rotor_rad_s = 0.0;
  integrals.held = integrals.held && period.held;
  integrals.angle_rad += f.angle_rad;
  integrals.impulse_Nm_s += f.impulse_Nm_s;
  integrals.heat_J += f.winding_heat_J;
  return f;
}

void ElectricWheels::advance_bus(ElectricMemory& memory, double bus_charge_C) const {
  const ElectricModel& e = electric_;
  const double period_s = wheels_.front().period_s();
  if (!e.has_battery()) {
    memory.book.source_J += model_.bus_voltage_V * bus_charge_C;
    return;
  }
  const double source_V = open_circuit_V(e.battery, memory.supply.charge_C);
  const SupplyFlow<double> flow =
      advance_supply(e.battery, e.bus_capacitance_F, memory.supply, bus_charge_C / period_s, period_s);
  memory.book.source_J += source_V * flow.battery_charge_C;
  memory.book.battery_heat_J += flow.battery_heat_J;
}

double ElectricWheels::measured_A(const PeriodSample& sample, std::size_t wheel, std::size_t phase,
                                  std::int64_t at_ns) const {
  const CurrentSensor& s = electric_.current_sensor;
  const double current_A = shunt_current_A(s, sample, phase);
  const AdcKey key{seed_, stream_of("phase_current") + 3 * (kWheels * robot_ + wheel) + phase,
                   static_cast<std::uint64_t>(at_ns)};
  if (s.bits > 0) return current_of_counts(s, adc_counts(s, current_A, key));
  double input_V = adc_input_V(s, current_A) - 0.5 * s.reference_V;
  if (s.noise_sigma_V > 0.0) input_V += s.noise_sigma_V * gaussian(key.seed, key.stream, key.sample);
  return input_V / (s.shunt_ohm * s.amplifier_gain);
}

void ElectricWheels::see(ElectricMemory& memory, const PerWheel<PeriodFlow>& flows,
                         std::int64_t at_ns) const {
  MotorSensors& seen = memory.seen;
  seen.now_ns = static_cast<std::uint64_t>(at_ns);
  seen.bus_voltage_V = memory.at_bridges_V();
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const PeriodSample& sample = flows[i].sample;
    std::copy_n(flows[i].leg_V.begin(), kLegs, seen.leg_V[i]);
    for (std::size_t x = 0; x < kLegs; ++x) seen.phase_current_A[i][x] = measured_A(sample, i, x, at_ns);
    seen.hall_code[i] = static_cast<std::uint32_t>(hall(i, sample.theta_rotor_rad, at_ns));
    if (memory.encoder_stuck[i]) continue;
    seen.theta_elec_rad[i] =
        wheels_[i].sensed_theta_elec_rad(sample.theta_rotor_rad, sample.omega_rotor_rad_s);
    if (std::isfinite(sample.theta_rotor_rad)) {
      seen.encoder_counts[i] = encoder_counts(model_.encoder, sample.theta_rotor_rad);
    }
  }
}

// A period with a control that runs within it.
void ElectricWheels::advance_within(ElectricMemory& memory, const PerWheel<WheelDriveInput>& inputs,
                                    std::int64_t begin_ns, std::int64_t end_ns, MotorControl& control,
                                    PerWheel<StepIntegrals>& integrals, PerWheel<PeriodFlow>& flows) const {
  const PerWheel<WheelElectricState> wheels_before = memory.wheel;
  const PerWheel<StepIntegrals> integrals_before = integrals;
  for (std::size_t i = 0; i < wheels_.size(); ++i)
    flows[i] = advance_wheel(memory, i, inputs[i], begin_ns, 0.0, integrals[i]);
  see(memory, flows, begin_ns);
  PhasePeriod period{.begin = memory.seen, .end_ns = end_ns};
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    PeriodSample end = flows[i].sample;  // in the middle of the off-time, as at the begin
    end.current_A = wheels_[i].phase_current_A(memory.wheel[i]);
    for (std::size_t x = 0; x < kLegs; ++x) period.end_phase_current_A[i][x] = measured_A(end, i, x, end_ns);
  }
  const PhaseLegs legs = control.phase_period(period);
  const MotorDrive foreseen = memory.legs;
  memory.legs = legs.mean;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const bool same = std::equal(foreseen.leg[i], foreseen.leg[i] + kLegs, legs.mean.leg[i]) &&
                      std::equal(foreseen.leg_duty_ratio[i], foreseen.leg_duty_ratio[i] + kLegs,
                                 legs.mean.leg_duty_ratio[i]);
    if (same || inputs[i].bridge.mode != OMNIHIL_DRIVE_PHASES) continue;
    memory.wheel[i] = wheels_before[i];
    integrals[i] = integrals_before[i];
    flows[i] = advance_wheel(memory, i, inputs[i], begin_ns, 0.0, integrals[i]);
  }
  memory.legs = legs.end;
}

void ElectricWheels::begin_step(ElectricMemory& memory, const PerWheel<WheelDriveInput>& inputs,
                                std::int64_t now_ns, MotorControl* control, PerWheel<WheelStep>& steps) {
  PerWheel<StepIntegrals> integrals;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    WheelElectricState& x = memory.wheel[i];
    x.omega_rotor_rad_s = integrals[i].start_rad_s = model_.gear_ratio * inputs[i].omega_wheel_rad_s;
    x.theta_rotor_rad = model_.gear_ratio * inputs[i].theta_wheel_rad;
    friction_Nm_[i] = model_.motor.coulomb_friction_Nm + inputs[i].friction_rotor_Nm;
    wheels_[i].keep_warm(x);
  }
  const double period_s = wheels_.front().period_s();
  const bool within = electric_.three_phase() && control != nullptr && control->runs_in_periods();
  PerWheel<PeriodFlow> flows;
  for (int n = 0; n < periods_; ++n) {
    const std::int64_t begin_ns = now_ns + whole_ns(n * period_s);
    double bus_charge_C = memory.other_current_A * period_s;
    memory.book.bus_J += bus_charge_C * memory.at_bridges_V();
    if (within) {
      const std::int64_t end_ns = now_ns + whole_ns((n + 1) * period_s);
      advance_within(memory, inputs, begin_ns, end_ns, *control, integrals, flows);
    }
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      if (!within)
        flows[i] =
            advance_wheel(memory, i, inputs[i], begin_ns, electric_.current_sample_ratio, integrals[i]);
      const PeriodFlow& f = flows[i];
      bus_charge_C += f.bus_charge_C;
      memory.book.bus_J += f.bus_charge_C * memory.at_bridges_V();
      memory.book.winding_heat_J += f.winding_heat_J;
      memory.book.device_heat_J += f.device_heat_J;
      memory.book.mechanical_J += f.mechanical_J;
    }
    advance_bus(memory, bus_charge_C);
    if (!electric_.three_phase() || within) continue;
    see(memory, flows, begin_ns + whole_ns(electric_.current_sample_ratio * period_s));
    if (control != nullptr) memory.legs = control->motor_tick(memory.seen);
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    WheelElectricState& x = memory.wheel[i];
    WheelStep step;
    step.drive.mean_torque_Nm = integrals[i].impulse_Nm_s / step_s_;
    step.drive.mean_current_A = step.drive.mean_torque_Nm / wheels_[i].torque_constant_Nm_per_A();
    step.drive.omega_end_rad_s = x.omega_rotor_rad_s;
    step.direction = sign_of(integrals[i].start_rad_s);
    step.torque.locked = integrals[i].held;
    // J (omega_1 - omega_0) / h = T - floor - b mean omega
    const double gain_Nm =
        wheels_[i].inertia_kg_m2() * (x.omega_rotor_rad_s - integrals[i].start_rad_s) / step_s_;
    const double viscous_Nm = model_.motor.viscous_friction_Nm_s_per_rad * integrals[i].angle_rad / step_s_;
    if (!step.torque.locked) step.torque.torque_Nm.fill(gain_Nm + inputs[i].contact_Nm + viscous_Nm);
    steps[i] = step;
    if (electric_.has_heat()) advance_thermal(thermal_, x.rise, integrals[i].heat_J / step_s_, step_s_);
  }
}

double ElectricWheels::end_wheel(std::size_t wheel, const WheelStep& step, double omega_wheel_before_rad_s,
                                 double omega_wheel_after_rad_s) const {
  const double friction_Nm = friction_Nm_[wheel];
  if (step.torque.locked || friction_Nm == 0.0) return omega_wheel_after_rad_s;
  const double predicted_rad_s = step.drive.omega_end_rad_s;
  if (predicted_rad_s == 0.0) return 0.0;  // friction stopped it within the step
  if (predicted_rad_s * omega_wheel_after_rad_s >= 0.0) return omega_wheel_after_rad_s;
  // passed zero against the forecast: past zero |net| - 2 tau_c, never against the motion
  const double net_Nm = std::abs(omega_wheel_after_rad_s - omega_wheel_before_rad_s) / step_s_ *
                        wheels_[wheel].inertia_kg_m2() * model_.gear_ratio;
  return omega_wheel_after_rad_s * std::max(0.0, 1.0 - 2.0 * friction_Nm / net_Nm);
}

}  // namespace omnihil
