#include "identify/predict/robot_motion.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "identify/predict/camera_path.h"
#include "identify/predict/firmware_loop.h"
#include "identify/predict/interpolation.h"
#include "sim/law/random.h"
#include "sim/law/sensor_reading.h"

namespace omnihil {
namespace {

// Everything true at a sample, beside what RollingSample keeps of it.
template <typename T>
struct Truth {
  PerWheel<T> theta_rotor_rad{}, omega_rotor_rad_s{}, reported_rad_s{}, charge_C{};
  std::array<T, 3> velocity{};
  std::array<T, 2> accel_m_s2{}, force_N{};
};

bool is_finite(double x) { return std::isfinite(x); }
bool is_finite(const Jet& x) { return std::isfinite(x.a) && x.v.allFinite(); }

template <typename T>
class Runner {
 public:
  Runner(const RobotModelValues<T>& model, const RobotRecord& record, const RobotMotionOptions& options,
         RobotCarry<T>* carry)
      : model_(model),
        record_(record),
        options_(options),
        carry_(carry),
        robot_(model.params, model.uses, model.values) {
    std::ranges::copy(robot_.effects().initial_states(), initial_states_.begin());
    if (record.radio && options.firmware != nullptr) {
      const auto& c = model.params.controller;
      firmware_.emplace(*options.firmware, value_of(c.latency_s), record.time_s[0], c.report_filter_s);
    } else if (record.radio) {
      at_.controller.emplace(model.params.controller,
                             std::span(model.params.wheel_angle_rad).first(model.params.wheels),
                             value_of(model.params.drive.gear_ratio));
    }
  }

  RobotMotion<T> run() {
    // ages of the camera do not change along a run, but for jitter, which has no expected value
    if (auto states = initial_states_; !timing().empty() && record_.size() > 1)
      camera_age_s_ = age(Stamped::kVision, 0, states);
    if (options_.follow_camera) heading_ = headings(record_, camera_age_s_);
    simulate();
    sense();
    see_path(record_, {options_.follow_camera, camera_age_s_, heading_}, out_.samples);
    return std::move(out_);
  }

 private:
  using EffectStates = std::array<T, kMaxEffectStates>;
  const EffectChain<T, TimingPort<T>>& timing() const { return robot_.effects().timing; }

  T age(Stamped what, std::size_t k, EffectStates& states) const {
    return reading_age(robot_.effects(), states.data(), what, stamp(k, stream_of("timing")));
  }
  ReadingStamp stamp(std::size_t k, std::uint64_t stream) const {
    return stamp_of(record_.time_s, k, options_.noise_seed, stream);
  }

  RollingInput<T> input(std::size_t k) const {
    RollingInput<T> in;
    for (std::size_t i = 0; i < record_.wheels; ++i) in.duty_ratio[i] = T(record_.duty_ratio[k][i]);
    in.enabled = record_.enabled[k];
    in.bus_is_measured = !record_.bus.input_V.empty();
    if (in.bus_is_measured) in.bus_voltage_V = record_.bus.input_V[k];
    in.dribbler_rad_s = record_.dribbler_rad_s[k];
    if (record_.has_all_encoders && options_.slave_angle) in.theta_rotor_rad = &record_.theta_rotor_rad[k];
    return in;
  }

