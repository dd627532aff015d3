#include "identify/predict/robot_signals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "identify/predict/channel.h"
#include "identify/record/statistics.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Source {
  RobotOutput output;
  std::string_view channel;  // without the wheel's index
  std::string_view unit;
  bool per_wheel;
};
constexpr Source kSources[] = {
    {RobotOutput::kVelocity, "encoder", "rad/s", true},
    {RobotOutput::kWheelSpeed, "wheel_speed", "rad/s", true},
    {RobotOutput::kCurrent, "motor_current", "A", true},
    {RobotOutput::kGyro, "gyro_z", "rad/s", false},
    {RobotOutput::kAccelX, "accel_x", "m/s2", false},
    {RobotOutput::kAccelY, "accel_y", "m/s2", false},
    {RobotOutput::kVisionX, "vision_x", "m", false},
    {RobotOutput::kVisionY, "vision_y", "m", false},
    {RobotOutput::kVisionTheta, "vision_theta", "rad", false},
    {RobotOutput::kForceX, "force_x", "N", false},
    {RobotOutput::kForceY, "force_y", "N", false},
    {RobotOutput::kBusVoltage, "bus_voltage", "V", false},
};

double CameraFrame::*frame_member(RobotOutput output) {
  if (output == RobotOutput::kVisionX) return &CameraFrame::x_m;
  return output == RobotOutput::kVisionY ? &CameraFrame::y_m : &CameraFrame::theta_rad;
}

bool is_vision(RobotOutput o) {
  return o == RobotOutput::kVisionX || o == RobotOutput::kVisionY || o == RobotOutput::kVisionTheta;
}

void take_velocity(const Channel& channel, const RobotRecord& r, RobotSignal& s) {
  const std::size_t n = r.size();
  ComparedSignal& c = s.compared;
  c.measured.assign(n, kNaN);
  std::vector<double> periods;
  for (std::size_t k = 1; k < n; ++k) {
    const double dt_s = r.time_s[k] - r.time_s[k - 1];
    periods.push_back(dt_s);
    c.measured[k] = (r.encoder_rotor_rad[k][s.wheel] - r.encoder_rotor_rad[k - 1][s.wheel]) / dt_s;
  }
  if (periods.empty()) return;
  const double period_s = median(std::move(periods));
  const double rad_per_count = 2.0 * std::numbers::pi / r.counts_per_rotor_turn[s.wheel];
  c.quantum = rad_per_count / period_s;
  // variance of one reading in counts^2: rounding, uniform over a count, and the channel's own noise
  const double counts2 = 1.0 / 12.0 + channel.sigma * channel.sigma;
  s.channel_sigma = channel.sigma;
  c.noise_sigma = std::sqrt(2.0 * counts2) * c.quantum;
  c.noise_is_stated = true;
  // Not whitened (predictor.h): random forces of the floor integrate to more angle than the counts' rounding,
  // and would be taken for a law of motion.
  c.whitened_sigma = c.noise_sigma;
}

void take_frames(const Channel& channel, const RobotRecord& r, RobotSignal& s) {
  ComparedSignal& c = s.compared;
  c.measured.assign(r.size(), kNaN);
  std::vector<double> seen;
  bool first = true;
  for (const CameraFrame& f : r.frames) {
    const double v = f.*frame_member(s.output);
    if (!std::isfinite(v)) continue;
    seen.push_back(v);
    if (!first) c.measured[f.sample] = v;  // the first frame is the origin of the path
    first = false;
  }
  set_noise(channel.sigma, estimate_noise(seen, Differences::kThird), c);
}

void take(const Channel& channel, const Run& run, const RobotRecord& r, RobotSignal& s) {
  if (s.output == RobotOutput::kVelocity) return take_velocity(channel, r, s);
  if (is_vision(s.output)) {
    take_frames(channel, r, s);
  } else {
    s.compared.measured = *run.signal(s.channel);
    // the mean over a period whose beginning was not recorded
    const bool mean = s.output == RobotOutput::kCurrent || s.output == RobotOutput::kBusVoltage ||
                      s.output == RobotOutput::kForceX || s.output == RobotOutput::kForceY;
    if (mean && !s.compared.measured.empty()) s.compared.measured[0] = kNaN;
    set_noise(channel.sigma, estimate_noise(s.compared.measured, Differences::kThird), s.compared);
  }
  s.channel_sigma = s.compared.noise_sigma;
}

}  // namespace

std::vector<RobotSignal> robot_signals(const Dataset& dataset, const Run& run, const RobotRecord& r) {
  std::vector<RobotSignal> signals;
  for (const Source& source : kSources) {
    for (std::size_t i = 0; i < (source.per_wheel ? r.wheels : 1u); ++i) {
      const std::string suffix = source.per_wheel ? numbered("", i, r.wheels) : "";
      RobotSignal s;
      s.output = source.output;
      s.wheel = i;
      s.channel = std::string(source.channel) + suffix;
      const Channel* channel = dataset.channel(s.channel);
      if (channel == nullptr || channel->imposed || run.signal(s.channel) == nullptr) continue;
      if (s.output == RobotOutput::kVelocity && r.counts_per_rotor_turn[i] <= 0.0) continue;
      s.compared.name =
          (s.output == RobotOutput::kVelocity ? "velocity" : std::string(source.channel)) + suffix;
      s.compared.unit = source.unit;
      s.compared.time_s = r.time_s;
      take(*channel, run, r, s);
      signals.push_back(std::move(s));
    }
  }
  return signals;
}

