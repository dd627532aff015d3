#include "identify/design/body_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr int kTries = 20;  // by cost
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

struct Place {
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
  double away_m() const { return std::hypot(x_m, y_m); }
};

// Where an arc ends.
Place after(const Place& from, const std::array<double, 3>& v, double time_s) {
  const double half = 0.5 * v[2] * time_s;
  const double chord = std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
  const double c = std::cos(from.yaw_rad + half) * chord * time_s,
               s = std::sin(from.yaw_rad + half) * chord * time_s;
  return {from.x_m + c * v[0] - s * v[1], from.y_m + s * v[0] + c * v[1], from.yaw_rad + 2.0 * half};
}

// The farthest along the arc, in ten parts.
double farthest_along(Place from, const std::array<double, 3>& v, double time_s) {
  double most = from.away_m();
  for (int k = 0; k < 10; ++k) {
    from = after(from, v, 0.1 * time_s);
    most = std::max(most, from.away_m());
  }
  return most;
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_(seed) {}
  double uniform_in(double low, double high) { return low + (high - low) * uniform(seed_, kStream, n_++); }

 private:
  static constexpr std::uint64_t kStream = 0x626f6479;  // "body"
  std::uint64_t seed_, n_ = 0;
};

std::array<double, 3> rounded(std::array<double, 3> v) {
  for (double& one : v) one = std::round(one * 1e3) / 1e3;
  return v;
}

std::array<double, 3> towards_start(const Place& p, double speed_m_s) {
  const double away = std::max(p.away_m(), 1e-9), x = -p.x_m / away, y = -p.y_m / away;
  const double c = std::cos(p.yaw_rad), s = std::sin(p.yaw_rad);
  return {speed_m_s * (c * x + s * y), speed_m_s * (-s * x + c * y), 0.0};
}

}  // namespace

std::vector<BodyStep> random_body_drive(const BodyDriveOptions& o) {
  Draw draw(o.seed);
  std::vector<BodyStep> steps;
  Place at;
  double now_s = 0.0;
  while (now_s < o.duration_s - 1e-9) {
    const double hold_s =
        std::min(std::round(draw.uniform_in(0.3, 0.9) * 100.0) / 100.0, o.duration_s - now_s);
    std::array<double, 3> v{};
    bool fits = false;
    for (int n = 0; n < kTries && !fits; ++n) {
      const double what = draw.uniform_in(0.0, 1.0), direction = draw.uniform_in(0.0, kTurn_rad);
      const double speed = what < 0.1 ? 0.0 : o.speed_m_s * draw.uniform_in(0.2, 1.0);
      const bool turns = what > 0.67;
      v = rounded({speed * std::cos(direction), speed * std::sin(direction),
                   turns ? o.turn_rad_s * draw.uniform_in(-1.0, 1.0) : 0.0});
      fits = farthest_along(at, v, hold_s) <= o.room_m;
    }
    if (!fits) v = rounded(towards_start(at, std::min(o.speed_m_s, at.away_m() / hold_s)));
    steps.push_back({now_s, v});
    at = after(at, v, hold_s);
    now_s = std::round((now_s + hold_s) * 100.0) / 100.0;
  }
  return steps;
}

std::vector<BodyStep> scan_body_drive(const BodyDriveOptions& o) {
  std::vector<BodyStep> steps;
  const double out_s = std::min(0.6, o.room_m / std::max(o.speed_m_s, 1e-9));
  int n = 0;
  for (double now_s = 0.0; now_s < o.duration_s - 1e-9;) {
    const bool turns = n % 4 == 3;
    const double direction = kTurn_rad / 12.0 * 5.0 * n, sign = n % 2 == 0 ? 1.0 : -1.0;
    const std::array<double, 3> v = turns ? std::array<double, 3>{0, 0, o.turn_rad_s}
                                          : std::array<double, 3>{o.speed_m_s * std::cos(direction),
                                                                  o.speed_m_s * std::sin(direction), 0.0};
    for (const double way : {sign, 0.0, -sign, 0.0}) {
      if (now_s >= o.duration_s - 1e-9) break;
      steps.push_back({now_s, rounded({way * v[0], way * v[1], way * v[2]})});
      now_s = std::round((now_s + (way == 0.0 ? 0.25 : out_s)) * 1e3) / 1e3;
    }
    ++n;
  }
  return steps;
}

double farthest_m(const std::vector<BodyStep>& steps, double duration_s) {
  Place at;
  double most = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const double end_s = k + 1 < steps.size() ? steps[k + 1].at_s : duration_s;
    most = std::max(most, farthest_along(at, steps[k].value, end_s - steps[k].at_s));
    at = after(at, steps[k].value, end_s - steps[k].at_s);
  }
  return most;
}

}  // namespace omnihil
