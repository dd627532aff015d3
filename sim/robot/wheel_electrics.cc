#include "sim/robot/wheel_electrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace omnihil {
namespace {

static_assert(std::is_trivially_copyable_v<WheelElectricState>);

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kThird = kTwoPi / 3.0;
constexpr double kRoot3 = std::numbers::sqrt3;
constexpr double kRebuild_K = 0.1;
// A rotor that does not turn: so heavy that no motor moves it by a rounding error within a run's step.
constexpr double kHeldRotorInertia_kg_m2 = 1e12;

std::array<double, 3> phases_of(double d, double q, double theta_elec_rad) {
  std::array<double, 3> x;
  for (std::size_t n = 0; n < 3; ++n) {
    const double angle = theta_elec_rad - kThird * static_cast<double>(n);
    x[n] = d * std::cos(angle) - q * std::sin(angle);
  }
  return x;
}

struct Dq {
  double d = 0.0, q = 0.0;
};

// Amplitude-invariant; what the three have in common drops out.
Dq dq_of(const std::array<double, 3>& x, double theta_elec_rad) {
  Dq y;
  for (std::size_t n = 0; n < 3; ++n) {
    const double angle = theta_elec_rad - kThird * static_cast<double>(n);
    y.d += 2.0 / 3.0 * x[n] * std::cos(angle);
    y.q -= 2.0 / 3.0 * x[n] * std::sin(angle);
  }
  return y;
}

bool complementary(const LegCommand& c) { return c.on == LegState::kHigh && c.off == LegState::kLow; }

std::array<double, kLegs> means_of(const PhaseFlow& flow) {
  std::array<double, kLegs> leg_V{};
  for (std::size_t n = 0; n < kLegs; ++n) leg_V[n] = flow.leg_V_s[n] / flow.time_s;
  return leg_V;
}

LegState leg_at(const LegCommand& c, double ratio) {
  // centred on-time; its edges belong to it
  return std::abs(ratio - 0.5) <= 0.5 * c.duty_ratio && c.duty_ratio > 0.0 ? c.on : c.off;
}

}  // namespace

WheelElectrics::WheelElectrics(const RobotModel& model, double electrical_step_s)
    : model_(model), electric_(electrics_of(model)) {
  const ElectricModel& e = electric_;
  period_s_ = e.three_phase() ? 1.0 / e.inverter.pwm_frequency_Hz : electrical_step_s;
  extra_inertia_kg_m2_ = model.wheel_inertia_kg_m2 / (model.gear_ratio * model.gear_ratio);
  inertia_kg_m2_ = model.motor.rotor_inertia_kg_m2 + extra_inertia_kg_m2_;
  torque_constant_Nm_per_A_ = e.three_phase()
                                  ? omnihil::torque_constant_Nm_per_A(phase_motor(model), own_commutation(e))
                                  : model.motor.torque_constant_Nm_per_A;
  make({});
}

void WheelElectrics::make(const ThermalState<double>& rise) {
  const ElectricModel& e = electric_;
  made_for_ = rise;
  const double flux = warm_flux_Wb(1.0, e.heat.magnet_per_K, rise.housing_K);
  warm_constant_Nm_per_A_ = flux * torque_constant_Nm_per_A_;
  if (!e.three_phase()) {
    MotorParams motor = model_.motor;
    motor.resistance_ohm = warm_resistance_ohm(motor.resistance_ohm, e.heat.copper_per_K, rise.winding_K);
    motor.torque_constant_Nm_per_A *= flux;
    dc_ = make_dc_drive(motor, extra_inertia_kg_m2_, period_s_);
    dc_held_ = make_dc_drive(motor, kHeldRotorInertia_kg_m2, period_s_);
    return;
  }
  PhaseMotor<double> m = phase_motor(model_);
  m.resistance_ohm = warm_resistance_ohm(m.resistance_ohm, e.heat.copper_per_K, rise.winding_K);
  m.flux_linkage_Wb *= flux;
  averaged_ = make_averaged_drive(m, e.inverter, period_s_, extra_inertia_kg_m2_);
  switched_ = make_switched_drive(m, e.inverter, {.extra_inertia_kg_m2 = extra_inertia_kg_m2_});
  motor_ = m;
  motor_.resistance_ohm += e.inverter.switch_resistance_ohm;
}

void WheelElectrics::keep_warm(WheelElectricState& x) {
  if (std::abs(x.rise.winding_K - x.built.winding_K) > kRebuild_K ||
      std::abs(x.rise.housing_K - x.built.housing_K) > kRebuild_K) {
    x.built = x.rise;
  }
  if (made_for_.winding_K != x.built.winding_K || made_for_.housing_K != x.built.housing_K) make(x.built);
}