  // Commands are heard at their samples; the loop runs once per period, on the mean speed since it last ran.
  void hear(std::size_t k) {
    const RadioCommands& radio = *record_.radio;
    if (!radio.said(k)) return;
    if (firmware_) firmware_->hear(record_.time_s[k], radio.value[k], radio.frame);
    if (at_.controller) at_.controller->hear(record_.time_s[k], radio.value[k], radio.frame);
  }
  void run_firmware(RollingInput<T>& in, double now_s) {
    const RollingState<T>& x = at_.state;
    if (firmware_->due(now_s)) {
      RobotInstant sees{.gyro_rad_s = value_of(x.velocity[2]),
                        .accel_x_m_s2 = value_of(x.accel_x_m_s2),
                        .accel_y_m_s2 = value_of(x.accel_y_m_s2),
                        .bus_voltage_V = value_of(bus_or_supply(in))};
      for (std::size_t i = 0; i < kWheels; ++i) {
        sees.theta_rotor_rad[i] = value_of(x.theta_rotor_rad[i]);
        sees.omega_rotor_rad_s[i] = value_of(x.omega_rotor_rad_s(i));
        sees.charge_C[i] = value_of(x.charge_C[i]);
      }
      firmware_->tick(now_s, sees);
    }
    for (std::size_t i = 0; i < kWheels; ++i) {
      in.duty_ratio[i] = T(firmware_->duty()[i]);
      in.enabled[i] = firmware_->enabled()[i];
    }
  }
  void control(RollingInput<T>& in, double now_s, double step_s) {
    if (now_s >= at_.next_control_s - 0.5 * step_s) {
      const double span_s = now_s - at_.last_control_s;
      PerWheel<T> omega = speeds();
      for (std::size_t i = 0; i < record_.wheels; ++i) {
        if (span_s > 0.0) omega[i] = at_.turned_rad[i] * (1.0 / span_s);
        at_.turned_rad[i] = T(0);
      }
      at_.duty = at_.controller->update(now_s, omega, bus_or_supply(in),
                                        value_of(model_.params.drive.duty_limit_ratio));
      at_.last_control_s = now_s;
      at_.next_control_s += at_.controller->period_s();
    }
    in.duty_ratio = at_.duty;
  }
  T bus_or_supply(const RollingInput<T>& in) const {
    const T bus = in.bus_is_measured ? T(in.bus_voltage_V) : at_.state.bus_voltage_V;
    return value_of(bus) > 0.0 ? bus : model_.params.drive.supply_voltage_V;
  }
  PerWheel<T> speeds() const {
    PerWheel<T> omega{};
    for (std::size_t i = 0; i < record_.wheels; ++i) omega[i] = at_.state.omega_rotor_rad_s(i);
    return omega;
  }

  void begin() {
    if (carry_ != nullptr && carry_->begun) {
      at_ = *carry_;
      return;
    }
    at_.state = robot_.start(record_.start_velocity, record_.theta_rotor_rad[0]);
    if (!at_.controller) return;
    at_.last_control_s = at_.next_control_s = record_.time_s[0];
    at_.controller->begin(record_.start_velocity, speeds(), model_.params.drive.torque_constant_Nm_per_A,
                          record_.radio->frame);
  }

  // What of the period after sample k a step is, in any unit.
  struct Part {
    double from, to, whole;
  };
  void step(std::size_t k, const Part& part, RollingInput<T> in) {
    const double period_s = record_.time_s[k + 1] - record_.time_s[k];
    const double h = period_s * (part.to - part.from) / part.whole;
    const double now_s = record_.time_s[k] + period_s * part.from / part.whole;
    RollingState<T>& x = at_.state;
    PerWheel<double> angle;
    std::array<double, 3> imposed;
    const auto between = [&](const auto& values, std::size_t i, double at) {
      return values[k][i] + (values[k + 1][i] - values[k][i]) * at / part.whole;
    };
    for (std::size_t i = 0; i < record_.wheels && in.theta_rotor_rad != nullptr; ++i)
      angle[i] = between(record_.theta_rotor_rad, i, part.from);
    if (in.theta_rotor_rad != nullptr) in.theta_rotor_rad = &angle;
    for (std::size_t a = 0; a < 3 && !record_.imposed_velocity.empty(); ++a) {
      imposed[a] = between(record_.imposed_velocity, a, part.to);
      in.imposed_velocity = &imposed;
    }
    x.yaw_rad = heading_.empty() ? at_.heading : heading_[k];
    const T turn_rate = x.velocity[2];
    const PerWheel<T> omega = at_.controller ? speeds() : PerWheel<T>{};
    if (at_.controller) control(in, now_s, h);
    robot_.advance(x, in, h);
    for (std::size_t i = 0; i < record_.wheels && at_.controller; ++i)
      at_.turned_rad[i] += (omega[i] + x.omega_rotor_rad_s(i)) * (0.5 * h);
    at_.heading += 0.5 * (turn_rate + x.velocity[2]) * h;
  }

