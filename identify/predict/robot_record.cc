#include "identify/predict/robot_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "identify/predict/interpolation.h"
#include "identify/predict/settled_points.h"
#include "identify/predict/silent_frames.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
// For the parabola of the speeds at the start: tens of samples.
constexpr double kStartSpan_s = 0.02;  // a choice

// Half widths in samples, the shortest as of an axis (kBusWindow); a choice. More than noise is what exceeds its variance
// by three standard errors of a variance from 501 samples (sqrt(2 / n) = 6 %), within one of a variance from 21.
constexpr std::size_t kHalfWindows[] = {250, 50, 10};  // as above
constexpr NoiseWindows kBusWindows = {.half = kHalfWindows,
                                      .tolerated = 1.2};  // a choice; sensitivity not measured

void read_drive(const Run& run, RobotRecord& r) {
  const std::vector<double>* enable = run.signal("enable");
  const bool by_duty = run.signal(numbered("duty", 0, r.wheels)) != nullptr;
  if (!by_duty) r.radio = radio_commands(run, r.wheels);
  for (std::size_t i = 0; i < r.wheels; ++i) {
    const std::vector<double>* duty = run.signal(numbered("duty", i, r.wheels));
    for (std::size_t k = 0; k < r.size(); ++k) {
      const bool asked = by_duty && duty != nullptr && std::isfinite((*duty)[k]);
      r.duty_ratio[k][i] = asked ? (*duty)[k] : 0.0;
      r.enabled[k][i] = (asked || !by_duty) && (enable == nullptr || !((*enable)[k] == 0.0));
    }
  }
}

// Step that duties are rounded to by the decimals of their record; 0: full precision.
double rounding_of(const std::vector<PerWheel<double>>& duties, std::size_t wheels) {
  constexpr std::size_t kEnough = 20;  // different values; fewer may be round set points; a choice
  std::set<double> different;
  for (const auto& duty : duties)
    different.insert(duty.begin(), duty.begin() + static_cast<std::ptrdiff_t>(wheels));
  if (different.size() < kEnough) return 0.0;
  constexpr std::array<double, 4> kDecimals = {1e2, 1e3, 1e4, 1e5};  // fewer are set points; a choice
  for (const double scale : kDecimals) {
    const bool round = std::all_of(different.begin(), different.end(), [&](double v) {
      // a file's ninth decimal, and what the product rounds off; a choice
      return std::abs(v * scale - std::round(v * scale)) < 1e-6 * scale * 1e-3 + 1e-7;
    });
    if (round) return 1.0 / scale;
  }
  return 0.0;
}

void read_encoders(const Dataset& dataset, const Run& run, double gear_ratio, RobotRecord& r) {
  r.has_all_encoders = true;
  for (std::size_t i = 0; i < r.wheels; ++i) {
    const std::string name = numbered("encoder", i, r.wheels);
    const Channel* channel = dataset.channel(name);
    const std::vector<double>* counts = run.signal(name);
    const std::vector<double> full =
        counts != nullptr ? resampled(r.time_s, *counts, r.time_s) : std::vector<double>{};
    if (channel == nullptr || full.empty() || channel->counts_per_rev <= 0.0) {
      r.has_all_encoders = false;
      continue;
    }
    r.counts_per_rotor_turn[i] = channel->counts_per_rev * (channel->on_output ? 1.0 / gear_ratio : 1.0);
    const double rad_per_count = kTurn / r.counts_per_rotor_turn[i];
    for (std::size_t k = 0; k < r.size(); ++k) {
      r.encoder_rotor_rad[k][i] = rad_per_count * (*counts)[k];
      r.theta_rotor_rad[k][i] = rad_per_count * full[k];
    }
  }
}

void read_frames(const Run& run, RobotRecord& r) {
  const std::vector<double>* seen[] = {run.signal("vision_x"), run.signal("vision_y"),
                                       run.signal("vision_theta")};
  double last_rad = kMissing;
  for (std::size_t k = 0; k < r.size(); ++k) {
    CameraFrame f{.sample = k};
    for (std::size_t a = 0; a < 3; ++a) f.pose[a] = seen[a] != nullptr ? (*seen[a])[k] : kMissing;
    if (std::isfinite(f.pose[2] + last_rad))
      f.pose[2] = last_rad + std::remainder(f.pose[2] - last_rad, kTurn);
    if (std::isfinite(f.pose[2])) last_rad = f.pose[2];
    if (f.sees()) r.frames.push_back(f);
  }
}

void read_imposed(const Run& run, RobotRecord& r) {
  constexpr const char* kBody[] = {"body_vx", "body_vy", "body_w"};
  for (std::size_t a = 0; a < std::size(kBody); ++a) {
    const std::vector<double> speed = held(run.signal(kBody[a]));
    if (!speed.empty()) r.imposed_velocity.resize(r.size());
    for (std::size_t k = 0; k < speed.size(); ++k) r.imposed_velocity[k][a] = speed[k];
  }
}

