#include "identify/predict/robot_signals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "identify/predict/camera_path.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kAnyGap_s = std::numeric_limits<double>::infinity();

constexpr std::size_t kEachWheel = kMaxWheels;  // beyond all parts
struct Source {
  Quantity quantity;
  View view;
  std::string_view channel;  // without the wheel's index
  std::string_view unit;
  std::size_t part = 0;
};
constexpr Source kSources[] = {
    {Quantity::kCounts, View::kDifference, "encoder", "rad/s", kEachWheel},
    {Quantity::kWheelSpeed, View::kPoint, "wheel_speed", "rad/s", kEachWheel},
    {Quantity::kCurrent, View::kMean, "motor_current", "A", kEachWheel},
    {Quantity::kGyro, View::kPoint, "gyro_z", "rad/s"},
    {Quantity::kAccelerometer, View::kPoint, "accel_x", "m/s2", 0},
    {Quantity::kAccelerometer, View::kPoint, "accel_y", "m/s2", 1},
    {Quantity::kPose, View::kFrames, "vision_x", "m", 0},
    {Quantity::kPose, View::kFrames, "vision_y", "m", 1},
    {Quantity::kPose, View::kFrames, "vision_theta", "rad", 2},
    {Quantity::kForce, View::kMean, "force_x", "N", 0},
    {Quantity::kForce, View::kMean, "force_y", "N", 1},
    {Quantity::kBusVoltage, View::kLevel, "bus_voltage", "V"},
};

// Not whitened (predictor.h): random forces of the floor integrate to more angle than the counts' rounding, and would be
// taken for a law of motion.
void add_encoder(const Channel& channel, Observation how, const std::string& name, RobotRun& r) {
  const RobotRecord& record = r.record;
  if (record.counts_per_rotor_turn[how.part] <= 0.0) return;
  std::vector<double> angle;
  for (const PerWheel<double>& counted : record.encoder_rotor_rad) angle.push_back(counted[how.part]);
  const double rad_per_count = kTurn / record.counts_per_rotor_turn[how.part];
  // of one reading: rounding, uniform over a count, and the channel's own noise
  const double sigma = std::hypot(1.0 / std::sqrt(12.0), channel.sigma) * rad_per_count;
  add_difference(r, std::move(how), name, "rad/s", record.time_s, angle, kAnyGap_s, sigma, rad_per_count,
                 0.0);
  r.seen.back().channel_sigma = channel.sigma;
}

// The first frame is the origin of the path, and is not compared.
void add_frames(const Channel& channel, Observation how, std::string_view unit, double loop_sigma_s,
                RobotRun& r) {
  std::vector<double> seen, at_rows(r.record.size(), kMissing);
  for (const CameraFrame& f : r.record.frames) {
    const double v = f.pose[how.part];
    if (!std::isfinite(v)) continue;
    if (!seen.empty()) at_rows[f.sample] = v;
    seen.push_back(v);
  }
  const std::string name = how.channel;
  ComparedSignal& c =
      add_signal(r, std::move(how), name, std::string(unit), r.record.time_s, std::move(at_rows));
  set_noise(channel.sigma, estimate_noise(seen), c);  // from frame to frame
  r.seen.back().channel_sigma = c.noise_sigma;
  if (const double sigma_s = std::max(channel.clock_sigma_s, loop_sigma_s); sigma_s > 0.0 && !seen.empty()) {
    r.clock.sigma_s = sigma_s;
    r.clock.follow_s = kFollowCamera_s;
    r.clock.signals.push_back(r.compared.size() - 1);
  }
}

// What the signals of a clock of its own read, with one shift of it drawn.
void shift_clock(const RobotRun& run, std::uint64_t seed, std::vector<std::vector<double>>& y) {
  const double shift_s = run.clock.sigma_s * gaussian(seed, stream_of("clock of the camera"), 0);
  for (const std::size_t s : run.clock.signals) {
    const std::vector<double> unmoved = y[s];
    for (std::size_t k = 0; k < unmoved.size(); ++k)
      y[s][k] += shift_s * rate_at(run.record.time_s, unmoved, k);
  }
}

}  // namespace