  // The period after sample k in steps of the same length, longest_s at most. Where a firmware drives, each stretch of it ends
  // where the firmware runs next.
  void pass(std::size_t k, double longest_s) {
    constexpr double kSame_s = 1e-9;  // rounding of sums of periods; a choice
    constexpr double kOff = 1e-6;     // of a step: clocks are sums; a choice
    const double start_s = record_.time_s[k], period_s = record_.time_s[k + 1] - start_s;
    RollingInput<T> in = input(k);
    for (double at_s = 0.0, until_s; at_s < period_s; at_s = until_s) {
      if (firmware_) run_firmware(in, start_s + at_s);
      until_s = firmware_ ? firmware_->next_s() - start_s : period_s;
      if (until_s <= at_s || until_s > period_s - kSame_s) until_s = period_s;
      const double stretch_s = until_s - at_s;
      const int steps = std::max(1, static_cast<int>(std::ceil(stretch_s / longest_s - kOff)));
      for (int j = 0; j < steps; ++j)
        step(k,
             firmware_ ? Part{at_s + stretch_s * j / steps, at_s + stretch_s * (j + 1) / steps, period_s}
                       : Part{static_cast<double>(j), j + 1.0, static_cast<double>(steps)},
             in);
    }
  }

  void simulate() {
    begin();
    truth_.reserve(record_.size());
    out_.samples.reserve(record_.size());
    double step_s = model_.params.has_tyre && !options_.rough ? kSlippingStep_s : kRollingStep_s;
    if (at_.controller) step_s = std::min(step_s, at_.controller->period_s());
    for (std::size_t k = 0; out_.finite; ++k) {
      // What a row tells is of the loop's run at its instant, if one falls there; that of the last row is tried: its command
      // is heard by the motion that goes on from there.
      const bool last = k + 1 >= record_.size();
      const std::optional<RobotCarry<T>> before = last ? std::optional(at_) : std::nullopt;
      if (record_.radio && !last) hear(k);
      if (RollingInput<T> in = input(k); at_.controller) control(in, record_.time_s[k], step_s);
      keep();
      if (last) at_ = *before;
      if (last) break;
      pass(k, step_s);
      const RollingState<T>& x = at_.state;
      out_.finite = !(firmware_ && firmware_->failed()) && is_finite(x.velocity[0]) &&
                    is_finite(x.omega_rotor_rad_s(0)) && is_finite(x.charge_C[0]);
    }
    at_.begun = out_.finite;
    if (carry_ != nullptr) *carry_ = at_;
    // samples after a divergence; `finite` marks the run as diverged
    RollingState<T>& x = at_.state;
    x.velocity.fill(T(kMissing));
    x.theta_rotor_rad.fill(T(kMissing));
    x.charge_C.fill(T(kMissing));
    x.accel_x_m_s2 = x.accel_y_m_s2 = T(kMissing);
    while (truth_.size() < record_.size()) keep();
  }

  void keep() {
    const RollingState<T>& x = at_.state;
    Truth<T>& t = truth_.emplace_back();
    t = {.theta_rotor_rad = x.theta_rotor_rad,
         .omega_rotor_rad_s = speeds(),
         .reported_rad_s = speeds(),
         .charge_C = x.charge_C,
         .velocity = x.velocity,
         .accel_m_s2 = {x.accel_x_m_s2, x.accel_y_m_s2},
         .force_N = {x.floor_x_N, x.floor_y_N}};
    std::array<double, kWheels> told;
    const bool tells = firmware_ && firmware_->tells(value_of(model_.params.drive.gear_ratio), told);
    RollingSample<T>& s = out_.samples.emplace_back();
    s.bus_voltage_V = x.bus_voltage_V;
    s.supply_voltage_V = x.supply_voltage_V;
    s.velocity = x.velocity;
    for (std::size_t i = 0; i < record_.wheels; ++i) {
      if (at_.controller) t.reported_rad_s[i] = at_.controller->reported_rad_s(i);
      if (tells) t.reported_rad_s[i] = T(told[i]);
      s.temperature_rise_K += (1.0 / static_cast<double>(record_.wheels)) * x.drive[i].temperature_rise_K;
    }
  }