namespace {

template <typename T>
std::vector<T> at_mean_of(const std::vector<double>& measured, std::vector<T> y) {
  T shift = T(0);
  double count = 0.0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!std::isfinite(measured[k])) continue;
    shift += measured[k] - y[k];
    count += 1.0;
  }
  for (T& v : y) v += shift / std::max(count, 1.0);
  return y;
}

}  // namespace

template <typename T>
std::vector<T> robot_signal_values(const RobotSignal& s, const RobotRecord& r, const RobotMotion<T>& m) {
  const std::size_t n = r.size();
  std::vector<T> out(n, T(kNaN));
  const auto per_wheel = [&](const auto& values) {
    for (std::size_t k = 0; k < n; ++k) out[k] = values[k][s.wheel];
  };
  switch (s.output) {
    case RobotOutput::kVelocity:
      for (std::size_t k = 1; k < n; ++k) {
        out[k] = (m.encoder_rad[k][s.wheel] - m.encoder_rad[k - 1][s.wheel]) *
                 (1.0 / (r.time_s[k] - r.time_s[k - 1]));
      }
      break;
    case RobotOutput::kWheelSpeed:
      per_wheel(m.wheel_rad_s);
      break;
    case RobotOutput::kCurrent:
      per_wheel(m.current_A);
      break;
    case RobotOutput::kGyro:
      return m.gyro_rad_s;
    case RobotOutput::kAccelX:
      return m.accel_x_m_s2;
    case RobotOutput::kAccelY:
      return m.accel_y_m_s2;
    case RobotOutput::kVisionX:
      return m.x_m;
    case RobotOutput::kVisionY:
      return m.y_m;
    case RobotOutput::kVisionTheta:
      return m.theta_rad;
    case RobotOutput::kForceX:
      return m.force_x_N;
    case RobotOutput::kForceY:
      return m.force_y_N;
    case RobotOutput::kBusVoltage:
      return at_mean_of(s.compared.measured, m.supply_voltage_V);
  }
  return out;
}

template std::vector<double> robot_signal_values(const RobotSignal&, const RobotRecord&,
                                                 const RobotMotion<double>&);
template std::vector<Jet> robot_signal_values(const RobotSignal&, const RobotRecord&,
                                              const RobotMotion<Jet>&);