std::array<double, 3> WheelElectrics::phase_current_A(const WheelElectricState& x) const {
  if (electric_.kind == DriveKind::kSwitched) return x.switched.motor.current_A;
  if (electric_.kind == DriveKind::kDc) return {};
  return phases_of(x.dq.i_d_A, x.dq.i_q_A, motor_.pole_pairs * x.theta_rotor_rad);
}

double WheelElectrics::torque_Nm(const WheelElectricState& x) const {
  switch (electric_.kind) {
    case DriveKind::kDc:
      return dc_.constants.torque_constant_Nm_per_A * x.dc.current_A;
    case DriveKind::kDq:
      return dq_torque_Nm(motor_, x.dq.i_d_A, x.dq.i_q_A);
    case DriveKind::kSwitched:
      break;
  }
  const std::array<double, 3> k = phase_constants(switched_.circuit, x.theta_rotor_rad);
  const auto& i = x.switched.motor.current_A;
  return k[0] * i[0] + k[1] * i[1] + k[2] * i[2];
}

double WheelElectrics::stored_J(const WheelElectricState& x) const {
  switch (electric_.kind) {
    case DriveKind::kDc:
      return 0.5 * dc_.constants.inductance_H * x.dc.current_A * x.dc.current_A;
    case DriveKind::kDq:
      return dq_stored_J(motor_, x.dq.i_d_A, x.dq.i_q_A);
    case DriveKind::kSwitched:
      break;
  }
  return omnihil::stored_J(switched_.circuit, x.switched.motor);
}

double WheelElectrics::sensed_theta_elec_rad(double theta_rotor_rad, double omega_rotor_rad_s) const {
  const AbsoluteEncoderParams& p = electric_.angle;
  const double theta_rad =
      p.bits == 0 ? absolute_encoder_angle_rad(p, theta_rotor_rad, omega_rotor_rad_s)
                  : absolute_encoder_rad(p, absolute_encoder_code(p, theta_rotor_rad, omega_rotor_rad_s));
  const double elec_rad = std::fmod(motor_.pole_pairs * theta_rad, kTwoPi);
  return elec_rad < 0.0 ? elec_rad + kTwoPi : elec_rad;
}

double WheelElectrics::limited_voltage_V(const WheelElectricState& x, double wanted_V, double bus_V) const {
  const double limit_A = model_.motor.current_limit_A;
  if (limit_A > 0.0) {
    const double resistance_ohm = 2.0 * motor_.resistance_ohm;
    const double rate_V_per_A = (motor_.inductance_d_H + motor_.inductance_q_H) / period_s_;
    const double current_A = torque_Nm(x) / warm_constant_Nm_per_A_;
    const double emf_V = warm_constant_Nm_per_A_ * x.omega_rotor_rad_s;
    // U = k omega + R I_limit + L (I_limit - I) / h, either sign of the limit
    const double highest_V = emf_V + resistance_ohm * limit_A + rate_V_per_A * (limit_A - current_A);
    const double lowest_V = emf_V - resistance_ohm * limit_A - rate_V_per_A * (limit_A + current_A);
    wanted_V = std::max(lowest_V, std::min(highest_V, wanted_V));
  }
  return std::clamp(wanted_V, -bus_V, bus_V);
}

BridgeCommand WheelElectrics::own_command(const WheelElectricState& x, const BridgeInput& bridge,
                                          int hall_code) const {
  if (bridge.mode != OMNIHIL_DRIVE_DUTY || !(bridge.bus_voltage_V > 0.0)) return {};
  const double largest = model_.motor.duty_limit_ratio, bus_V = bridge.bus_voltage_V;
  const double duty = std::clamp(bridge.duty_ratio, -largest, largest);
  const double volt_V = limited_voltage_V(x, duty * bus_V, bus_V);
  if (electric_.kind == DriveKind::kSwitched) {
    const int sector = hall_sector(hall_code);
    if (sector < 0) return {};
    if (volt_V == 0.0) return sine_command({0.0, 0.0, 0.0});
    const BlockLegs legs = block_legs(sector);
    return block_command(volt_V > 0.0 ? legs.high : legs.low, volt_V > 0.0 ? legs.low : legs.high,
                         std::abs(volt_V) / bus_V, electric_.pwm_mode);
  }
  const double most_V = bus_V / kRoot3, omega_elec = motor_.pole_pairs * x.omega_rotor_rad_s;
  const double theta = sensed_theta_elec_rad(x.theta_rotor_rad, x.omega_rotor_rad_s);
  const double error = std::remainder(theta - motor_.pole_pairs * x.theta_rotor_rad, kTwoPi);
  // the board's currents are in its own frame, turned by the sensor's error
  const Dq seen = {x.dq.i_d_A * std::cos(error) + x.dq.i_q_A * std::sin(error),
                   x.dq.i_q_A * std::cos(error) - x.dq.i_d_A * std::sin(error)};
  const double v_d = std::clamp(-omega_elec * motor_.inductance_q_H * seen.q, -most_V, most_V);
  const double left_V = std::sqrt(std::max(0.0, most_V * most_V - v_d * v_d));
  const double v_q = std::clamp(volt_V / kRoot3, -left_V, left_V);
  const std::array<double, 3> v = phases_of(v_d, v_q, theta + 0.5 * period_s_ * omega_elec);
  // largest and smallest equally far from the rails
  const double middle_V = 0.5 * (std::max({v[0], v[1], v[2]}) + std::min({v[0], v[1], v[2]}));
  std::array<double, 3> share;
  for (std::size_t n = 0; n < 3; ++n) share[n] = std::clamp(0.5 + (v[n] - middle_V) / bus_V, 0.0, 1.0);
  return sine_command(share);
}

