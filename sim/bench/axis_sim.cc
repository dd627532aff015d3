#include "sim/bench/axis_sim.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "sim/drive/motion_record.h"
#include "sim/law/random.h"
#include "sim/law/sensor_reading.h"

namespace omnihil {
namespace {

constexpr double kRecordStep_s = 0.2e-3;  // of the true motion, where timing effects look back
constexpr double kShortest_s = 1e-9;      // between two readings that a mean is taken over
constexpr int kPortions =
    8;  // of a sample's period, over each of which a swinging rotor's speed is linear; a choice
constexpr double kRecordSpan_s = 1.0;  // longer than any delay's upper bound

template <typename T>
class AxisRun {
 public:
  AxisRun(const DriveParams<T>& params, const EffectSet<T>& effects, double step_s)
      : step_s_(step_s),
        sim_(params, effects, step_s),
        state_(sim_.initial_state()),
        record_(kRecordSpan_s),
        looks_back_(!effects.timing.empty()) {}

  // From the start of an input, which has to outlive the run, whatever was run before.
  void begin(const AxisInput& input) {
    const DriveParams<T>& params = sim_.params();
    input_ = &input;
    swings_ = input.imposed_at_rotor && sim_.two_masses();
    sim_.restart(state_);
    state_.now_s = input.time_s.front();
    if (input.command_before && !sim_.effects().command.empty())
      state_.commands.push(state_.now_s - kRecordSpan_s, *input.command_before);
    state_.theta_rotor_rad = input.initial_position_rad * params.gear_ratio;
    const double speed = input.imposed_velocity_rad_s.empty() ? input.initial_velocity_rad_s
                                                              : input.imposed_velocity_rad_s.front();
    state_.omega_rotor_rad_s = speed * params.gear_ratio;
    last_ = {};
    last_.bus_voltage_V =
        input.bus_voltage_V.empty() ? params.supply_voltage_V : T(input.bus_voltage_V.front());
    last_supply_V_ = params.supply_voltage_V;
    charge_C_ = travel_ahead_rad_ = T(0);
    previous_ = {};
    slave(0);
    record_.clear();
    remember();
    previous_s_ = T(state_.now_s);
    if (looks_back_) previous_s_ -= age(0);
    previous_ = instant(previous_s_);
  }

  // From sample k to sample k + 1.
  void advance(std::size_t k) {
    restart(k);
    slave(k);
    const double period_s = input_->time_s[k + 1] - input_->time_s[k];
    const int steps = std::max(1, static_cast<int>(std::ceil(period_s / step_s_ - 1e-6)));
    const double h = period_s / steps;
    if (h != sim_.step_s()) sim_.set_step(h);
    const int portion = looks_back_ ? std::clamp(static_cast<int>(kRecordStep_s / h + 0.5), 1, steps)
                        : swings_   ? std::max(1, steps / kPortions)
                                    : steps;
    DriveInput<T> in = drive_input(k);
    DriveResult<T> sum;
    sum.held = true;
    for (int done = 0; done < steps;) {
      const int count = std::min(portion, steps - done);
      impose(k, static_cast<double>(done) / steps, static_cast<double>(done + count) / steps, in);
      const DriveResult<T> r = sim_.advance(state_, in, count);
      done += count;
      add(r, static_cast<double>(count) / steps, sum);
      charge_C_ += r.mean_current_A * (h * count);
      if (done == steps) state_.now_s = input_->time_s[k + 1];  // no drift from adding sub-steps
      remember();
    }
    last_ = sum;
    last_supply_V_ = supply(period_s);
  }

