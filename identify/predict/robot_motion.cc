#include "identify/predict/robot_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "identify/predict/firmware_loop.h"
#include "sim/law/random.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

// Time constant of the model path's correction towards the camera: an error of speed dv appears as 0.5 s dv,
// above a camera's millimetres for 10 mm/s. A choice; sensitivity not measured.
constexpr double kFollow_s = 0.5;  // a choice
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Everything true, at the samples.
template <typename T>
struct Truth {
  std::vector<PerWheel<T>> theta_rotor_rad, omega_rotor_rad_s, reported_rad_s, charge_C;
  std::vector<std::array<T, 3>> velocity;
  std::vector<T> accel_x, accel_y, bus, supply, force_x, force_y;
};

// Linear interpolation at a time between the samples `from` and `from` + 1.
template <typename T>
struct Instant {
  std::size_t from = 0;
  T share = T(0);

  template <typename V>
  T of(const V& values) const {
    return values(from) + (values(from + 1) - values(from)) * share;
  }
};

template <typename T>
Instant<T> instant(const std::vector<double>& time_s, const T& at_s) {
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), value_of(at_s));
  std::size_t k = static_cast<std::size_t>(after - time_s.begin());
  k = std::clamp<std::size_t>(k, 1, time_s.size() - 1);
  Instant<T> i;
  i.from = k - 1;
  i.share = (at_s - time_s[k - 1]) / (time_s[k] - time_s[k - 1]);
  // before the first sample: its value, constant
  if (value_of(i.share) < 0.0) i.share = T(0);
  return i;
}

bool is_finite(double x) { return std::isfinite(x); }
bool is_finite(const Jet& x) { return std::isfinite(x.a) && x.v.allFinite(); }

template <typename T>
std::array<T, kMaxEffectStates> initial_states(const EffectSet<T>& effects) {
  std::array<T, kMaxEffectStates> states{};
  std::copy(effects.initial_states().begin(), effects.initial_states().end(), states.begin());
  return states;
}

template <typename T>
class Runner {
 public:
  Runner(const RobotModelValues<T>& model, const RobotRecord& record, const RobotMotionOptions& options,
         RobotCarry<T>* carry)
      : model_(model),
        record_(record),
        options_(options),
        carry_(carry),
        robot_(model.params, model.uses, model.values),
        timing_states_(initial_states(robot_.effects())) {
    if (record.radio && options.firmware != nullptr) {
      firmware_.emplace(*options.firmware, value_of(model.params.controller.latency_s), record.time_s[0]);
    } else if (record.radio) {
      controller_.emplace(model.params.controller,
                          std::span(model.params.wheel_angle_rad).first(model.params.wheels),
                          value_of(model.params.drive.gear_ratio));
    }
  }

  RobotMotion<T> run() {
    camera_age_s_ = T(0);
    const std::size_t n = record_.size();
    if (!timing().empty() && n > 1) {
      // ages of the camera do not change along a run, but for jitter, which has no expected value
      auto states = timing_states_;
      camera_age_s_ = age(Stamped::kVision, 0, states);
    }
    if (options_.follow_camera) heading_ = headings(record_, camera_age_s_);
    simulate();
    sense();
    see();
    return std::move(out_);
  }

 private:
  const EffectChain<T, TimingPort<T>>& timing() const { return robot_.effects().timing; }

  T age(Stamped what, std::size_t k, std::array<T, kMaxEffectStates>& states) const {
    TimingPort<T> port;
    NoiseKey key{options_.noise_seed.value_or(0), stream_of("timing"), k};
    port.what = what;
    port.time_s = record_.time_s[k];
    port.dt_s = k > 0 ? record_.time_s[k] - record_.time_s[k - 1] : 0.0;
    port.noise = options_.noise_seed ? &key : nullptr;
    timing().apply(robot_.effects().values(), states.data(), port);
    return port.age_s;
  }

