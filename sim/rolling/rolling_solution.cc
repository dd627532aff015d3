// What comes of a step: speeds, floor forces and friction together.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sim/rolling/rolling_balance.h"
#include "sim/rolling/rolling_step.h"

namespace omnihil {
namespace {

constexpr int kSweeps = 30;

}  // namespace

template <typename T>
void RollingRobot<T>::predict(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const {
  using std::cos;
  using std::sin;
  const T half = 0.5 * s.h * (x.velocity[2] + 0.5 * x.turn_change_rad_s);  // mid-step, looked ahead
  s.cos_half = cos(half);
  s.sin_half = sin(half);
  s.turned = s.half_turned(s.half_turned(Vector3(x.velocity[0], x.velocity[1], x.velocity[2])));
  s.free = s.turned + s.half_turned(inverse_mass_ * s.force) * T(s.h);
  if (in.imposed_velocity != nullptr) {
    const auto& v = *in.imposed_velocity;
    s.free = Vector3(T(v[0]), T(v[1]), T(v[2]));
  }
  const double moves_s = in.imposed_velocity != nullptr ? 0.0 : s.h;
  const T cos_s = moves_s * s.cos_half, sin_s = moves_s * s.sin_half;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(wheels_); ++i) {
    for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(wheels_); ++j) {
      s.mobility(i, j) =
          cos_s * mobility_cos_(i, j) + sin_s * mobility_sin_(i, j) + moves_s * mobility_yaw_(i, j);
    }
  }
  for (std::size_t i = 0; i < wheels_; ++i) {
    Wheel& w = s.wheel[i];
    w.hub_free_m_s = rim_[i].dot(s.free);
    w.end_share = T(1);
    if (w.grip.rolls) continue;
    const auto n = static_cast<Eigen::Index>(i);
    const T mobility = s.mobility(n, n) + w.lever_m * w.lever_m * w.speed_per_torque;
    const T z = mobility * w.grip.slope_at_rest();  // the step over the time in which a slip dies out
    w.end_share = (3.0 + z) / (6.0 + z);
  }
}

// The load under each wheel by the floor's forces at the end of this step, as far as they are known. False: none slips.
template <typename T>
bool RollingRobot<T>::transfer_load(Step& s) const {
  bool slips = false;
  T floor_x = T(0), floor_y = T(0);
  for (std::size_t i = 0; i < wheels_; ++i) {
    slips = slips || !s.wheel[i].grip.rolls;
    add_floor_force(s, i, floor_x, floor_y);
  }
  if (!slips || wheels_ == 1) return false;
  for (std::size_t i = 0; i < wheels_; ++i) s.wheel[i].grip.load_N = load_N(i, floor_x, floor_y);
  return true;
}

template <typename T>
T RollingRobot<T>::load_N(std::size_t i, const T& floor_x_N, const T& floor_y_N) const {
  const T load = load_.at_rest_N[i] + load_.transfer(i, floor_x_N, floor_y_N);
  return value_of(load) < 0.0 ? T(0) : load;
}

// Of one wheel, at the step's end, in the body's frame.
template <typename T>
void RollingRobot<T>::add_floor_force(const Step& s, std::size_t i, T& x_N, T& y_N) const {
  const T drive_N = s.end_force_N[i] + s.wheel[i].added_N;
  x_N += rim_[i](0) * drive_N + rim_[i](1) * s.wheel[i].lateral_N;
  y_N += rim_[i](1) * drive_N - rim_[i](0) * s.wheel[i].lateral_N;
}

// The floor's mean force over the step, of its force at the step's end.
template <typename T>
T RollingRobot<T>::mean_force(const RollingState<T>& x, const Step& s, std::size_t i, const T& end_N) const {
  const Wheel& w = s.wheel[i];
  return w.grip.rolls ? end_N : T(x.force_N[i] + w.end_share * (end_N - x.force_N[i]));
}

// One rotor's end speed under a mean floor force, and the friction that comes with it.
template <typename T>
T RollingRobot<T>::rotor_end(const RollingState<T>& x, const Step& s, std::size_t i, const T& force_N,
                             T* friction_Nm) const {
  const Wheel& w = s.wheel[i];
  const T y =
      w.omega_predicted - w.speed_per_torque * (w.lever_m * (force_N - x.force_N[i]) - x.friction_Nm[i]);
  const T omega = shrunk(y, w.friction_up_rad_s, w.friction_down_rad_s);
  if (friction_Nm != nullptr) *friction_Nm = (y - omega) / w.speed_per_torque;
  return omega;
}

