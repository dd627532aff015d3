// One robot on wheels that roll or slip, solved implicitly: what fits run, on double and with derivatives.
//
//   RollingRobot<double> robot(params, uses, values);      // of all uses one after another
//   RollingState<double> x = robot.start({.v_forward_m_s = 1.0}, theta_rotor_rad);
//   robot.advance(x, {.duty_ratio = {0.4, 0.4, -0.4, -0.4}, .bus_voltage_V = 22.2, .bus_is_measured = true}, 1e-3);
//   x.velocity, x.omega_rotor_rad_s(i), x.theta_rotor_rad[i], x.charge_C[i];
//
// The same laws as the plant's (plant.h): drives of drive_sim.h with all their effects, masses of
// planar_law.h, loads of wheel_load.h, tyres of tyre.h, Coulomb friction that really holds. What differs is
// how a step is solved. The plant is explicit, so its tyre must be soft against its step; here floor forces
// and friction are found together with the speeds at the step's end, so that a stiff tyre, and in the limit a
// wheel that rolls without slip, costs nothing:
//     rotor   omega+ = shrink(omega_f - h/J_e (lever (F - F_0) - phi_0),  h c / J_e),  lever = r / N
//     body    v+     = v_f + h M^-1 G' F          in the turning frame, by its mean direction over the step
//     floor   F_i    = (1 - a_i) F_0i - a_i f(s_i),  s_i = (G v+)_i - lever omega+_i,  F_0: of the step's start
//             a_i    = (3 + z_i) / (6 + z_i), z_i: h over the time in which a slip dies out; 1 where it rolls
//   so that such a slip shrinks by (6 - 2 z) / (6 + 4 z + z^2), the Pade approximant of e^-z that also damps what is far
//   faster than the step (L-stable: Hairer, Wanner 1996, Solving Ordinary Differential Equations II, IV.3).
//   omega_f: the rotor's end speed by DriveSim with the step before's floor force and friction; J_e: inertia
//   plus half a step of the winding's speed sensitivity (wheel_drive.h); c: friction level; a
//   slip per wheel unknown, Newton's method on the values, and one more Newton step on the scalar with derivatives,
//   which makes them exact (implicit function theorem).
//   Without a tyre f is a line so steep that 1 N slides 1 um/s: rolling. With wheel_slip, or a tyre, f is the
//   tyre's curve over s / (scale + v_c), scale = extremum slip times max(|v|, |rim|, floor) for a tyre, 0 without.
// Loads follow the floor's force within the step, by one correction. Order 2 in the step, but for what that correction
// leaves where wheels slip and for an instant at which one begins to stick. A force that an effect adds along the wheel's
// drive direction (roller_ripple) acts on wheel and body where there is a tyre, as in the plant. Without one
// it turns the wheel only: on a wheel that rolls, a force at the point of contact does no work. Cannot
// represent: what the planar plant cannot, and play or compliance between rotor and wheel.
// One wheel alone carries all of mass_kg: a wheel on a test bench, whose body is moved by the bench.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <vector>

#include "sim/drive/drive_sim.h"
#include "sim/robot/geometry.h"
#include "sim/robot/wheel_load.h"
#include "sim/rolling/rolling_grip.h"
#include "sim/rolling/rolling_params.h"

namespace omnihil {

// As long as a step may be (tests: errors below a tenth of an encoder's noise).
inline constexpr double kRollingStep_s = 1e-3;     // without a tyre
inline constexpr double kSlippingStep_s = 0.5e-3;  // with one: a slip dies out within 1 to 2 ms

// Held over one call. T: duties that a controller made of simulated speeds carry derivatives.
template <typename T = double>
struct RollingInput {
  PerWheel<T> duty_ratio{};
  PerWheel<bool> enabled{true, true, true, true, true, true};
  double bus_voltage_V = 0.0;    // used when bus_is_measured
  bool bus_is_measured = false;  // at the bridge: then nothing sags it again
  double dribbler_rad_s = 0.0;
  // The bench moves the body: its velocity at the end of the call, whatever the wheels do. Null: it moves freely.
  const std::array<double, 3>* imposed_velocity = nullptr;
  // Angles that the laws of the angle shall see instead of the model's own; null: its own.
  const PerWheel<double>* theta_rotor_rad = nullptr;
};

template <typename T>
struct RollingState {
  T yaw_rad = T(0);             // for forces that know the field's directions; the caller's to move
  std::array<T, 3> velocity{};  // v_forward, v_left, omega_body of the geometric centre, body frame
  PerWheel<DriveState<T>> drive{};
  PerWheel<T> theta_rotor_rad{};               // turned since the start, plus where it started
  PerWheel<T> charge_C{};                      // integral of the motor current
  T accel_x_m_s2 = T(0), accel_y_m_s2 = T(0);  // of the geometric centre, mean over the last step
  T bus_voltage_V = T(0);                      // that the bridges had
  T supply_voltage_V = T(0);  // that the supply would give by its effects, where the bus is measured
  // of the step before, where the next one's solution begins
  PerWheel<T> force_N{}, friction_Nm{};
  PerWheel<double> slip_m_s{};
  T floor_x_N = T(0), floor_y_N = T(0);
  T turn_change_rad_s = T(0);
  std::array<T, kMaxEffectStates> supply_states{};

