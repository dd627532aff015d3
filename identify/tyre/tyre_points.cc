#include "identify/tyre/tyre_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "identify/predict/camera_path.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"
#include "identify/tyre/motion_smoother.h"
#include "sim/model/rolling_model.h"
#include "sim/robot/wheel_load.h"
#include "sim/rolling/rolling_robot.h"

namespace omnihil {
namespace {

// Choices where nothing else is said; sensitivity not measured.
constexpr double kEvery_s = 0.01;  // a point; as above
constexpr double kEnds_s = 0.1;    // of a run, where the smoother has one side only; as above
constexpr double kJump = 0.02;     // of a duty, from sample to sample; as above
constexpr double kJumpMemory_s =
    0.03;  // of the smoothers, at q of a motor's jerk and these sensors: 20 to 30 ms; derived
constexpr double kLeastSpeed_m_s =
    0.15;  // below it slip is the slip speed over the floor: not used for R; as above
constexpr double kLightShare = 0.25;  // of the largest force: there slip is proportional to it; as above
constexpr double kWorstRadius = 0.01,
                 kFarthestRadius = 0.1;  // of the stated one: else wheels slid, not rolled; as above
constexpr double kHangTogether = 10.0;   // points of 0.1 s, the smoother's memory, count as one: derived
// Sensors where nothing is stated: as good as those of the virtual benches (tools/benches), or less. Guesses.
constexpr double kCamera_m = 1e-3, kCamera_rad = 5e-3, kAccelerometer_m_s2 = 0.2,
                 kCurrent_A = 0.05;  // as above

double sigma_of(const Dataset& dataset, const char* channel, double otherwise) {
  const Channel* found = dataset.channel(channel);
  return found != nullptr && found->sigma > 0.0 ? found->sigma : otherwise;
}

struct Body {
  std::vector<double> v_forward_m_s, v_left_m_s, omega_rad_s, speed_sigma_m_s;
};

Body body_of(const Dataset& dataset, const Run& run, const RobotRecord& record) {
  const std::size_t n = record.size();
  const std::vector<double> heading = headings<double>(record, 0.0);
  const auto *ax = run.signal("accel_x"), *ay = run.signal("accel_y"), *gyro = run.signal("gyro_z");
  const double accel_sigma = sigma_of(dataset, "accel_x", kAccelerometer_m_s2);
  std::vector<MotionSample> x(n), y(n), turn(n);
  for (std::size_t k = 0; k < n; ++k) {
    x[k].time_s = y[k].time_s = turn[k].time_s = record.time_s[k];
    x[k].acceleration_sigma = y[k].acceleration_sigma = accel_sigma;
    x[k].place_sigma = sigma_of(dataset, "vision_x", kCamera_m);
    y[k].place_sigma = sigma_of(dataset, "vision_y", kCamera_m);
    turn[k].place_sigma = sigma_of(dataset, "vision_theta", kCamera_rad);
    if (ax == nullptr || ay == nullptr || !std::isfinite((*ax)[k] + (*ay)[k])) continue;
    const double c = std::cos(heading[k]), s = std::sin(heading[k]);
    x[k].acceleration = c * (*ax)[k] - s * (*ay)[k];
    y[k].acceleration = s * (*ax)[k] + c * (*ay)[k];
  }
  for (const CameraFrame& f : record.frames) {
    if (std::isfinite(f.pose[0])) x[f.sample].place = f.pose[0];
    if (std::isfinite(f.pose[1])) y[f.sample].place = f.pose[1];
    if (std::isfinite(f.pose[2])) turn[f.sample].place = f.pose[2];
  }
  const SmoothedMotion sx = smooth_motion(x), sy = smooth_motion(y);
  SmoothedMotion st;
  if (gyro == nullptr) st = smooth_motion(turn);
  Body body;
  for (std::size_t k = 0; k < n; ++k) {
    const double c = std::cos(heading[k]), s = std::sin(heading[k]);
    body.v_forward_m_s.push_back(c * sx.at[k].speed + s * sy.at[k].speed);
    body.v_left_m_s.push_back(-s * sx.at[k].speed + c * sy.at[k].speed);
    body.omega_rad_s.push_back(gyro != nullptr && std::isfinite((*gyro)[k]) ? (*gyro)[k]
                               : st.at.empty()                              ? 0.0
                                                                            : st.at[k].speed);
    body.speed_sigma_m_s.push_back(std::max(sx.at[k].speed_sigma, sy.at[k].speed_sigma));
  }
  return body;
}

double coulomb_Nm(const Candidate& nominal) {
  for (const EffectUse& use : nominal.effects)
    if (effect_name(use) == "coulomb_friction" && !use.values.empty()) return use.values[0];
  return 0.0;
}

// Samples about a jump of a duty: torque jumps there, and the smoothed acceleration takes its memory to follow.
std::vector<char> near_jumps(const RobotRecord& record) {
  const std::size_t n = record.size();
  std::vector<char> near(n, 0);
  for (std::size_t k = 1; k < n; ++k) {
    double most = 0.0;
    for (std::size_t i = 0; i < record.wheels; ++i)
      most = std::max(most, std::abs(record.duty_ratio[k][i] - record.duty_ratio[k - 1][i]));
    if (most < kJump) continue;
    for (std::size_t j = k; j-- > 0 && record.time_s[k] - record.time_s[j] < kJumpMemory_s;) near[j] = 1;
    for (std::size_t j = k; j < n && record.time_s[j] - record.time_s[k] < kJumpMemory_s; ++j) near[j] = 1;
  }
  return near;
}

// One wheel at one instant, before R is known better.
struct Raw {
  std::size_t wheel;
  double time_s, hub_m_s, hub_sigma_m_s, omega_rad_s, omega_sigma_rad_s, force_N, force_sigma_N, load_N;
};

class Reader {
 public:
  Reader(const Dataset& dataset, const Candidate& nominal)
      : dataset_(dataset), p_(rolling_params(nominal.file.parameters)), coulomb_Nm_(coulomb_Nm(nominal)) {
    g_ = wheel_geometry(p_);
    load_ = wheel_load_law(g_, p_.mass_kg, p_.center_of_mass_x_m, p_.center_of_mass_y_m,
                           p_.center_of_mass_height_m);
  }