  // Commands are heard at their samples; the loop runs once per period, on the mean speed since it last ran.
  void hear(std::size_t k) {
    const RadioCommands& radio = *record_.radio;
    const auto& value = radio.value[k];
    const std::size_t count = radio.frame == CommandFrame::kBodyVelocity ? 3 : record_.wheels;
    if (std::all_of(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(count),
                    [](double v) { return std::isfinite(v); })) {
      if (firmware_) firmware_->hear(record_.time_s[k], value, radio.frame);
      if (controller_) controller_->hear(record_.time_s[k], value, radio.frame);
    }
  }
  void run_firmware(const RollingState<T>& x, RollingInput<T>& in, double now_s, double step_s) {
    if (firmware_->due(now_s, step_s)) {
      FirmwareSees sees;
      for (std::size_t i = 0; i < kWheels; ++i) {
        sees.theta_rotor_rad[i] = value_of(x.theta_rotor_rad[i]);
        sees.charge_C[i] = value_of(x.charge_C[i]);
      }
      const double supply = value_of(model_.params.drive.supply_voltage_V);
      const double bus = in.bus_is_measured ? in.bus_voltage_V : value_of(x.bus_voltage_V);
      sees.bus_voltage_V = bus > 0.0 ? bus : supply;
      sees.gyro_z_rad_s = value_of(x.velocity[2]);
      sees.accel_x_m_s2 = value_of(x.accel_x_m_s2);
      sees.accel_y_m_s2 = value_of(x.accel_y_m_s2);
      firmware_->tick(now_s, sees);
    }
    for (std::size_t i = 0; i < kWheels; ++i) {
      in.duty_ratio[i] = T(firmware_->duty()[i]);
      in.enabled[i] = firmware_->enabled()[i];
    }
  }
  void control(const RollingState<T>& x, const RollingInput<T>& in, double now_s, double step_s) {
    if (now_s < next_control_s_ - 0.5 * step_s) return;
    const double span_s = now_s - last_control_s_;
    PerWheel<T> omega{};
    for (std::size_t i = 0; i < record_.wheels; ++i) {
      omega[i] = span_s > 0.0 ? T(turned_rad_[i] * (1.0 / span_s)) : x.omega_rotor_rad_s(i);
      turned_rad_[i] = T(0);
    }
    const T bus = in.bus_is_measured ? T(in.bus_voltage_V) : x.bus_voltage_V;
    const T& supply = model_.params.drive.supply_voltage_V;
    duty_ = controller_->update(now_s, omega, value_of(bus) > 0.0 ? bus : supply,
                                value_of(model_.params.drive.duty_limit_ratio));
    last_control_s_ = now_s;
    next_control_s_ += controller_->period_s();
  }
  void count_turns(const PerWheel<T>& before, const RollingState<T>& x, double h) {
    for (std::size_t i = 0; i < record_.wheels; ++i)
      turned_rad_[i] += (before[i] + x.omega_rotor_rad_s(i)) * (0.5 * h);
  }
  PerWheel<T> speeds(const RollingState<T>& x) const {
    PerWheel<T> omega{};
    for (std::size_t i = 0; i < record_.wheels; ++i) omega[i] = x.omega_rotor_rad_s(i);
    return omega;
  }

  RollingState<T> begin(T& own_heading) {
    if (carry_ != nullptr && carry_->begun) {
      controller_ = carry_->controller;
      duty_ = carry_->duty;
      turned_rad_ = carry_->turned_rad;
      last_control_s_ = carry_->last_control_s;
      next_control_s_ = carry_->next_control_s;
      own_heading = carry_->heading;
      return carry_->state;
    }
    RollingState<T> x = robot_.start(record_.start_velocity, record_.theta_rotor_rad[0]);
    if (controller_) {
      last_control_s_ = next_control_s_ = record_.time_s[0];
      controller_->begin(record_.start_velocity, speeds(x), model_.params.drive.torque_constant_Nm_per_A,
                         record_.radio->frame);
    }
    return x;
  }
  void leave(const RollingState<T>& x, const T& own_heading) {
    if (carry_ == nullptr) return;
    carry_->begun = out_.finite;
    if (!out_.finite) return;
    carry_->state = x;
    carry_->controller = controller_;
    carry_->duty = duty_;
    carry_->turned_rad = turned_rad_;
    carry_->last_control_s = last_control_s_;
    carry_->next_control_s = next_control_s_;
    carry_->heading = own_heading;
  }

