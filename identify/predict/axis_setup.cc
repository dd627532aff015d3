#include "identify/predict/axis_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/predict/axis_inverse.h"
#include "identify/predict/axis_record.h"
#include "sim/bench/axis_signal.h"

namespace omnihil {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool finite(double v) { return std::isfinite(v); }

// Differences of successive known values over the time between them; NaN at the first and at missing ones.
// `from`: the sample before, or the sample itself where there is none.
std::vector<double> differenced(const AxisRecord& r, const std::vector<double>& x, double per_unit,
                                std::vector<std::size_t>& from) {
  std::vector<double> v(x.size(), kMissing);
  from.resize(x.size());
  std::size_t last = x.size();
  for (std::size_t k = 0; k < x.size(); ++k) {
    from[k] = k;
    if (!finite(x[k])) continue;
    const bool known = last < k && !r.gap_before(k);
    if (known) v[k] = (x[k] - x[last]) / per_unit / (r.time_s[k] - r.time_s[last]);
    if (known) from[k] = last;
    last = k;
  }
  return v;
}

class ForwardSetup {
 public:
  ForwardSetup(const Dataset& dataset, const AxisRecord& record, AxisSetup& setup)
      : dataset_(dataset), r_(record), s_(setup) {}

  void make() {
    drive();
    motion();
    if (s_.input.kind != CommandKind::kMotorTorque) others();
  }

 private:
  const Channel& channel(std::string_view name) const {
    static const Channel kNone;
    const Channel* c = dataset_.channel(name);
    return c != nullptr ? *c : kNone;
  }

  void drive() {
    AxisInput& in = s_.input;
    in.kind = axis_command_kind(dataset_);
    in.time_s = r_.time_s;
    in.command = r_.command;
    for (const double e : r_.enable) in.enable.push_back(e != 0.0 ? 1 : 0);
    if (in.kind != CommandKind::kMotorTorque && in.kind != CommandKind::kMotorCurrent)
      in.bus_voltage_V = r_.bus_V;
    in.load_torque_Nm = r_.load_torque_Nm;
    in.encoder_counts_per_turn = channel("encoder").counts_per_rev;
    in.encoder_on_output = channel("encoder").on_output;
    const std::vector<double> angle = r_.angle();
    if (in.kind != CommandKind::kPositionTarget)
      in.measured_position_rad = angle.empty() ? r_.angle_by_speed() : angle;
    for (const double a : angle) {
      if (!finite(a)) continue;
      in.initial_position_rad = a;
      break;
    }
    const bool servo = in.kind == CommandKind::kPositionTarget;
    const double speed = servo && r_.velocity.empty() ? 0.0 : r_.speed_near(0);
    in.initial_velocity_rad_s = finite(speed) ? speed : 0.0;
    for (std::size_t k = 0; k < r_.size(); ++k) {
      if (!r_.gap_before(k) || !finite(r_.speed_near(k))) continue;
      in.restart_velocity_rad_s.resize(r_.size(), kMissing);
      in.restart_velocity_rad_s[k] = r_.speed_near(k);
    }
  }

  ComparedSignal& add(std::string name, std::string unit, AxisOutput output, std::vector<double> measured,
                      double stated_sigma) {
    const NoiseEstimate estimate = estimate_noise(measured, Differences::kSecond);
    ComparedSignal c{.name = std::move(name),
                     .unit = std::move(unit),
                     .time_s = r_.time_s,
                     .measured = std::move(measured),
                     .left_out = {}};
    set_noise(stated_sigma, estimate, c);
    std::size_t after_gap = 0;
    for (std::size_t k = 1; k < r_.size(); ++k) {
      if (r_.gap_before(k)) c.measured[k] = kMissing, ++after_gap;
    }
    if (after_gap > 0) c.left_out = fmt::format("{} samples of {} right after a gap", after_gap, c.name);
    s_.compared.push_back(std::move(c));
    s_.outputs.push_back(output);
    return s_.compared.back();
  }

  void add_differenced(std::string name, AxisOutput output, const std::vector<double>& x, double per_unit,
                       double position_sigma, double quantum) {
    ComparedSignal& c = add(std::move(name), dataset_.linear ? "m/s" : "rad/s", output,
                            differenced(r_, x, per_unit, s_.difference_from), 0.0);
    const double dt = r_.period_s;
    c.noise_is_stated = position_sigma > 0.0;
    c.quantum = quantum / dt;
    // v = (x_i - x_{i-1}) / dt; high-passed by the leak a: var = sigma^2 2 / (1 + a)
    c.noise_sigma = std::sqrt(2.0) * position_sigma / dt;
    c.whitening_s = kWhitening_s;
    c.whitened_sigma = position_sigma * std::sqrt(2.0 / (1.0 + std::exp(-dt / kWhitening_s)));
  }