BridgeCommand WheelElectrics::firmware_command(const WheelElectricState& x, const MotorDrive& legs,
                                               std::size_t wheel) const {
  const double limit_A = model_.motor.current_limit_A * (2.0 / kRoot3);
  BridgeCommand command{};
  if (limit_A > 0.0) {
    for (const double i : phase_current_A(x)) {
      if (std::abs(i) > limit_A) return command;
    }
  }
  for (std::size_t n = 0; n < 3; ++n) {
    const double duty = legs.leg_duty_ratio[wheel][n];
    switch (legs.leg[wheel][n]) {
      case OMNIHIL_LEG_PWM:
        command[n] = {LegState::kHigh, LegState::kLow, duty};
        break;
      case OMNIHIL_LEG_HIGH:
        command[n] = {LegState::kHigh, LegState::kOff, duty};
        break;
      case OMNIHIL_LEG_LOW:
        command[n] = {LegState::kLow, LegState::kOff, duty};
        break;
      default:
        break;
    }
  }
  return command;
}

PeriodFlow WheelElectrics::advance_dc(WheelElectricState& x, const BridgeInput& bridge,
                                      const PeriodInput& in) const {
  const DcDrive& drive = in.held ? dc_held_ : dc_;
  const double viscous_Nm = model_.motor.viscous_friction_Nm_s_per_rad * x.omega_rotor_rad_s;
  const DcDriveInput input{.mode = bridge.mode,
                           .duty_ratio = bridge.duty_ratio,
                           .bus_voltage_V = in.bus_voltage_V,
                           .omega_rotor_rad_s = x.omega_rotor_rad_s,
                           .tau_load_Nm = in.held ? 0.0 : in.tau_load_Nm + viscous_Nm};
  const DcDriveResult r = advance_drive(drive, x.dc, input, 1);
  PeriodFlow f;
  f.impulse_Nm_s = r.mean_torque_Nm * period_s_;
  f.angle_rad = in.held ? 0.0 : r.angle_rad;
  f.bus_charge_C = r.mean_bus_current_A * period_s_;
  f.winding_heat_J = r.heat_J;
  f.mechanical_J = in.held ? 0.0 : warm_constant_Nm_per_A_ * r.mean_current_A * r.angle_rad;
  if (!in.held) x.omega_rotor_rad_s = r.omega_end_rad_s;
  x.theta_rotor_rad += f.angle_rad;
  x.mean_torque_Nm = r.mean_torque_Nm;
  return f;
}

PeriodFlow WheelElectrics::advance_dq_legs(WheelElectricState& x, const BridgeCommand& legs,
                                           const PeriodInput& in) const {
  const double p = motor_.pole_pairs, bus_V = in.bus_voltage_V;
  const double mid_rad = p * (x.theta_rotor_rad + 0.5 * period_s_ * x.omega_rotor_rad_s);
  const std::array<double, 3> before_A = phases_of(x.dq.i_d_A, x.dq.i_q_A, p * x.theta_rotor_rad);
  std::array<LegSource, 3> source;
  std::array<double, 3> volt_V;
  for (std::size_t n = 0; n < 3; ++n) {
    source[n] = mean_leg(averaged_, std::clamp(legs[n].duty_ratio, 0.0, 1.0), bus_V, before_A[n]);
    volt_V[n] = source[n].volt_V;
  }
  const Dq v = dq_of(volt_V, mid_rad);
  x.dq.omega_rotor_rad_s = x.omega_rotor_rad_s;
  x.dq.theta_rotor_rad = x.theta_rotor_rad;
  const DqStepResult<double> r = advance_dq(motor_, x.dq,
                                            {.v_d_V = v.d,
                                             .v_q_V = v.q,
                                             .tau_load_Nm = in.tau_load_Nm,
                                             .extra_inertia_kg_m2 = extra_inertia_kg_m2_,
                                             .speed_is_imposed = in.held},
                                            period_s_);
  const std::array<double, 3> mean_A = phases_of(r.i_d_A, r.i_q_A, mid_rad);
  PeriodFlow f;
  double drop_J = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    f.bus_charge_C += source[n].bus_share * mean_A[n] * period_s_;
    drop_J += source[n].drop_V * mean_A[n] * period_s_;
    f.leg_V[n] = source[n].volt_V - electric_.inverter.switch_resistance_ohm * mean_A[n];
  }
  const double in_switches = electric_.inverter.switch_resistance_ohm / motor_.resistance_ohm;
  f.impulse_Nm_s = r.torque_Nm * period_s_;
  f.angle_rad = r.omega_rotor_rad_s * period_s_;
  f.winding_heat_J = (1.0 - in_switches) * r.heat_J;
  f.device_heat_J = in_switches * r.heat_J + drop_J;
  f.mechanical_J = r.mechanical_J;
  return f;
}