  void simulate() {
    const std::size_t n = record_.size();
    T own_heading = T(0);
    RollingState<T> x = begin(own_heading);
    double step_s = model_.params.has_tyre ? kSlippingStep_s : kRollingStep_s;
    if (controller_) step_s = std::min(step_s, controller_->period_s());
    if (firmware_) step_s = std::min(step_s, firmware_->period_s());
    PerWheel<double> between;
    std::array<double, 3> imposed;
    for (std::size_t k = 0;; ++k) {
      keep(x);
      if (k + 1 >= n) break;
      RollingInput<T> in = record_.template input<T>(k);
      if (record_.radio) hear(k);
      if (!options_.slave_angle) in.theta_rotor_rad = nullptr;
      const double dt_s = record_.time_s[k + 1] - record_.time_s[k];
      const int steps = std::max(1, static_cast<int>(std::ceil(dt_s / step_s - 1e-6)));
      for (int j = 0; j < steps; ++j) {
        if (in.theta_rotor_rad != nullptr && steps > 1) {
          for (std::size_t i = 0; i < record_.wheels; ++i) {
            const double from = record_.theta_rotor_rad[k][i], to = record_.theta_rotor_rad[k + 1][i];
            between[i] = from + (to - from) * j / steps;
          }
          in.theta_rotor_rad = &between;
        }
        for (std::size_t a = 0; a < 3 && !record_.imposed_velocity.empty(); ++a) {
          const double from = record_.imposed_velocity[k][a], to = record_.imposed_velocity[k + 1][a];
          imposed[a] = from + (to - from) * (j + 1) / steps;
          in.imposed_velocity = &imposed;
        }
        x.yaw_rad = heading_.empty() ? own_heading : heading_[k];
        const T before = x.velocity[2];
        const PerWheel<T> omega_before = controller_ ? speeds(x) : PerWheel<T>{};
        if (controller_) {
          control(x, in, record_.time_s[k] + dt_s * j / steps, dt_s / steps);
          in.duty_ratio = duty_;
        }
        if (firmware_) run_firmware(x, in, record_.time_s[k] + dt_s * j / steps, dt_s / steps);
        robot_.advance(x, in, dt_s / steps);
        if (controller_) count_turns(omega_before, x, dt_s / steps);
        own_heading += 0.5 * (before + x.velocity[2]) * (dt_s / steps);
      }
      if (firmware_ && firmware_->failed()) out_.finite = false;
      if (!out_.finite || !is_finite(x.velocity[0]) || !is_finite(x.omega_rotor_rad_s(0)) ||
          !is_finite(x.charge_C[0])) {
        out_.finite = false;
        break;
      }
    }
    leave(x, own_heading);
    if (out_.finite) return;
    // samples after a divergence repeat the last state; `finite` marks the run as diverged
    const std::size_t known = truth_.bus.size();
    for (std::size_t k = known; k < n; ++k) {
      keep(x);
      truth_.velocity.back() = {T(kNaN), T(kNaN), T(kNaN)};
      truth_.theta_rotor_rad.back().fill(T(kNaN));
      truth_.charge_C.back().fill(T(kNaN));
      truth_.accel_x.back() = truth_.accel_y.back() = T(kNaN);
    }
  }

  void keep(const RollingState<T>& x) {
    truth_.theta_rotor_rad.push_back(x.theta_rotor_rad);
    PerWheel<T> omega{};
    T rise = T(0);
    for (std::size_t i = 0; i < record_.wheels; ++i) {
      omega[i] = x.omega_rotor_rad_s(i);
      rise += (1.0 / static_cast<double>(record_.wheels)) * x.drive[i].temperature_rise_K;
    }
    truth_.omega_rotor_rad_s.push_back(omega);
    if (controller_) {
      for (std::size_t i = 0; i < record_.wheels; ++i) omega[i] = controller_->reported_rad_s(i);
    }
    if (std::array<double, kWheels> told; firmware_ && firmware_->tells(told)) {
      for (std::size_t i = 0; i < kWheels; ++i)
        omega[i] = T(told[i] * value_of(model_.params.drive.gear_ratio));
    }
    truth_.reported_rad_s.push_back(omega);
    truth_.charge_C.push_back(x.charge_C);
    truth_.velocity.push_back(x.velocity);
    truth_.accel_x.push_back(x.accel_x_m_s2);
    truth_.accel_y.push_back(x.accel_y_m_s2);
    if (!record_.imposed_velocity.empty()) {
      truth_.force_x.push_back(x.floor_x_N);
      truth_.force_y.push_back(x.floor_y_N);
    }
    truth_.bus.push_back(x.bus_voltage_V);
    truth_.supply.push_back(x.supply_voltage_V);
    out_.temperature_rise_K.push_back(rise);
  }