  // A servo holds an angle: that is compared, from its own sensor or from the encoder.
  void servo_motion(const std::string& position_unit, const std::string& speed_unit) {
    if (!r_.position.empty()) {
      add("position", position_unit, AxisOutput::kPosition, r_.position, channel("position").sigma);
    } else if (!r_.counts.empty()) {
      std::vector<double> angle = r_.counts;
      for (double& v : angle) v = (v + 0.5) / r_.counts_per_output_rad;  // the middle of a count
      ComparedSignal& c =
          add("position", position_unit, AxisOutput::kPosition, std::move(angle),
              std::hypot(1.0 / std::sqrt(12.0), channel("encoder").sigma) / r_.counts_per_output_rad);
      c.quantum = 1.0 / r_.counts_per_output_rad;
    } else {
      add("velocity", speed_unit, AxisOutput::kVelocity, r_.velocity, channel("velocity").sigma);
    }
  }

  void motion() {
    const std::string speed_unit = dataset_.linear ? "m/s" : "rad/s";
    if (s_.input.kind == CommandKind::kPositionTarget) {
      return servo_motion(dataset_.linear ? "m" : "rad", speed_unit);
    }
    const bool has_speed = !r_.velocity.empty();
    if (has_speed) {
      add("velocity", speed_unit, AxisOutput::kVelocity, r_.velocity, channel("velocity").sigma);
    }
    const std::string differences = has_speed ? "encoder_velocity" : "velocity";
    if (!r_.counts.empty()) {
      // rounding of counts: uniform, sigma = 1 / sqrt(12) count
      const double sigma =
          std::hypot(1.0 / std::sqrt(12.0), channel("encoder").sigma) / r_.counts_per_output_rad;
      add_differenced(differences, AxisOutput::kCountsDifferenced, r_.counts, r_.counts_per_output_rad, sigma,
                      1.0 / r_.counts_per_output_rad);
    } else if (!r_.position.empty() && !has_speed) {
      const NoiseEstimate own = estimate_noise(r_.position, Differences::kSecond);
      const double sigma = channel("position").sigma > 0.0 ? channel("position").sigma : own.sigma;
      add_differenced(differences, AxisOutput::kPositionDifferenced, r_.position, 1.0, sigma, own.quantum);
    }
  }

  void others() {
    if (!r_.current.empty() && s_.input.kind != CommandKind::kMotorCurrent) {
      std::vector<double> current = r_.current;
      current.front() = kMissing;  // a mean over a period that the run does not have
      add("motor_current", "A", AxisOutput::kCurrent, std::move(current), channel("motor_current").sigma);
    }
    if (!r_.temperature.empty()) {
      add("winding_temperature", "degC", AxisOutput::kWindingTemperature, r_.temperature,
          channel("winding_temperature").sigma);
    }
    const bool electric = s_.input.kind == CommandKind::kDuty ||
                          s_.input.kind == CommandKind::kPositionTarget ||
                          s_.input.kind == CommandKind::kMotorVoltage;
    if (!r_.bus_measured_V.empty() && electric && r_.bus_V.size() > 2) {
      std::vector<double> bus = r_.bus_measured_V;
      bus.front() = kMissing;
      ComparedSignal& c =
          add("bus_voltage", "V", AxisOutput::kBusVoltage, std::move(bus), channel("bus_voltage").sigma);
      if (r_.bus_left_out > 0 && !c.left_out.empty()) c.left_out += ", ";
      if (r_.bus_left_out > 0) {
        c.left_out += fmt::format("{} readings of bus_voltage that no supply gives", r_.bus_left_out);
      }
    }
  }

  const Dataset& dataset_;
  const AxisRecord& r_;
  AxisSetup& s_;
};

}  // namespace

CommandKind axis_command_kind(const Dataset& dataset) {
  for (const CommandKind kind : {CommandKind::kDuty, CommandKind::kMotorVoltage, CommandKind::kMotorTorque,
                                 CommandKind::kPositionTarget}) {
    if (dataset.channel(command_name(kind)) != nullptr) return kind;
  }
  return CommandKind::kMotorCurrent;
}

Method axis_method(const Dataset& dataset) {
  const CommandKind kind = axis_command_kind(dataset);
  const Channel* velocity = dataset.channel("velocity");
  const bool imposed = velocity != nullptr && velocity->imposed;
  const bool by_torque = kind == CommandKind::kMotorTorque || kind == CommandKind::kMotorCurrent;
  return imposed || by_torque ? Method::kInverse : Method::kForward;
}

AxisSetup make_axis_setup(const Dataset& dataset, const Candidate& nominal, const Run& run) {
  AxisSetup setup;
  setup.method = run.steady ? Method::kInverse : axis_method(dataset);
  setup.steady = run.steady;
  const AxisRecord record = make_axis_record(dataset, nominal, run);
  setup.first_row = record.first_row;
  setup.counts_per_output_rad = record.counts_per_output_rad;
  setup.first_temperature_degC = first_known(record.temperature, 0.0);
  if (record.size() < 2) return setup;
  if (run.steady) {
    make_steady_setup(dataset, record, setup);
  } else if (setup.method == Method::kInverse) {
    make_inverse_setup(dataset, drive_of(nominal), record, setup);
  } else {
    ForwardSetup(dataset, record, setup).make();
    setup.velocity = smoothed_velocity(record);
    setup.position = record.angle();
    setup.measured_current = record.current;
    setup.measured_temperature = record.temperature;
  }
  return setup;
}

}  // namespace omnihil