  AxisSample<T> sample(std::size_t k) {
    const auto& p = sim_.params();
    const T seen_s = looks_back_ ? T(state_.now_s) - age(k) : T(state_.now_s);
    const MotionPoint<T> seen = instant(seen_s);
    AxisSample<T> s;
    s.time_s = input_->time_s[k];
    // mean since the last reading was taken, whatever the stamps say
    const T since_s = seen_s - previous_s_;
    const bool moved_on = k > 0 && std::abs(value_of(since_s)) > kShortest_s;
    const T current_A = moved_on ? (seen.charge_C - previous_.charge_C) / since_s : state_.current_A;
    const SensorPort<T> port = sense(k, seen, current_A);
    // A sensor of angle or speed beside the encoder is another one, and sits at the output.
    s.position_rad = (has_encoder() ? seen.theta_rad : port.encoder_angle_rad) / p.gear_ratio + seen.lead_rad;
    s.velocity_rad_s = port.measured_speed_rad_s / p.gear_ratio + seen.lead_rad_s;
    // counts = angle of the encoder's shaft * counts per turn / 2 pi
    s.encoder_counts = port.encoder_angle_rad * port.encoder_turns_per_rotor_turn *
                       (input_->encoder_counts_per_turn / (2.0 * std::numbers::pi));
    s.motor_current_A = port.measured_current_A;
    s.bus_voltage_V = last_.bus_voltage_V;
    s.supply_voltage_V = last_supply_V_;
    s.bus_current_A = last_.mean_bus_current_A;
    s.motor_voltage_V = last_.mean_voltage_V;
    s.load_torque_Nm = last_.mean_outside_torque_Nm * p.gear_ratio;
    s.winding_rise_K = state_.temperature_rise_K;
    s.theta_rotor_rad = state_.theta_rotor_rad + travel_ahead_rad_;
    s.omega_rotor_rad_s = state_.omega_rotor_rad_s;
    s.held = last_.held;
    previous_ = seen;
    previous_s_ = seen_s;
    return s;
  }

 private:
  DriveInput<T> drive_input(std::size_t k) const {
    const auto& p = sim_.params();
    DriveInput<T> in;
    in.kind = input_->kind;
    in.setpoint = T(input_->command[k]);
    in.enabled = input_->enable.empty() || input_->enable[k] != 0;
    in.bus_is_measured = !input_->bus_voltage_V.empty();
    if (in.bus_is_measured) in.bus_voltage_V = input_->bus_voltage_V[k];
    if (!input_->load_torque_Nm.empty()) in.tau_outside_Nm = input_->load_torque_Nm[k] / p.gear_ratio;
    return in;
  }

  void impose(std::size_t k, double from, double to, DriveInput<T>& in) const {
    if (input_->imposed_velocity_rad_s.empty()) return;
    const double gear = value_of(sim_.params().gear_ratio);
    in.speed_is_imposed = true;
    in.rotor_is_imposed = input_->imposed_at_rotor;
    in.motor_torque_is_needed = input_->command_is_compared;
    in.imposed_start_rad_s = gear * imposed_speed(k, from);
    in.imposed_end_rad_s = gear * imposed_speed(k, to);
  }

  // A share of the way from sample k to the next: linear; where an output swings behind the rotor, which a line would keep from
  // what turns within a few samples, of the cubic through four samples.
  double imposed_speed(std::size_t k, double share) const {
    const std::vector<double>& w = input_->imposed_velocity_rad_s;
    const double line = w[k] + (w[k + 1] - w[k]) * share;
    if (!swings_ || k == 0 || k + 2 >= w.size()) return line;
    // Lagrange: line + s (s - 1) / 2 of the second difference, + (s + 1) s (s - 1) / 6 of the third
    const double second = w[k + 1] - 2.0 * w[k] + w[k - 1],
                 third = w[k + 2] - 3.0 * w[k + 1] + 3.0 * w[k] - w[k - 1];
    return line + share * (share - 1.0) * (0.5 * second + (share + 1.0) / 6.0 * third);
  }