// Unwraps the camera's heading: whole turns between two frames from the gyro's integral.
void unwrap_by_gyro(RobotRecord& r) {
  if (r.turned_rad.empty()) return;
  double offset = kMissing;
  for (CameraFrame& f : r.frames) {
    if (!std::isfinite(f.pose[2])) continue;
    const double turned = r.turned_rad[f.sample];
    if (std::isfinite(offset))
      f.pose[2] = turned + offset + std::remainder(f.pose[2] - turned - offset, kTurn);
    offset = f.pose[2] - turned;
  }
}

// Where there are no counts: the speeds that were first reported, unless they tell of no motion; rad/s at the wheels. One
// reading is no speed where the sensor is coarse: means over the first rows, over more of them where the noise needs it.
constexpr double kStanding_rad_s = 1.0;  // 3 cm/s of rim: a choice
constexpr double kSure_sigmas = 3.0;     // of a mean, beyond which it is a motion: p = 0.3 %, a choice
constexpr double kLongStart = 5.0;  // times kStartSpan_s at most: a robot gains little speed in it; a choice
std::optional<PerWheel<double>> reported_at_start(const Dataset& dataset, const Run& run,
                                                  std::size_t wheels) {
  PerWheel<double> omega{};
  bool moves = false;
  for (std::size_t i = 0; i < wheels; ++i) {
    const std::string name = numbered("wheel_speed", i, wheels);
    const std::vector<double>* reported = run.signal(name);
    if (reported == nullptr) return std::nullopt;
    const double sigma = noise_sigma_of(dataset, name, *reported);
    double sum = 0.0, count = 0.0;
    for (std::size_t k = 0; k < reported->size(); ++k) {
      const double since_s = run.time_s[k] - run.time_s[0];
      const bool sharp = count > 0.0 && kSure_sigmas * sigma <= kStanding_rad_s * std::sqrt(count);
      if (count > 0.0 && (sharp || since_s > kLongStart * kStartSpan_s)) break;
      if (std::isfinite((*reported)[k])) sum += (*reported)[k], count += 1.0;
    }
    if (count == 0.0) continue;
    omega[i] = sum / count;
    moves = moves || std::abs(omega[i]) > std::max(kStanding_rad_s, kSure_sigmas * sigma / std::sqrt(count));
  }
  return moves ? std::optional(omega) : std::nullopt;
}

BodyVelocity<double> start_velocity(const RobotRecord& r, const Dataset& dataset, const Run& run,
                                    const RollingParams<double>& nominal) {
  if (!r.imposed_velocity.empty()) {
    const auto& v = r.imposed_velocity.front();
    return {v[0], v[1], v[2]};
  }
  std::size_t last = 0;
  while (last + 1 < r.size() && r.time_s[last] - r.time_s[0] < kStartSpan_s) ++last;
  const WheelGeometry<double> g = wheel_geometry(nominal);
  if (!r.has_all_encoders || last < 3) {
    const auto reported = reported_at_start(dataset, run, r.wheels);
    return reported ? body_velocity(g, *reported) : BodyVelocity<double>{};
  }
  PerWheel<double> omega_wheel{};
  for (std::size_t i = 0; i < r.wheels; ++i) {
    std::vector<double> theta;
    for (std::size_t k = 0; k <= last; ++k) theta.push_back(r.theta_rotor_rad[k][i]);
    omega_wheel[i] = first_slope(r.time_s, theta, 0, theta.size()) / nominal.drive.gear_ratio;
  }
  return body_velocity(g, omega_wheel);
}

// The body's at each row, by the wheels where they are measured; at rest where they are not.
void read_settled(const Run& run, const WheelGeometry<double>& g, RobotRecord& r) {
  r.settled.resize(r.size());
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (!r.imposed_velocity.empty()) {
      const auto& v = r.imposed_velocity[k];
      r.settled[k] = {v[0], v[1], v[2]};
      continue;
    }
    PerWheel<double> omega{};
    bool known = true;
    for (std::size_t i = 0; i < r.wheels && known; ++i) {
      const std::vector<double>* speed = run.signal(numbered("wheel_speed", i, r.wheels));
      known = speed != nullptr && std::isfinite((*speed)[k]);
      if (known) omega[i] = (*speed)[k];
    }
    if (known) r.settled[k] = body_velocity(g, omega);
  }
}

}  // namespace

RadioCommands radio_commands(const Run& run, std::size_t wheels) {
  constexpr const char* kBody[] = {"command_vx", "command_vy", "command_w"};
  const bool body = run.signal(kBody[0]) != nullptr;
  RadioCommands out{.frame = body ? CommandFrame::kBodyVelocity : CommandFrame::kWheelSpeeds,
                    .count = body ? std::size(kBody) : wheels,
                    .value = {}};
  out.value.resize(run.time_s.size());
  for (std::size_t a = 0; a < out.count; ++a) {
    const std::vector<double>* said = run.signal(body ? kBody[a] : numbered("command_wheel", a, wheels));
    for (std::size_t k = 0; k < out.value.size() && said != nullptr; ++k) out.value[k][a] = (*said)[k];
  }
  return out;
}