PeriodFlow WheelElectrics::advance_averaged_legs(WheelElectricState& x, const BridgeCommand& legs,
                                                 const PeriodInput& in) const {
  const double p = motor_.pole_pairs;
  PhaseState state;
  state.current_A = phases_of(x.dq.i_d_A, x.dq.i_q_A, p * x.theta_rotor_rad);
  state.omega_rotor_rad_s = x.omega_rotor_rad_s;
  state.theta_rotor_rad = x.theta_rotor_rad;
  for (double& i : state.current_A) {
    if (std::abs(i) < 1e-12) i = 0.0;  // of the turning back and forth
  }
  PhaseFlow flow;
  advance_averaged(averaged_, state, legs, {in.bus_voltage_V, in.tau_load_Nm, in.held}, flow);
  const Dq i = dq_of(state.current_A, p * state.theta_rotor_rad);
  x.dq = {i.d, i.q, state.omega_rotor_rad_s, state.theta_rotor_rad,
          state.omega_rotor_rad_s - x.omega_rotor_rad_s};
  PeriodFlow f;
  f.impulse_Nm_s = flow.impulse_Nm_s;
  f.angle_rad = flow.angle_rad;
  f.bus_charge_C = flow.bus_charge_C;
  f.winding_heat_J = omnihil::winding_heat_J(averaged_.circuit, flow);
  f.device_heat_J = omnihil::device_heat_J(averaged_.circuit, flow);
  f.mechanical_J = flow.mechanical_J;
  f.leg_V = means_of(flow);
  return f;
}

PeriodFlow WheelElectrics::advance(WheelElectricState& x, const BridgeCommand& legs,
                                   const PeriodInput& in) const {
  const double ratio = in.sample_ratio;
  PeriodFlow f;
  if (electric_.kind == DriveKind::kSwitched) {
    x.switched.motor.omega_rotor_rad_s = x.omega_rotor_rad_s;
    x.switched.motor.theta_rotor_rad = x.theta_rotor_rad;
    PhaseFlow flow;
    f.sample =
        advance_period(switched_, x.switched, legs, {in.bus_voltage_V, in.tau_load_Nm, in.held}, ratio, flow);
    f.impulse_Nm_s = flow.impulse_Nm_s;
    f.angle_rad = flow.angle_rad;
    f.bus_charge_C = flow.bus_charge_C;
    f.winding_heat_J = omnihil::winding_heat_J(switched_.circuit, flow);
    f.device_heat_J = omnihil::device_heat_J(switched_.circuit, flow);
    f.mechanical_J = flow.mechanical_J;
    f.leg_V = means_of(flow);
    x.omega_rotor_rad_s = x.switched.motor.omega_rotor_rad_s;
    x.theta_rotor_rad = x.switched.motor.theta_rotor_rad;
  } else {
    const WheelElectricState before = x;
    const bool smooth = complementary(legs[0]) && complementary(legs[1]) && complementary(legs[2]);
    f = smooth ? advance_dq_legs(x, legs, in) : advance_averaged_legs(x, legs, in);
    x.omega_rotor_rad_s = x.dq.omega_rotor_rad_s;
    x.theta_rotor_rad = x.dq.theta_rotor_rad;
    const auto between = [ratio](double a, double b) { return a + ratio * (b - a); };
    f.sample.theta_rotor_rad = between(before.theta_rotor_rad, x.theta_rotor_rad);
    f.sample.omega_rotor_rad_s = between(before.omega_rotor_rad_s, x.omega_rotor_rad_s);
    f.sample.current_A = phases_of(between(before.dq.i_d_A, x.dq.i_d_A), between(before.dq.i_q_A, x.dq.i_q_A),
                                   motor_.pole_pairs * f.sample.theta_rotor_rad);
    for (std::size_t n = 0; n < 3; ++n) f.sample.leg[n] = leg_at(legs[n], ratio);
  }
  x.mean_torque_Nm = f.impulse_Nm_s / period_s_;
  return f;
}

}  // namespace omnihil