  void read(const Run& run, std::vector<Raw>& out) {
    const RobotRecord record = robot_record(dataset_, run, p_);
    const std::size_t n = record.size();
    const Body body = body_of(dataset_, run, record);
    PerWheel<SmoothedMotion> wheel;
    PerWheel<const std::vector<double>*> current{};
    for (std::size_t i = 0; i < p_.wheels; ++i) {
      std::vector<MotionSample> samples(n);
      const double quantum_rad =
          2.0 * std::numbers::pi / record.counts_per_rotor_turn[i] / p_.drive.gear_ratio;
      for (std::size_t k = 0; k < n; ++k) {
        samples[k].time_s = record.time_s[k];
        samples[k].place = record.encoder_rotor_rad[k][i] / p_.drive.gear_ratio;
        samples[k].place_sigma = quantum_rad / std::sqrt(12.0);  // of rounding to whole counts
      }
      wheel[i] = smooth_motion(samples);
      current[i] = run.signal("motor_current_" + std::to_string(i + 1));
      measured_current = measured_current || current[i] != nullptr;
    }
    const double inertia = p_.drive.load_inertia_kg_m2 +
                           p_.drive.gear_ratio * p_.drive.gear_ratio * p_.drive.rotor_inertia_kg_m2;
    const std::vector<char> jumps = near_jumps(record);
    double next_s = record.time_s.front() + kEnds_s;
    for (std::size_t k = 0; k < n && record.time_s[k] < record.time_s.back() - kEnds_s; ++k) {
      if (record.time_s[k] < next_s || jumps[k]) continue;
      next_s += kEvery_s;
      const BodyVelocity<double> v{body.v_forward_m_s[k], body.v_left_m_s[k], body.omega_rad_s[k]};
      PerWheel<Raw> raw;
      double sum_x_N = 0.0, sum_y_N = 0.0;
      for (std::size_t i = 0; i < p_.wheels; ++i) {
        const MotionState& w = wheel[i].at[k];
        const double rotor_rad_s = p_.drive.gear_ratio * w.speed;
        double current_A = 0.0, current_sigma_A = 0.0;
        if (current[i] != nullptr && std::isfinite((*current[i])[k])) {
          // the mean of a few samples about the instant
          double sum = 0.0;
          int count = 0;
          for (std::size_t j = k >= 3 ? k - 3 : 0; j < std::min(n, k + 4); ++j)
            if (std::isfinite((*current[i])[j])) sum += (*current[i])[j], ++count;
          current_A = sum / count;
          current_sigma_A = sigma_of(dataset_, "motor_current_1", kCurrent_A) / std::sqrt(count);
        } else {
          const double bus_V = record.bus.input_V.empty() ? p_.drive.supply_voltage_V : record.bus.input_V[k];
          const double volt = record.duty_ratio[k][i] * bus_V;
          current_A = record.enabled[k][i]
                          ? (volt - p_.drive.torque_constant_Nm_per_A * rotor_rad_s) / p_.drive.resistance_ohm
                          : 0.0;
          current_sigma_A = p_.drive.torque_constant_Nm_per_A * p_.drive.gear_ratio * w.speed_sigma /
                            p_.drive.resistance_ohm;
        }
        const double friction_Nm = p_.drive.viscous_friction_Nm_s_per_rad * rotor_rad_s +
                                   coulomb_Nm_ * std::tanh(rotor_rad_s / kStribeckFree_rad_s);
        const double torque_Nm =
            p_.drive.gear_ratio * (p_.drive.torque_constant_Nm_per_A * current_A - friction_Nm);
        Raw& r = raw[i];
        r.wheel = i;
        r.time_s = record.time_s[k];
        r.hub_m_s = rim_speed_m_s(g_, i, v);
        r.hub_sigma_m_s = body.speed_sigma_m_s[k];
        r.omega_rad_s = w.speed;
        r.omega_sigma_rad_s = w.speed_sigma;
        r.force_N = (torque_Nm - inertia * w.acceleration) / p_.wheel_radius_m;
        r.force_sigma_N =
            std::hypot(p_.drive.gear_ratio * p_.drive.torque_constant_Nm_per_A * current_sigma_A,
                       inertia * w.acceleration_sigma) /
            p_.wheel_radius_m;
        sum_x_N += -g_.sin_angle[i] * r.force_N;
        sum_y_N += g_.cos_angle[i] * r.force_N;
      }
      for (std::size_t i = 0; i < p_.wheels; ++i) {
        raw[i].load_N = load_.at_rest_N[i] + load_.transfer(i, sum_x_N, sum_y_N);
        if (raw[i].load_N > 0.2 * load_.at_rest_N[i] && std::isfinite(raw[i].force_N)) out.push_back(raw[i]);
      }
    }
  }