  void sense() {
    const T inverse_gear = 1.0 / model_.params.drive.gear_ratio;
    EffectStates timing_states = initial_states_;
    PerWheel<EffectStates> states;
    states.fill(initial_states_);
    PerWheel<T> last_theta = truth_[0].theta_rotor_rad, last_charge{};
    T last_s = T(record_.time_s[0]);
    for (std::size_t k = 0; k < record_.size(); ++k) {
      T seen_s = T(record_.time_s[k]);
      if (!timing().empty()) seen_s -= age(Stamped::kDriveSensors, k, timing_states);
      const bool now = timing().empty() || record_.size() < 2;
      const Instant<T> at = now ? Instant<T>{} : instant(record_.time_s, seen_s);
      const auto seen = [&](auto what, std::size_t part) {
        return now ? (truth_[k].*what)[part] : at.of([&](std::size_t j) { return (truth_[j].*what)[part]; });
      };
      const T span_s = seen_s - last_s;
      RollingSample<T>& s = out_.samples[k];
      for (std::size_t i = 0; i < record_.wheels; ++i) {
        const T theta = seen(&Truth<T>::theta_rotor_rad, i);
        const T omega = seen(&Truth<T>::omega_rotor_rad_s, i);
        const T charge = seen(&Truth<T>::charge_C, i);
        s.wheel_rad_s[i] = seen(&Truth<T>::reported_rad_s, i) * inverse_gear;
        if (value_of(span_s) > 0.0) s.current_A[i] = (charge - last_charge[i]) / span_s;
        s.encoder_rad[i] = theta;
        sense(k, i, omega, T(theta - last_theta[i]), states[i], s);
        last_theta[i] = theta;
        last_charge[i] = charge;
      }
      last_s = seen_s;
      s.gyro_rad_s = seen(&Truth<T>::velocity, 2);
      for (std::size_t a = 0; a < 2; ++a) {
        s.accel_m_s2[a] = seen(&Truth<T>::accel_m_s2, a);
        s.force_N[a] = seen(&Truth<T>::force_N, a);
      }
    }
  }

  // What a wheel's sensors make of its true angle and current, in the sample.
  void sense(std::size_t k, std::size_t i, const T& omega, const T& turned_rad, EffectStates& states,
             RollingSample<T>& sample) const {
    const EffectSet<T>& effects = robot_.effects();
    if (effects.sensor.empty()) return;
    SensorPort<T> port;
    port.theta_rotor_rad = port.encoder_angle_rad = sample.encoder_rad[i];
    port.measured_current_A = sample.current_A[i];
    if (record_.has_all_encoders && options_.slave_angle) {
      // an encoder's error depends on the angle: the law takes the angle at the sampled (earlier) instant
      port.theta_rotor_rad = T(record_.theta_rotor_rad[k][i]);
      port.encoder_angle_rad = port.theta_rotor_rad;
    }
    port.omega_rotor_rad_s = port.measured_speed_rad_s = omega;
    port.counts_per_turn = T(record_.counts_per_rotor_turn[i]);
    read_encoder(effects, states.data(), stamp(k, stream_of("sensor") + i), turned_rad, port);
    sample.encoder_rad[i] += port.encoder_angle_rad - port.theta_rotor_rad;
    sample.current_A[i] = port.measured_current_A;
  }

  const RobotModelValues<T>& model_;
  const RobotRecord& record_;
  const RobotMotionOptions& options_;
  RobotCarry<T>* carry_;
  RollingRobot<T> robot_;
  EffectStates initial_states_{};
  RobotCarry<T> at_;
  std::optional<FirmwareLoop> firmware_;
  T camera_age_s_ = T(0);
  std::vector<T> heading_;
  std::vector<Truth<T>> truth_;
  RobotMotion<T> out_;
};

}  // namespace

template <typename T>
RobotMotion<T> run_robot(const RobotModelValues<T>& model, const RobotRecord& record,
                         const RobotMotionOptions& options, RobotCarry<T>* carry) {
  if (record.settled.empty()) return Runner<T>(model, record, options, carry).run();
  RobotMotion<T> out;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const RobotRecord point = settled_point(record, k);
    RobotMotion<T> at = Runner<T>(model, point, options, nullptr).run();
    out.finite = out.finite && at.finite;
    out.samples.push_back(std::move(at.samples.back()));
  }
  return out;
}

template RobotMotion<double> run_robot(const RobotModelValues<double>&, const RobotRecord&,
                                       const RobotMotionOptions&, RobotCarry<double>*);
template RobotMotion<Jet> run_robot(const RobotModelValues<Jet>&, const RobotRecord&,
                                    const RobotMotionOptions&, RobotCarry<Jet>*);

}  // namespace omnihil