  const T& omega_rotor_rad_s(std::size_t i) const { return drive[i].omega_rotor_rad_s; }
};

// Where its wheels are, for geometry.h.
template <typename T>
WheelGeometry<T> wheel_geometry(const RollingParams<T>& p) {
  WheelGeometry<T> g;
  g.wheels = p.wheels;
  for (std::size_t i = 0; i < g.wheels; ++i) {
    g.cos_angle[i] = T(std::cos(p.wheel_angle_rad[i]));
    g.sin_angle[i] = T(std::sin(p.wheel_angle_rad[i]));
  }
  g.wheel_center_radius_m = p.wheel_center_radius_m;
  g.wheel_radius_m = p.wheel_radius_m;
  return g;
}

template <typename T>
class RollingRobot {
 public:
  // values: of all uses one after another, as EffectSet takes them.
  RollingRobot(const RollingParams<T>& params, std::span<const EffectUse> uses, std::span<const T> values);
  ~RollingRobot();
  RollingRobot(const RollingRobot&) = delete;
  RollingRobot& operator=(const RollingRobot&) = delete;

  // Wheels roll with the body.
  RollingState<T> start(const BodyVelocity<double>& velocity, const PerWheel<double>& theta_rotor_rad) const;
  void advance(RollingState<T>& state, const RollingInput<T>& input, double step_s);

  const EffectSet<T>& effects() const { return effects_; }
  double steps_unsolved() const { return unsolved_; }  // in which Newton's method ran out of iterations

 private:
  struct Link;
  struct LinkEffect;
  struct Wheel;
  struct Step;
  using Vector3 = Eigen::Matrix<T, 3, 1>;

  void make_body();
  void drives(RollingState<T>& x, const RollingInput<T>& in, Step& s);
  void ask_floor(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const;
  void set_grip(const RollingState<T>& x, std::size_t wheel, const T& hub_m_s, const ContactPort<T>& port,
                Wheel& w) const;
  void ask_body(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const;
  void predict(const RollingState<T>& x, const RollingInput<T>& in, Step& s) const;
  void set_step(double step_s);
  void winding_speed_sensitivity(bool enabled, const Link& link, const DriveState<T>& state, Wheel& w) const;
  bool transfer_load(Step& s) const;
  T load_N(std::size_t wheel, const T& floor_x_N, const T& floor_y_N) const;
  void add_floor_force(const Step& s, std::size_t wheel, T& x_N, T& y_N) const;
  T mean_force(const RollingState<T>& x, const Step& s, std::size_t wheel, const T& end_N) const;
  T rotor_end(const RollingState<T>& x, const Step& s, std::size_t wheel, const T& force_N,
              T* friction_Nm) const;
  template <int Size>
  Eigen::Matrix<double, Size, 1> solve_values(const RollingState<T>& x, const Step& s,
                                              Eigen::Matrix<double, Size, Size>& inverse);
  void solve(RollingState<T>& x, Step& s);
  template <int Size>
  void solve_in(RollingState<T>& x, Step& s);
  void finish(RollingState<T>& x, const RollingInput<T>& in, Step& s) const;
  void supply(RollingState<T>& x, const RollingInput<T>& in, const Step& s) const;

  RollingParams<T> p_;
  EffectSet<T> effects_;
  std::vector<std::unique_ptr<Link>> links_;
  std::vector<EffectEntry> link_entries_;
  std::vector<DriveSim<T>> drives_;
  std::size_t wheels_ = 0;
  Grip<T> absent_;  // of a wheel that is not there
  WheelLoadLaw<T> load_;
  PerWheel<Vector3> rim_;           // rows of G
  PerWheel<Vector3> rim_mobility_;  // M^-1 G'
  Eigen::Matrix<T, 3, 3> inverse_mass_;
  // G R M^-1 G', R the turn of half a step, is cos times the first, sin times the second, and the third.
  Eigen::Matrix<T, kMaxWheels, kMaxWheels> mobility_cos_, mobility_sin_, mobility_yaw_;
  TyreShape<T> tyre_;
  std::unique_ptr<Step> step_;  // of the last call: every step sets all of it
  double step_s_ = 0.0;
  T end_sensitivity_ = T(0), mean_sensitivity_ = T(0);  // of a winding, in steps of this length
  double unsolved_ = 0.0;
};

}  // namespace omnihil