// The slips of this step, as values; `inverse` of the slopes: with derivatives at the solution, else near it.
template <typename T>
template <int Size>
Eigen::Matrix<double, Size, 1> RollingRobot<T>::solve_values(const RollingState<T>& x, const Step& s,
                                                             Eigen::Matrix<double, Size, Size>& inverse) {
  RollingBalance<T, Size> balance;
  Eigen::Matrix<double, Size, 1> before;
  for (Eigen::Index i = 0; i < Size; ++i) {
    const auto n = static_cast<std::size_t>(i);
    before(i) = x.slip_m_s[n];
    if (n >= wheels_) {
      balance.grips[n] = &absent_;
      balance.lever(i) = balance.speed_per_torque(i) = balance.up(i) = balance.down(i) = 0.0;
      balance.hub(i) = balance.rotor(i) = balance.begun(i) = 0.0;
      balance.end_share(i) = 1.0;
      balance.mobility.row(i).setZero();
      continue;
    }
    const Wheel& w = s.wheel[n];
    balance.grips[n] = &w.grip;
    balance.end_share(i) = value_of(w.end_share);
    balance.begun(i) = w.grip.rolls ? 0.0 : (1.0 - balance.end_share(i)) * value_of(x.force_N[n]);
    balance.lever(i) = value_of(w.lever_m);
    balance.speed_per_torque(i) = value_of(w.speed_per_torque);
    balance.up(i) = value_of(w.friction_up_rad_s);
    balance.down(i) = value_of(w.friction_down_rad_s);
    balance.hub(i) = value_of(w.hub_free_m_s);
    const double held_Nm = balance.lever(i) * value_of(x.force_N[n]) + value_of(x.friction_Nm[n]);
    balance.rotor(i) = value_of(w.omega_predicted) + balance.speed_per_torque(i) * held_Nm;
    for (Eigen::Index j = 0; j < Size; ++j) {
      balance.mobility(i, j) = static_cast<std::size_t>(j) < wheels_ ? value_of(s.mobility(i, j)) : 0.0;
    }
  }
  Eigen::Matrix<double, Size, 1> slip = before;
  if (!balance.newton(slip, inverse)) {
    slip = before;
    for (int n = 0; n < kSweeps; ++n) balance.sweep(slip);
    if (!balance.newton(slip, inverse)) unsolved_ += 1.0;
  }
  if constexpr (!std::is_same_v<T, double>) inverse = balance.slopes(slip).inverse();
  return slip;
}

template <typename T>
void RollingRobot<T>::solve(RollingState<T>& x, Step& s) {
  wheels_ <= 4 ? solve_in<4>(x, s) : solve_in<kMaxWheels>(x, s);
}

template <typename T>
template <int Size>
void RollingRobot<T>::solve_in(RollingState<T>& x, Step& s) {
  Eigen::Matrix<double, Size, Size> inverse;
  const Eigen::Matrix<double, Size, 1> slip = solve_values<Size>(x, s, inverse);
  // Newton once more on T, from the solution: exact derivatives.
  PerWheel<T> force, residual;
  for (std::size_t i = 0; i < wheels_; ++i) {
    force[i] = mean_force(x, s, i, T(-s.wheel[i].grip.force_of(T(slip(static_cast<Eigen::Index>(i))))));
  }
  for (std::size_t i = 0; i < wheels_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    residual[i] =
        slip(row) - s.wheel[i].hub_free_m_s + s.wheel[i].lever_m * rotor_end(x, s, i, force[i], nullptr);
    for (std::size_t j = 0; j < wheels_; ++j) {
      residual[i] -= s.mobility(row, static_cast<Eigen::Index>(j)) * force[j];
    }
  }
  for (std::size_t i = 0; i < wheels_; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    T exact = T(slip(row));
    for (std::size_t j = 0; j < wheels_; ++j)
      exact -= inverse(row, static_cast<Eigen::Index>(j)) * residual[j];
    x.slip_m_s[i] = value_of(exact);
    s.end_force_N[i] = -s.wheel[i].grip.force_of(exact);
  }
}

template <typename T>
void RollingRobot<T>::finish(RollingState<T>& x, const RollingInput<T>& in, Step& s) const {
  Vector3 pushed(T(0), T(0), T(0));
  T floor_x = T(0), floor_y = T(0);
  for (std::size_t i = 0; i < wheels_; ++i) {
    const Wheel& w = s.wheel[i];
    DriveState<T>& state = x.drive[i];
    const T force_N = mean_force(x, s, i, s.end_force_N[i]);
    T friction_Nm;
    const T omega_end = rotor_end(x, s, i, force_N, &friction_Nm);
    pushed += rim_mobility_[i] * force_N;
    add_floor_force(s, i, floor_x, floor_y);
    const T departed = omega_end - w.omega_predicted;
    state.current_A -= w.end_sensitivity * departed;
    x.charge_C[i] += s.h * (w.drive.mean_current_A - 0.5 * w.mean_sensitivity * departed);
    x.theta_rotor_rad[i] += 0.5 * s.h * (w.omega_start + omega_end);
    state.omega_rotor_rad_s = omega_end;
    state.omega_change_rad_s = omega_end - w.omega_start;
    state.theta_rotor_rad = x.theta_rotor_rad[i];
    state.corrected_rad = T(0);
    x.force_N[i] = s.end_force_N[i];
    x.friction_Nm[i] = friction_Nm;
  }
  const Vector3 end = s.free + s.half_turned(pushed) * T(in.imposed_velocity != nullptr ? 0.0 : s.h);
  x.accel_x_m_s2 = (end(0) - s.turned(0)) / s.h;
  x.accel_y_m_s2 = (end(1) - s.turned(1)) / s.h;
  x.turn_change_rad_s = end(2) - x.velocity[2];
  for (std::size_t i = 0; i < 3; ++i) x.velocity[i] = end(static_cast<Eigen::Index>(i));
  x.floor_x_N = floor_x;
  x.floor_y_N = floor_y;
  supply(x, in, s);
}

template <typename T>
void RollingRobot<T>::supply(RollingState<T>& x, const RollingInput<T>& in, const Step& s) const {
  if (!in.bus_is_measured) {
    x.bus_voltage_V = x.supply_voltage_V = s.wheel[0].drive.bus_voltage_V;
    return;
  }
  x.bus_voltage_V = T(in.bus_voltage_V);
  if (effects_.supply.empty()) return;
  SupplyPort<T> port;
  port.bus_current_A = T(0);
  for (std::size_t i = 0; i < wheels_; ++i) port.bus_current_A += s.wheel[i].drive.mean_bus_current_A;
  port.dt_s = s.h;
  port.bus_voltage_V = p_.drive.supply_voltage_V;
  effects_.supply.apply(effects_.values(), x.supply_states.data(), port);
  x.supply_voltage_V = port.bus_voltage_V;
}

template class RollingRobot<double>;
template class RollingRobot<Jet>;

}  // namespace omnihil