  void sense() {
    const std::size_t n = record_.size();
    out_.encoder_rad.resize(n);
    out_.current_A.resize(n);
    out_.wheel_rad_s.resize(n);
    const T inverse_gear = 1.0 / model_.params.drive.gear_ratio;
    out_.gyro_rad_s.resize(n);
    out_.accel_x_m_s2.resize(n);
    out_.accel_y_m_s2.resize(n);
    PerWheel<std::array<T, kMaxEffectStates>> states;
    states.fill(initial_states(robot_.effects()));
    PerWheel<T> last_theta = truth_.theta_rotor_rad[0], last_charge{};
    T last_s = T(record_.time_s[0]);
    for (std::size_t k = 0; k < n; ++k) {
      T seen_s = T(record_.time_s[k]);
      if (!timing().empty()) seen_s -= age(Stamped::kDriveSensors, k, timing_states_);
      const bool now = timing().empty() || n < 2;
      const Instant<T> at = now ? Instant<T>{} : instant(record_.time_s, seen_s);
      const auto seen = [&](const auto& values) { return now ? values(k) : at.of(values); };
      const T span_s = seen_s - last_s;
      for (std::size_t i = 0; i < record_.wheels; ++i) {
        const T theta = seen([&](std::size_t j) { return truth_.theta_rotor_rad[j][i]; });
        const T omega = seen([&](std::size_t j) { return truth_.omega_rotor_rad_s[j][i]; });
        const T charge = seen([&](std::size_t j) { return truth_.charge_C[j][i]; });
        const T reported = seen([&](std::size_t j) { return truth_.reported_rad_s[j][i]; });
        out_.wheel_rad_s[k][i] = reported * inverse_gear;
        out_.encoder_rad[k][i] = encoder(k, i, theta, omega, T(theta - last_theta[i]), states[i]);
        out_.current_A[k][i] = value_of(span_s) > 0.0 ? T((charge - last_charge[i]) / span_s) : T(0);
        last_theta[i] = theta;
        last_charge[i] = charge;
      }
      last_s = seen_s;
      out_.gyro_rad_s[k] = seen([&](std::size_t j) { return truth_.velocity[j][2]; });
      out_.accel_x_m_s2[k] = seen([&](std::size_t j) { return truth_.accel_x[j]; });
      out_.accel_y_m_s2[k] = seen([&](std::size_t j) { return truth_.accel_y[j]; });
      if (record_.imposed_velocity.empty()) continue;
      out_.force_x_N.push_back(seen([&](std::size_t j) { return truth_.force_x[j]; }));
      out_.force_y_N.push_back(seen([&](std::size_t j) { return truth_.force_y[j]; }));
    }
    out_.bus_voltage_V = truth_.bus;
    out_.supply_voltage_V = truth_.supply;
    out_.velocity = truth_.velocity;
  }

  T encoder(std::size_t k, std::size_t i, const T& theta, const T& omega, const T& travel,
            std::array<T, kMaxEffectStates>& states) const {
    const EffectSet<T>& effects = robot_.effects();
    if (effects.sensor.empty()) return theta;
    SensorPort<T> port;
    NoiseKey key{options_.noise_seed.value_or(0), stream_of("sensor") + i, k};
    port.theta_rotor_rad = port.encoder_angle_rad = theta;
    if (record_.has_all_encoders && options_.slave_angle) {
      // an encoder's error depends on the angle: the law takes the angle at the sampled (earlier) instant
      port.theta_rotor_rad = T(record_.theta_rotor_rad[k][i]);
      port.encoder_angle_rad = port.theta_rotor_rad;
    }
    port.omega_rotor_rad_s = port.measured_speed_rad_s = omega;
    port.travel_rad = value_of(travel) < 0.0 ? T(-travel) : travel;
    port.counts_per_turn = T(record_.counts_per_rotor_turn[i]);
    port.time_s = record_.time_s[k];
    port.dt_s = k > 0 ? record_.time_s[k] - record_.time_s[k - 1] : 0.0;
    port.noise = options_.noise_seed ? &key : nullptr;
    effects.sensor.apply(effects.values(), states.data(), port);
    return theta + (port.encoder_angle_rad - port.theta_rotor_rad);
  }

