#include "identify/predict/axis_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/bench/axis_signal.h"

namespace omnihil {
namespace {

void set_motion(const Dataset& dataset, const AxisRecord& r, AxisInput& in) {
  for (const double e : r.enable) in.enable.push_back(e != 0.0 ? 1 : 0);
  if (const Channel* encoder = dataset.channel("encoder"); encoder != nullptr) {
    in.encoder_counts_per_turn = encoder->counts_per_rev;
    in.encoder_on_output = encoder->on_output;
  }
  const std::vector<double> angle = r.angle();
  const bool servo = in.kind == CommandKind::kPositionTarget;
  if (!servo) in.measured_position_rad = angle.empty() ? r.angle_by_speed() : angle;
  in.initial_position_rad = first_known(angle, 0.0);
  const double speed = servo && r.velocity.empty() ? 0.0 : r.speed_near(0);
  in.initial_velocity_rad_s = std::isfinite(speed) ? speed : 0.0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (!r.gap_before(k) || !std::isfinite(r.speed_near(k))) continue;
    in.restart_velocity_rad_s.resize(r.size(), kMissing);
    in.restart_velocity_rad_s[k] = r.speed_near(k);
  }
}

// Does a record begin at rest and without current, whatever it asks for? Then nothing was asked before it: a drive that is late by
// a delay has not heard its first row yet.
bool begins_at_rest(const AxisRecord& r, CommandKind kind) {
  constexpr double kWithin_sigmas = 4.0;  // one in 16,000 leaves it by chance (normal); a choice
  const auto nearly_zero = [](const std::vector<double>& x) {
    const NoiseEstimate noise = estimate_noise(x);
    return std::abs(first_known(x, 0.0)) <= kWithin_sigmas * std::max(noise.sigma, noise.quantum);
  };
  const bool current_is_asked = kind == CommandKind::kMotorCurrent;
  if (!current_is_asked && !r.current.empty() && !nearly_zero(r.current)) return false;
  if (!r.velocity.empty()) return nearly_zero(r.velocity);
  const std::vector<double>& x = r.position_or_counts();
  if (x.size() < 2) return false;
  const double quantum = r.position.empty() ? 1.0 : estimate_noise(x).quantum;
  return std::abs(x[1] - x[0]) <= 1.5 * quantum;  // one count, or rounding
}

// What a forward run is compared with. A servo holds an angle: that is compared, from its own sensor or from the encoder,
// and not its speed.
void compare_forward(const Dataset& dataset, const AxisRecord& r, AxisSetup& s) {
  const bool servo = s.input.kind == CommandKind::kPositionTarget;
  const bool fast = !r.velocity.empty(), counted = !r.counts.empty(), placed = !r.position.empty();
  const auto add = [&](Quantity quantity, View view, const char* signal,
                       const std::vector<double>& measured) {
    if (!measured.empty())
      add_channel(s, {.quantity = quantity, .view = view}, *dataset.channel(signal), r.time_s, measured);
  };
  const auto differences = [&](Quantity quantity, const std::vector<double>& x, double per_unit, double sigma,
                               double quantum) {
    add_difference(s, {.quantity = quantity, .view = View::kDifference, .per_unit = per_unit},
                   fast ? "encoder_velocity" : "velocity", dataset.linear ? "m/s" : "rad/s", r.time_s, x,
                   r.longest_gap_s(), sigma, quantum, kWhitening_s);
  };
  // rounding of counts: uniform, sigma = 1 / sqrt(12) count
  const double per_rad = r.counts_per_output_rad;
  const double count_sigma =
      counted ? std::hypot(1.0 / std::sqrt(12.0), dataset.channel("encoder")->sigma) / per_rad : 0.0;
  if (servo ? !placed && !counted : fast) add(Quantity::kSpeed, View::kPoint, "velocity", r.velocity);
  if (servo && placed) {
    add(Quantity::kPosition, View::kPoint, "position", r.position);
  } else if (servo && counted) {
    std::vector<double> angle = r.counts;
    for (double& v : angle) v = (v + 0.5) / per_rad;  // the middle of a count
    add_signal(s, {.quantity = Quantity::kPosition}, "position", dataset.linear ? "m" : "rad", r.time_s,
               std::move(angle), count_sigma)
        .quantum = 1.0 / per_rad;
  } else if (!servo && counted) {
    differences(Quantity::kCounts, r.counts, per_rad, count_sigma, 1.0 / per_rad);
  } else if (!servo && placed && !fast) {
    differences(Quantity::kPosition, r.position, 1.0, noise_sigma_of(dataset, "position", r.position),
                estimate_noise(r.position).quantum);
  }
  add(Quantity::kCurrent, View::kMean, "motor_current", r.current);
  add(Quantity::kTemperature, View::kPoint, "winding_temperature", r.temperature);
  if (r.bus.input_V.size() > 2) add(Quantity::kBusVoltage, View::kLevel, "bus_voltage", r.bus.measured_V);
  for (ComparedSignal& c : s.compared) {
    std::size_t after_gap = 0;
    for (std::size_t k = 1; k < r.size(); ++k) {
      if (r.gap_before(k)) c.measured[k] = kMissing, ++after_gap;
    }
    if (after_gap > 0) c.left_out = fmt::format("{} samples of {} right after a gap", after_gap, c.name);
    if (c.name == "bus_voltage") say_left_out(r.bus, c);
  }
}

}  // namespace

CommandKind axis_command_kind(const Dataset& dataset) {
  for (const CommandKind kind : {CommandKind::kDuty, CommandKind::kMotorVoltage, CommandKind::kMotorTorque,
                                 CommandKind::kPositionTarget}) {
    if (dataset.channel(command_name(kind)) != nullptr) return kind;
  }
  return CommandKind::kMotorCurrent;
}

bool speed_is_imposed(const Dataset& dataset) {
  const Channel* velocity = dataset.channel("velocity");
  return velocity != nullptr && velocity->imposed;
}

Method axis_method(const Dataset& dataset) {
  const bool inverse = speed_is_imposed(dataset) || is_torque(axis_command_kind(dataset));
  return inverse ? Method::kInverse : Method::kForward;
}

AxisSetup make_axis_setup(const Dataset& dataset, const Candidate& nominal, const Run& run) {
  AxisSetup setup;
  setup.method = run.steady ? Method::kInverse : axis_method(dataset);
  setup.steady = run.steady;
  const AxisRecord record = make_axis_record(dataset, nominal, run);
  setup.first_temperature_degC = first_known(record.temperature, 0.0);
  if (record.size() < 2) return setup;
  AxisInput& in = setup.input;
  in.kind = axis_command_kind(dataset);
  if (run.steady || setup.method == Method::kForward) {  // else an even clock's
    in.time_s = record.time_s, in.command = record.command;
    in.bus_voltage_V = record.bus.input_V, in.load_torque_Nm = record.load_torque_Nm;
  }
  if (run.steady) {
    make_steady_setup(dataset, record, setup);
  } else if (setup.method == Method::kInverse) {
    make_inverse_setup(dataset, drive_of(nominal), record, setup);
  } else {
    set_motion(dataset, record, in);
    if (in.kind != CommandKind::kPositionTarget && begins_at_rest(record, in.kind)) in.command_before = 0.0;
    compare_forward(dataset, record, setup);
    setup.velocity = smoothed_velocity(record);
    setup.position = record.angle();
    setup.measured_current = record.current;
    setup.measured_temperature = record.temperature;
  }
  return setup;
}

}  // namespace omnihil