RobotRun robot_run(const Dataset& dataset, const Run& run, const RollingParams<double>& nominal) {
  RobotRun r;
  r.record = robot_record(dataset, run, nominal);
  // A loop that is described in place of the firmware says of neither what it hears nor what it tells at which instant of its
  // period: the difference of two that are uniform in it, T / sqrt(6), by which a camera's clock is off if no clock is stated.
  const bool stated =
      std::ranges::any_of(dataset.channels, [](const Channel& c) { return c.clock_sigma_s > 0.0; });
  const double loop_sigma_s = stated ? 0.0 : r.record.loop_period_s / std::sqrt(6.0);
  for (const Source& source : kSources) {
    const bool each = source.part == kEachWheel;
    for (std::size_t i = 0; i < (each ? r.record.wheels : 1u); ++i) {
      const std::string name = numbered(source.channel, i, each ? r.record.wheels : 1);
      const Channel* channel = dataset.channel(name);
      if (channel == nullptr || channel->imposed || run.signal(name) == nullptr) continue;
      const bool counted = source.view == View::kDifference || source.view == View::kFrames;
      if (run.steady && counted) continue;  // a displacement has no settled value
      // A settled point's mean is its value: nothing is the mean since another.
      const View view = run.steady && source.view == View::kMean ? View::kPoint : source.view;
      const Observation how{
          .quantity = source.quantity, .view = view, .channel = name, .part = each ? i : source.part};
      if (source.view == View::kDifference) {
        add_encoder(*channel, how, numbered("velocity", i, r.record.wheels), r);
      } else if (source.view == View::kFrames) {
        add_frames(*channel, how, source.unit, loop_sigma_s, r);
      } else {
        const bool bus = source.view == View::kLevel;
        add_signal(r, how, name, std::string(source.unit), r.record.time_s,
                   bus ? r.record.bus.measured_V : *run.signal(name), channel->sigma);
        if (bus) say_left_out(r.record.bus, r.compared.back());
      }
    }
  }
  return r;
}

void add_input_noise(const RobotMotion<double>& m, const RobotMotion<double>& perturbed, RobotRun& r) {
  const auto mean_square = [](const std::vector<double>& d) {
    double sum = 0.0, count = 0.0;
    for (const double v : d) {
      if (std::isfinite(v)) sum += v * v, count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
  };
  std::vector<std::vector<double>> differences = robot_outputs(r, perturbed);
  const std::vector<std::vector<double>> plain = robot_outputs(r, m);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    std::vector<double>& d = differences[s];
    for (std::size_t k = 0; k < d.size(); ++k) d[k] -= plain[s][k];
    complete(r, s, false, d);
    ComparedSignal& c = r.compared[s];
    c.noise_sigma = std::sqrt(c.noise_sigma * c.noise_sigma + mean_square(d));
    c.whitened_sigma = std::sqrt(c.whitened_sigma * c.whitened_sigma + mean_square(whitened(c, d)));
  }
}

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& r, const RobotMotion<double>& m) {
  constexpr double kMoving_m_s = 0.02;  // that has a direction: above the speeds' noise; a choice
  const std::vector<RollingSample<double>>& s = m.samples;
  std::vector<RegimeTrack> tracks;
  const auto add = [&](std::string name, std::string unit, auto value) {  // value(row)
    RegimeTrack& t = tracks.emplace_back(RegimeTrack{std::move(name), std::move(unit), {}});
    for (std::size_t k = 0; k < r.size(); ++k) t.value.push_back(value(k));
  };
  const auto speed = [&](std::size_t k) { return std::hypot(s[k].velocity[0], s[k].velocity[1]); };
  std::vector<std::vector<double>> asked(r.inputs());
  for (const PerWheel<double>& row : r.radio ? r.radio->value : r.duty_ratio) {
    for (std::size_t i = 0; i < asked.size(); ++i) asked[i].push_back(row[i]);
  }
  const std::vector<double> since = since_step(r.time_s, asked), heading = headings(r, 0.0);
  add("speed", "m/s", speed);
  add("direction", "rad", [&](std::size_t k) {
    return speed(k) > kMoving_m_s ? std::atan2(s[k].velocity[1], s[k].velocity[0]) : kMissing;
  });
  add("turn_rate", "rad/s", [&](std::size_t k) { return s[k].velocity[2]; });
  add("acceleration", "m/s2",
      [&](std::size_t k) { return std::hypot(s[k].accel_m_s2[0], s[k].accel_m_s2[1]); });
  add("abs_current", "A", [&](std::size_t k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < r.wheels; ++i)
      sum += (1.0 / static_cast<double>(r.wheels)) * std::abs(s[k].current_A[i]);
    return sum;
  });
  add("time", "s", [&](std::size_t k) { return r.time_s[k]; });
  add("time_since_step", "s", [&](std::size_t k) { return since[k]; });
  add("bus_voltage", "V",
      [&](std::size_t k) { return r.bus.input_V.empty() ? s[k].bus_voltage_V : r.bus.input_V[k]; });
  if (std::any_of(s.begin(), s.end(), [](const auto& at) { return at.temperature_rise_K > 0.0; }))
    add("temperature", "K", [&](std::size_t k) { return s[k].temperature_rise_K; });
  if (!heading.empty() && (!r.frames.empty() || run.signal("vision_theta") != nullptr))
    add("heading", "rad", [&](std::size_t k) { return std::remainder(heading[k], kTurn); });
  for (std::size_t i = 0; i < r.wheels; ++i) {
    add(numbered("wheel_speed", i, r.wheels), "rad/s", [&](std::size_t k) {
      if (k == 0) return kMissing;
      return (s[k].encoder_rad[i] - s[k - 1].encoder_rad[i]) / (r.time_s[k] - r.time_s[k - 1]);
    });
    if (r.counts_per_rotor_turn[i] <= 0.0) continue;
    add(numbered("rotor_angle", i, r.wheels), "rad", [&](std::size_t k) {
      const double turns = r.theta_rotor_rad[k][i] / kTurn;
      return kTurn * (turns - std::floor(turns));
    });
  }
  return tracks;
}