  // Path and heading by the trapezoidal rule, and their values at the camera's frames.
  void see() {
    using std::cos;
    using std::sin;
    const std::size_t n = record_.size();
    std::vector<T> x(n, T(0)), y(n, T(0)), theta(n, T(0));
    T vx = T(0), vy = T(0);
    theta[0] = T(options_.follow_camera ? 0.0 : first_heading());
    for (std::size_t k = 0; k < n; ++k) {
      if (k > 0) {
        const double dt_s = record_.time_s[k] - record_.time_s[k - 1];
        theta[k] = theta[k - 1] + 0.5 * dt_s * (truth_.velocity[k - 1][2] + truth_.velocity[k][2]);
      }
      const T& heading = heading_.empty() ? theta[k] : heading_[k];
      const T c = cos(heading), s = sin(heading);
      const T wx = c * truth_.velocity[k][0] - s * truth_.velocity[k][1];
      const T wy = s * truth_.velocity[k][0] + c * truth_.velocity[k][1];
      if (k > 0) {
        const double half_s = 0.5 * (record_.time_s[k] - record_.time_s[k - 1]);
        x[k] = x[k - 1] + half_s * (vx + wx);
        y[k] = y[k - 1] + half_s * (vy + wy);
      }
      vx = wx;
      vy = wy;
    }
    if (!options_.follow_camera) {
      look_back(x), look_back(y), look_back(theta);
      out_.x_m = x;
      out_.y_m = y;
      out_.theta_rad = theta;
      return;
    }
    out_.x_m = follow(x, &CameraFrame::x_m);
    out_.y_m = follow(y, &CameraFrame::y_m);
    out_.theta_rad = follow(theta, &CameraFrame::theta_rad);
  }

  double first_heading() const {
    for (const CameraFrame& f : record_.frames) {
      if (std::isfinite(f.theta_rad)) return f.theta_rad;
    }
    return 0.0;
  }

  void look_back(std::vector<T>& way) const {
    if (value_of(camera_age_s_) == 0.0) return;
    const std::vector<T> now = way;
    for (std::size_t k = 0; k < way.size(); ++k) {
      way[k] = instant(record_.time_s, T(record_.time_s[k] - camera_age_s_)).of([&](std::size_t j) {
        return now[j];
      });
    }
  }

  // One coordinate of the path at the frames (n samples, NaN between), corrected by the camera's earlier
  // frames: first order filter of the camera's difference to the path.
  std::vector<T> follow(const std::vector<T>& path, double CameraFrame::*seen) const {
    std::vector<T> out(path.size(), T(kNaN));
    T correction = T(0);
    double last_s = kNaN, frames = 0.0;
    for (const CameraFrame& f : record_.frames) {
      if (!std::isfinite(f.*seen)) continue;
      const double now_s = record_.time_s[f.sample];
      const T there =
          is_exactly(camera_age_s_, 0.0)
              ? path[f.sample]
              : instant(record_.time_s, T(now_s - camera_age_s_)).of([&](std::size_t j) { return path[j]; });
      if (!std::isfinite(last_s)) {
        correction = f.*seen - there;  // the first frame is the path's origin, and is not compared
      } else {
        out[f.sample] = there + correction;
        // at first the mean of the frames so far, so that the first one's noise is averaged out
        const double gain = std::max(-std::expm1(-(now_s - last_s) / kFollow_s), 1.0 / (frames + 1.0));
        correction += (f.*seen - out[f.sample]) * gain;
      }
      last_s = now_s;
      frames += 1.0;
    }
    return out;
  }

  const RobotModelValues<T>& model_;
  const RobotRecord& record_;
  const RobotMotionOptions& options_;
  RobotCarry<T>* carry_;
  RollingRobot<T> robot_;
  std::array<T, kMaxEffectStates> timing_states_;
  std::optional<RadioController<T>> controller_;
  std::optional<FirmwareLoop> firmware_;
  PerWheel<T> duty_{}, turned_rad_{};
  double last_control_s_ = 0.0, next_control_s_ = 0.0;
  T camera_age_s_ = T(0);
  std::vector<T> heading_;
  Truth<T> truth_;
  RobotMotion<T> out_;
};

}  // namespace

template <typename T>
RobotModelValues<T> robot_values(const Candidate& candidate, std::span<const Unknown> unknowns,
                                 std::size_t first) {
  return rig_values<T>({candidate, unknowns, first},
                       rolling_params_as<T>(rolling_params(candidate.file.parameters)), rolling_number<Jet>);
}

template <typename T>
RobotMotion<T> run_robot(const RobotModelValues<T>& model, const RobotRecord& record,
                         const RobotMotionOptions& options, RobotCarry<T>* carry) {
  return Runner<T>(model, record, options, carry).run();
}

template RobotModelValues<double> robot_values(const Candidate&, std::span<const Unknown>, std::size_t);
template RobotModelValues<Jet> robot_values(const Candidate&, std::span<const Unknown>, std::size_t);
template RobotMotion<double> run_robot(const RobotModelValues<double>&, const RobotRecord&,
                                       const RobotMotionOptions&, RobotCarry<double>*);
template RobotMotion<Jet> run_robot(const RobotModelValues<Jet>&, const RobotRecord&,
                                    const RobotMotionOptions&, RobotCarry<Jet>*);

}  // namespace omnihil