  const RollingParams<double>& params() const { return p_; }
  bool measured_current = false;

 private:
  static constexpr double kStribeckFree_rad_s =
      5.0;  // of the rotor: where its friction has its sign; a choice
  const Dataset& dataset_;
  RollingParams<double> p_;
  double coulomb_Nm_;
  WheelGeometry<double> g_;
  WheelLoadLaw<double> load_;
};

// But for the largest hundredth: instants at which a wheel's acceleration jumps.
double largest_force_N(const std::vector<Raw>& raw) {
  std::vector<double> sizes;
  sizes.reserve(raw.size());
  for (const Raw& r : raw) sizes.push_back(std::abs(r.force_N));
  return quantile(std::move(sizes), 0.99, QuantileRank::kLower);
}

struct RollingRadius {
  double radius_m, sigma_m;
};

// v = R w - B w F / F_most: what is left at no force, by least squares with Huber's weights, over wheels that carry
// little. Without the second term a soft tyre's slip would be taken for a smaller wheel.
RollingRadius rolling_radius(const std::vector<Raw>& raw, double most_N, double stated_m) {
  std::vector<const Raw*> light;
  for (const Raw& r : raw)
    if (std::abs(r.force_N) < kLightShare * most_N && std::abs(r.hub_m_s) > kLeastSpeed_m_s &&
        std::abs(r.omega_rad_s) * stated_m > kLeastSpeed_m_s)
      light.push_back(&r);
  constexpr std::size_t kEnough = 30;  // a mean to a fifth of the scatter (1 / sqrt(n)); a choice
  if (light.size() < kEnough)
    return {stated_m, 0.01 * stated_m};  // guess: nothing rolls freely in these data
  std::vector<double> weight(light.size(), 1.0);
  double radius_m = stated_m, sigma_m = 0.0;
  for (int round = 0; round < 20; ++round) {
    double a = 0, b = 0, c = 0, d = 0, e = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      const Raw& r = *light[i];
      const double u = r.omega_rad_s, w = -r.omega_rad_s * r.force_N / most_N, g = weight[i];
      a += g * u * u, b += g * u * w, c += g * w * w, d += g * u * r.hub_m_s, e += g * w * r.hub_m_s;
    }
    const double determinant = a * c - b * b;
    if (!(determinant > 0.0)) return {stated_m, 0.01 * stated_m};
    radius_m = (c * d - b * e) / determinant;
    const double soft_m = (a * e - b * d) / determinant;
    std::vector<double> off(light.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
      const Raw& r = *light[i];
      off[i] = std::abs(r.hub_m_s - radius_m * r.omega_rad_s + soft_m * r.omega_rad_s * r.force_N / most_N);
    }
    const double scale = sigma_by_mad(off) + 1e-9;
    for (std::size_t i = 0; i < off.size(); ++i) weight[i] = std::min(1.0, 1.345 * scale / (off[i] + 1e-12));
    sigma_m = scale * std::sqrt(c / determinant) * std::sqrt(kHangTogether);
  }
  if (!(sigma_m < kWorstRadius * stated_m) || std::abs(radius_m - stated_m) > kFarthestRadius * stated_m)
    return {stated_m, 0.01 * stated_m};
  return {radius_m, sigma_m};
}

}  // namespace