  static void add(const DriveResult<T>& r, double share, DriveResult<T>& sum) {
    sum.mean_current_A += share * r.mean_current_A;
    sum.mean_bus_current_A += share * r.mean_bus_current_A;
    sum.mean_voltage_V += share * r.mean_voltage_V;
    sum.mean_outside_torque_Nm += share * r.mean_outside_torque_Nm;
    sum.bus_voltage_V = r.bus_voltage_V;
    sum.held = sum.held && r.held;
  }

  // The angle that laws see becomes the measured one; what it is moved by is kept beside it.
  void slave(std::size_t k) {
    if (input_->measured_position_rad.empty() || !std::isfinite(input_->measured_position_rad[k])) return;
    const T shift = input_->measured_position_rad[k] * sim_.params().gear_ratio - state_.theta_rotor_rad;
    state_.theta_rotor_rad += shift;
    state_.corrected_rad += shift;
    if (state_.has_output) state_.theta_output_rad += shift / sim_.params().gear_ratio;
    travel_ahead_rad_ -= shift;
  }

  void restart(std::size_t k) {
    if (input_->restart_velocity_rad_s.empty() || !std::isfinite(input_->restart_velocity_rad_s[k])) return;
    const auto& p = sim_.params();
    state_.omega_rotor_rad_s = input_->restart_velocity_rad_s[k] * p.gear_ratio;
    state_.omega_change_rad_s = state_.current_A = T(0);
    if (!state_.has_output) return;
    state_.omega_output_rad_s = T(input_->restart_velocity_rad_s[k]);
    state_.theta_output_rad = state_.theta_rotor_rad / p.gear_ratio;
  }

  // What the model's supply gives at the mean current of the period.
  T supply(double period_s) {
    if (input_->bus_voltage_V.empty()) return last_.bus_voltage_V;
    SupplyPort<T> port;
    port.bus_current_A = last_.mean_bus_current_A;
    port.dt_s = period_s;
    port.bus_voltage_V = sim_.params().supply_voltage_V;
    sim_.effects().supply.apply(sim_.effects().values(), state_.effects.data(), port);
    return port.bus_voltage_V;
  }

  // What the encoder's shaft does, at the rotor.
  MotionPoint<T> now() const {
    MotionPoint<T> point{state_.now_s, state_.theta_rotor_rad + travel_ahead_rad_, state_.omega_rotor_rad_s,
                         charge_C_};
    if (!state_.has_output) return point;
    const T& gear = sim_.params().gear_ratio;
    if (input_->encoder_on_output) {
      point.theta_rad = state_.theta_output_rad * gear + travel_ahead_rad_;
      point.omega_rad_s = state_.omega_output_rad_s * gear;
    } else {
      point.lead_rad = state_.theta_output_rad - state_.theta_rotor_rad / gear;
      point.lead_rad_s = state_.omega_output_rad_s - state_.omega_rotor_rad_s / gear;
    }
    return point;
  }
  void remember() {
    if (looks_back_) record_.push(now());
  }
  MotionPoint<T> instant(const T& time_s) const {
    return looks_back_ && !alone_ ? record_.at(time_s) : now();
  }

  bool has_encoder() const { return input_->encoder_counts_per_turn > 0.0; }

  T age(std::size_t k) {
    alone_ = k == 0;  // nothing to look back at yet
    return reading_age(sim_.effects(), state_.effects.data(), Stamped::kDriveSensors, stamp(k, "timing"));
  }

  SensorPort<T> sense(std::size_t k, const MotionPoint<T>& seen, const T& current_A) {
    SensorPort<T> port;
    port.measured_current_A = current_A;
    port.theta_rotor_rad = seen.theta_rad - travel_ahead_rad_;
    port.encoder_angle_rad = seen.theta_rad;
    port.omega_rotor_rad_s = port.measured_speed_rad_s = seen.omega_rad_s;
    port.speed_is_the_encoders = !has_encoder();
    if (input_->encoder_on_output) port.encoder_turns_per_rotor_turn = 1.0 / sim_.params().gear_ratio;
    if (sim_.effects().sensor.empty()) return port;
    port.counts_per_turn = T(input_->encoder_counts_per_turn);
    read_encoder(sim_.effects(), state_.effects.data(), stamp(k, "sensor"),
                 T(seen.theta_rad - previous_.theta_rad), port);
    return port;
  }