std::string numbered(std::string_view name, std::size_t wheel, std::size_t wheels) {
  return wheels == 1 ? std::string(name) : std::string(name) + "_" + std::to_string(wheel + 1);
}

RobotRecord robot_record(const Dataset& dataset, const Run& run, const RollingParams<double>& nominal) {
  RobotRecord r;
  r.wheels = nominal.wheels;
  r.time_s = run.time_s;
  r.duty_ratio.resize(r.size());
  r.enabled.resize(r.size());
  r.encoder_rotor_rad.resize(r.size());
  r.theta_rotor_rad.resize(r.size());
  read_drive(run, r);
  if (r.radio && dataset.firmware == nullptr) r.loop_period_s = nominal.controller.period_s;
  r.duty_quantum = rounding_of(r.duty_ratio, r.wheels);
  read_encoders(dataset, run, nominal.drive.gear_ratio, r);
  r.dribbler_rad_s = held(run.signal("dribbler"));
  r.dribbler_rad_s.resize(r.size());
  r.bus = read_bus(dataset, run, 0, kBusWindows);
  r.turned_rad = integrated(r.time_s, held(run.signal("gyro_z")), std::numeric_limits<double>::infinity());
  read_frames(run, r);
  drop_silent_frames(run, nominal, r);
  unwrap_by_gyro(r);
  read_imposed(run, r);
  r.start_velocity = start_velocity(r, dataset, run, nominal);
  if (run.steady) read_settled(run, wheel_geometry(nominal), r);
  return r;
}

RobotRecord rows_of(const RobotRecord& all, std::size_t from, std::size_t to) {
  RobotRecord out;
  const auto cut = [&]<typename V>(const std::vector<V>& v) {
    if (v.size() != all.size()) return v;
    return std::vector<V>(v.begin() + static_cast<std::ptrdiff_t>(from),
                          v.begin() + static_cast<std::ptrdiff_t>(to + 1));
  };
  const auto cut_each = [&](auto... list) { ((out.*list = cut(all.*list)), ...); };
  cut_each(&RobotRecord::time_s, &RobotRecord::duty_ratio, &RobotRecord::enabled,
           &RobotRecord::dribbler_rad_s, &RobotRecord::encoder_rotor_rad, &RobotRecord::theta_rotor_rad,
           &RobotRecord::turned_rad, &RobotRecord::imposed_velocity);
  out.wheels = all.wheels;
  out.bus = all.bus;
  out.bus.input_V = cut(all.bus.input_V);
  out.bus.measured_V = cut(all.bus.measured_V);
  out.counts_per_rotor_turn = all.counts_per_rotor_turn;
  out.has_all_encoders = all.has_all_encoders;
  out.start_velocity = all.start_velocity;
  out.radio = all.radio;
  out.radio->value = cut(all.radio->value);
  return out;
}

RobotRecord settled_point(const RobotRecord& r, std::size_t k) {
  constexpr double kMean_s = 0.02;  // of means: some steps of the simulation; a choice
  RobotRecord p;
  p.wheels = r.wheels;
  p.time_s = {0.0, kSettled_s, kSettled_s + kMean_s};
  p.duty_ratio.assign(p.size(), r.duty_ratio[k]);
  p.enabled.assign(p.size(), r.enabled[k]);
  if (!r.bus.input_V.empty()) p.bus.input_V.assign(p.size(), r.bus.input_V[k]);
  p.dribbler_rad_s.assign(p.size(), r.dribbler_rad_s[k]);
  p.encoder_rotor_rad.resize(p.size());
  p.theta_rotor_rad.assign(p.size(), r.theta_rotor_rad[k]);
  if (!r.imposed_velocity.empty()) p.imposed_velocity.assign(p.size(), r.imposed_velocity[k]);
  p.start_velocity = r.settled[k];
  return p;
}

RobotRecord with_input_noise(const RobotRecord& record, std::uint64_t seed) {
  RobotRecord r = record;
  const std::uint64_t bus_stream = stream_of("bus_voltage"), duty_stream = stream_of("duty");
  for (std::size_t k = 0; k < r.size(); ++k) {
    for (std::size_t i = 0; i < r.wheels; ++i) {
      r.duty_ratio[k][i] += r.duty_quantum * (uniform(seed, duty_stream + i, k) - 0.5);
    }
    if (!r.bus.input_V.empty()) r.bus.input_V[k] += r.bus.sigma_V * gaussian(seed, bus_stream, k);
  }
  if (!r.bus.input_V.empty()) r.bus.input_V = without_noise(r.bus.input_V, r.bus.sigma_V, kBusWindows);
  return r;
}

}  // namespace omnihil