TyrePoints tyre_points(const Dataset& dataset, const Candidate& nominal, std::vector<std::string>& faults) {
  TyrePoints points;
  if (!dataset.rig->whole_robot) {
    faults.push_back(
        "a tyre is a robot's: needed is a dataset of rig \"robot\" (omnihil sim ROBOT --rig robot)");
    return points;
  }
  Reader reader(dataset, nominal);
  std::vector<Raw> raw;
  bool camera = false;
  for (const Run& run : dataset.runs) {
    if (run.split != Split::kTraining) continue;
    camera = run.signal("vision_x") != nullptr && run.signal("vision_y") != nullptr;
    bool encoders = true;
    for (std::size_t i = 1; i <= reader.params().wheels; ++i)
      encoders = encoders && run.signal("encoder_" + std::to_string(i)) != nullptr;
    if (!camera) {
      faults.push_back(run.file +
                       ": no channels vision_x and vision_y: without a speed of the body a wheel's slip "
                       "cannot be told from its rolling; record the camera beside");
    }
    if (!encoders)
      faults.push_back(run.file + ": needs encoder_1 to encoder_" + std::to_string(reader.params().wheels));
    if (faults.empty()) reader.read(run, raw);
  }
  if (!faults.empty()) return points;
  const double most_N = largest_force_N(raw);
  const RollingRadius rolling = rolling_radius(raw, most_N, reader.params().wheel_radius_m);
  points.radius_m = rolling.radius_m;
  points.radius_sigma_m = rolling.sigma_m;
  points.measured_current = reader.measured_current;
  const double floor_m_s = reader.params().slip_speed_floor_m_s;
  const double rescale = reader.params().wheel_radius_m / points.radius_m;
  for (const Raw& r : raw) {
    const double rim = points.radius_m * r.omega_rad_s;
    const double fast = std::max({std::abs(rim), std::abs(r.hub_m_s), floor_m_s});
    TyrePoint& p = points.all.emplace_back();
    p.wheel = static_cast<int>(r.wheel);
    p.time_s = r.time_s;
    p.slip = (rim - r.hub_m_s) / fast;
    p.slip_sigma = std::hypot(points.radius_m * r.omega_sigma_rad_s, r.hub_sigma_m_s,
                              points.radius_sigma_m * r.omega_rad_s) /
                   fast;
    p.ratio = rescale * r.force_N / r.load_N;
    p.ratio_sigma = rescale * r.force_sigma_N / r.load_N;
    p.speed_m_s = fast;
  }
  return points;
}

}  // namespace omnihil