void add_input_noise(const RobotRecord& r, const RobotMotion<double>& m, const RobotMotion<double>& perturbed,
                     std::vector<RobotSignal>& signals) {
  const auto mean_square = [](const std::vector<double>& d) {
    double sum = 0.0, count = 0.0;
    for (const double v : d) {
      if (std::isfinite(v)) sum += v * v, count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
  };
  for (RobotSignal& s : signals) {
    std::vector<double> d = robot_signal_values(s, r, perturbed);
    const std::vector<double> plain = robot_signal_values(s, r, m);
    for (std::size_t k = 0; k < d.size(); ++k) d[k] -= plain[k];
    ComparedSignal& c = s.compared;
    c.noise_sigma = std::sqrt(c.noise_sigma * c.noise_sigma + mean_square(d));
    c.whitened_sigma = std::sqrt(c.whitened_sigma * c.whitened_sigma + mean_square(whitened(c, d)));
  }
}

// ------------------------------------------------------------------------------------------- regimes

namespace {

// Least speed with a direction of travel: above the speeds' noise.
constexpr double kMoving_m_s = 0.02;  // a choice
std::vector<double> time_since_step(const RobotRecord& r) {
  const std::size_t axes = r.radio && r.radio->frame == CommandFrame::kBodyVelocity ? 3 : r.wheels;
  std::vector<std::vector<double>> inputs(axes);
  for (std::size_t i = 0; i < axes; ++i) {
    for (std::size_t k = 0; k < r.size(); ++k)
      inputs[i].push_back(r.radio ? r.radio->value[k][i] : r.duty_ratio[k][i]);
  }
  return since_step(r.time_s, inputs);
}

}  // namespace

std::vector<RegimeTrack> robot_regimes(const Run& run, const RobotRecord& r, const RobotMotion<double>& m) {
  const std::size_t n = r.size();
  const auto track = [&](std::string name, std::string unit, auto value) {
    RegimeTrack t{std::move(name), std::move(unit), std::vector<double>(n, kNaN)};
    for (std::size_t k = 0; k < n; ++k) t.value[k] = value(k);
    return t;
  };
  const auto speed = [&](std::size_t k) { return std::hypot(m.velocity[k][0], m.velocity[k][1]); };
  std::vector<RegimeTrack> tracks;
  tracks.push_back(track("speed", "m/s", speed));
  tracks.push_back(track("direction", "rad", [&](std::size_t k) {
    return speed(k) > kMoving_m_s ? std::atan2(m.velocity[k][1], m.velocity[k][0]) : kNaN;
  }));
  tracks.push_back(track("turn_rate", "rad/s", [&](std::size_t k) { return m.velocity[k][2]; }));
  tracks.push_back(track("acceleration", "m/s2",
                         [&](std::size_t k) { return std::hypot(m.accel_x_m_s2[k], m.accel_y_m_s2[k]); }));
  tracks.push_back(track("abs_current", "A", [&](std::size_t k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < r.wheels; ++i)
      sum += (1.0 / static_cast<double>(r.wheels)) * std::abs(m.current_A[k][i]);
    return sum;
  }));
  tracks.push_back(track("time", "s", [&](std::size_t k) { return r.time_s[k]; }));
  const std::vector<double> since = time_since_step(r);
  tracks.push_back(track("time_since_step", "s", [&](std::size_t k) { return since[k]; }));
  const std::vector<double>& bus = r.bus_voltage_V.empty() ? m.bus_voltage_V : r.bus_voltage_V;
  tracks.push_back(track("bus_voltage", "V", [&](std::size_t k) { return bus[k]; }));
  const bool warm = std::any_of(m.temperature_rise_K.begin(), m.temperature_rise_K.end(),
                                [](double rise) { return rise > 0.0; });
  if (warm)
    tracks.push_back(track("temperature", "K", [&](std::size_t k) { return m.temperature_rise_K[k]; }));
  if (!r.frames.empty() || run.signal("vision_theta") != nullptr) {
    const std::vector<double> heading = headings(r, 0.0);
    if (!heading.empty()) {
      tracks.push_back(track("heading", "rad", [&](std::size_t k) {
        return std::remainder(heading[k], 2.0 * std::numbers::pi);
      }));
    }
  }
  for (std::size_t i = 0; i < r.wheels; ++i) {
    const std::string wheel = numbered("", i, r.wheels);
    tracks.push_back(track("wheel_speed" + wheel, "rad/s", [&](std::size_t k) {
      return k > 0 ? (m.encoder_rad[k][i] - m.encoder_rad[k - 1][i]) / (r.time_s[k] - r.time_s[k - 1]) : kNaN;
    }));
    if (r.counts_per_rotor_turn[i] <= 0.0) continue;
    tracks.push_back(track("rotor_angle" + wheel, "rad", [&](std::size_t k) {
      const double turns = r.theta_rotor_rad[k][i] / (2.0 * std::numbers::pi);
      return 2.0 * std::numbers::pi * (turns - std::floor(turns));
    }));
  }
  return tracks;
}

void measure_robot(const RobotRecord& r, const RobotMotion<double>& m,
                   const std::vector<RobotSignal>& signals, std::uint64_t seed, Run& run) {
  for (const RobotSignal& s : signals) {
    std::vector<double>& out = run.signals.find(s.channel)->second;
    const std::uint64_t stream = stream_of(s.channel);
    const auto noise = [&](std::size_t k) { return s.channel_sigma * gaussian(seed, stream, k); };
    if (s.output == RobotOutput::kBusVoltage) {  // an input: the true one has no sensor's noise
      for (std::size_t k = 0; k < r.size(); ++k) {
        if (std::isfinite(out[k])) out[k] = r.bus_voltage_V[k] + noise(k);
      }
      continue;
    }
    if (s.output == RobotOutput::kVelocity) {
      const double counts_per_rad = r.counts_per_rotor_turn[s.wheel] / (2.0 * std::numbers::pi);
      for (std::size_t k = 0; k < r.size(); ++k) {
        if (!std::isfinite(out[k])) continue;
        out[k] = std::floor(m.encoder_rad[k][s.wheel] * counts_per_rad + noise(k));
      }
      continue;
    }
    for (const SilentStretch& silent : r.silent) {  // nor does the simulated sensor say anything there
      const bool both = silent.signal == "vision_x" && s.channel == "vision_y";
      if (silent.signal != s.channel && !both) continue;
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(silent.from),
                out.begin() + static_cast<std::ptrdiff_t>(silent.to) + 1, kNaN);
    }
    const std::vector<double> values = robot_signal_values(s, r, m);
    double first = kNaN;  // difference of the camera's origin to the simulation's
    for (std::size_t k = 0; k < r.size(); ++k) {
      if (!std::isfinite(out[k])) continue;
      if (!std::isfinite(first)) first = is_vision(s.output) ? out[k] - values[k] : 0.0;
      out[k] = reading(values[k] + first, s.channel_sigma, s.compared.quantum, gaussian(seed, stream, k));
    }
  }
}

void measure_robot_bus(const RobotRecord& r, const RobotMotion<double>& m, std::uint64_t seed,
                       RobotSignal& s) {
  const std::vector<double> values = robot_signal_values(s, r, m);
  const std::uint64_t stream = stream_of("bus_voltage compared");
  for (std::size_t k = 0; k < r.size(); ++k) {
    double& out = s.compared.measured[k];
    if (std::isfinite(out)) out = values[k] + s.channel_sigma * gaussian(seed, stream, k);
  }
}

}  // namespace omnihil