  ReadingStamp stamp(std::size_t k, std::string_view stream) const {
    return stamp_of(input_->time_s, k, input_->noise_seed, stream_of(stream));
  }

  const AxisInput* input_ = nullptr;
  double step_s_;
  DriveSim<T> sim_;
  DriveState<T> state_;
  MotionRecord<T> record_;
  bool looks_back_;
  bool swings_ = false;  // the output, behind an imposed rotor
  bool alone_ = false;
  DriveResult<T> last_;
  MotionPoint<T> previous_;
  T previous_s_ = T(0);  // its instant
  T charge_C_ = T(0);
  T last_supply_V_ = T(0);
  T travel_ahead_rad_ = T(0);  // the model's own travel, ahead of the slaved angle
};

}  // namespace

template <typename T>
void visit_axis(const DriveParams<T>& params, const EffectSet<T>& effects, const AxisInput& input,
                const AxisOptions& options, const AxisVisitor<T>& visit) {
  const std::size_t count = input.time_s.size();
  assert(input.command.size() == count);
  if (count == 0) return;
  AxisRun<T> run(params, effects, options.step_s);
  run.begin(input);
  visit(0, run.sample(0));
  for (std::size_t k = 0; k + 1 < count; ++k) {
    run.advance(k);
    visit(k + 1, run.sample(k + 1));
  }
}

template <typename T>
void visit_axis_ends(const DriveParams<T>& params, const EffectSet<T>& effects, std::size_t count,
                     const std::function<const AxisInput&(std::size_t)>& input, const AxisOptions& options,
                     const AxisVisitor<T>& visit) {
  AxisRun<T> run(params, effects, options.step_s);
  for (std::size_t n = 0; n < count; ++n) {
    const AxisInput& in = input(n);
    assert(!in.time_s.empty() && in.command.size() == in.time_s.size());
    run.begin(in);
    AxisSample<T> last = run.sample(0);
    for (std::size_t k = 0; k + 1 < in.time_s.size(); ++k) {
      run.advance(k);
      last = run.sample(k + 1);
    }
    visit(n, last);
  }
}

template <typename T>
std::vector<AxisSample<T>> run_axis(const DriveParams<T>& params, const EffectSet<T>& effects,
                                    const AxisInput& input, const AxisOptions& options) {
  std::vector<AxisSample<T>> samples;
  samples.reserve(input.time_s.size());
  visit_axis<T>(params, effects, input, options,
                [&](std::size_t, const AxisSample<T>& sample) { samples.push_back(sample); });
  return samples;
}

template void visit_axis(const DriveParams<double>&, const EffectSet<double>&, const AxisInput&,
                         const AxisOptions&, const AxisVisitor<double>&);
template void visit_axis(const DriveParams<Jet>&, const EffectSet<Jet>&, const AxisInput&, const AxisOptions&,
                         const AxisVisitor<Jet>&);
template void visit_axis_ends(const DriveParams<double>&, const EffectSet<double>&, std::size_t,
                              const std::function<const AxisInput&(std::size_t)>&, const AxisOptions&,
                              const AxisVisitor<double>&);
template void visit_axis_ends(const DriveParams<Jet>&, const EffectSet<Jet>&, std::size_t,
                              const std::function<const AxisInput&(std::size_t)>&, const AxisOptions&,
                              const AxisVisitor<Jet>&);

template std::vector<AxisSample<double>> run_axis(const DriveParams<double>&, const EffectSet<double>&,
                                                  const AxisInput&, const AxisOptions&);
template std::vector<AxisSample<Jet>> run_axis(const DriveParams<Jet>&, const EffectSet<Jet>&,
                                               const AxisInput&, const AxisOptions&);

}  // namespace omnihil