void measure_robot(const RobotRun& run, const RobotMotion<double>& m, std::uint64_t seed, Run& made) {
  const RobotRecord& r = run.record;
  std::vector<std::vector<double>> seen = robot_outputs(run, m);
  shift_clock(run, seed, seen);
  for (std::size_t n = 0; n < run.seen.size(); ++n) {
    const Observation& s = run.seen[n];
    std::vector<double>& out = made.signals.find(s.channel)->second;
    const std::uint64_t stream = stream_of(s.channel);
    for (const SilentStretch& silent : r.silent) {  // nor does the simulated sensor say anything there
      const bool both = silent.signal == "vision_x" && s.channel == "vision_y";
      if (silent.signal != s.channel && !both) continue;
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(silent.from),
                out.begin() + static_cast<std::ptrdiff_t>(silent.to) + 1, kMissing);
    }
    const double counts_per_rad = r.counts_per_rotor_turn[s.part] / kTurn;
    double origin = s.view == View::kFrames ? kMissing : 0.0;  // of the camera, from the simulation's
    for (std::size_t k = 0; k < r.size(); ++k) {
      if (!std::isfinite(out[k])) continue;
      const double normal = gaussian(seed, stream, k), value = seen[n][k];
      if (!std::isfinite(origin)) origin = out[k] - value;
      if (s.view == View::kLevel) {  // an input: the true one has no sensor's noise
        out[k] = r.bus.input_V[k] + s.channel_sigma * normal;
      } else if (s.view == View::kDifference) {
        out[k] = std::floor(quantity_of(m.samples[k], s) * counts_per_rad + s.channel_sigma * normal);
      } else {
        out[k] = reading(value + origin, s.channel_sigma, run.compared[n].quantum, normal);
      }
    }
  }
}

void measure_compared_bus(const RobotMotion<double>& m, std::uint64_t seed, RobotRun& r) {
  const std::uint64_t stream = stream_of("bus_voltage compared");
  for (std::size_t n = 0; n < r.seen.size(); ++n) {
    if (r.seen[n].view != View::kLevel) continue;
    std::vector<double> values = robot_outputs(r, m)[n];
    complete(r, n, true, values);
    for (std::size_t k = 0; k < values.size(); ++k) {
      double& out = r.compared[n].measured[k];
      if (std::isfinite(out)) out = values[k] + r.seen[n].channel_sigma * gaussian(seed, stream, k);
    }
  }
}

}  // namespace omnihil
