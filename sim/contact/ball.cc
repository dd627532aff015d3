#include "sim/contact/ball.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr int kMostPhases = 8;       // of one step: bounces, the end of sliding, the end of rolling
constexpr double kSlips_m_s = 1e-9;  // below it the lowest point stands
constexpr double kMoves_m_s = 1e-9;

void slide(const BallParams& p, const Carpet& carpet, double friction, const Vector3& slip, BallState& b,
           double& left_s) {
  (void)carpet;
  const double k = p.inertia_over_m_r2, slip_m_s = slip.norm();
  const double a_m_s2 = friction * kGravity_m_s2;
  const double until_rolling_s = slip_m_s / (a_m_s2 * (1.0 + 1.0 / k));
  const double part_s = std::min(left_s, until_rolling_s);
  const Vector3 along = slip / slip_m_s;
  b.position += b.velocity * part_s - 0.5 * a_m_s2 * part_s * part_s * along;
  b.velocity -= a_m_s2 * part_s * along;
  // I dw/dt = (-r z) x F,  F = -m a u/|u|
  b.spin += Vector3(0, 0, p.radius_m).cross(along) * (a_m_s2 * part_s / (k * p.radius_m * p.radius_m));
  if (part_s == until_rolling_s) {
    b.spin.x() = -b.velocity.y() / p.radius_m;
    b.spin.y() = b.velocity.x() / p.radius_m;
  }
  left_s -= part_s;
}

void roll(const BallParams& p, const Carpet& carpet, double resistance, BallState& b, double& left_s) {
  const double speed_m_s = b.velocity.norm();
  if (speed_m_s < kMoves_m_s || !(resistance > 0.0)) {
    if (speed_m_s < kMoves_m_s) {
      b.velocity.setZero();
      b.spin.x() = b.spin.y() = 0.0;
    }
    b.position += b.velocity * left_s;
    left_s = 0.0;
    return;
  }
  const Vector3 along = b.velocity / speed_m_s;
  const Vector3 nap = carpet.nap_ratio * Vector3(std::cos(carpet.nap_rad), std::sin(carpet.nap_rad), 0.0);
  const Vector3 a_m_s2 = -resistance * kGravity_m_s2 * (along - nap);
  const double slows_m_s2 = -a_m_s2.dot(along);
  const double part_s = std::min(left_s, speed_m_s / slows_m_s2);
  b.position += b.velocity * part_s + 0.5 * part_s * part_s * a_m_s2;
  b.velocity += a_m_s2 * part_s;
  if (part_s < left_s) b.velocity.setZero();
  b.spin.x() = -b.velocity.y() / p.radius_m;
  b.spin.y() = b.velocity.x() / p.radius_m;
  left_s -= part_s;
}

void spin_down(const BallParams& p, const Carpet& carpet, BallState& b, double step_s) {
  const double most = carpet.spinning_friction * kGravity_m_s2 / (p.inertia_over_m_r2 * p.radius_m) * step_s;
  b.spin.z() -= std::clamp(b.spin.z(), -most, most);
}

void land(const BallParams& p, const Carpet& carpet, BallState& b) {
  const double down_m_s = -b.velocity.z();
  const double up_m_s = carpet.restitution * down_m_s;
  const Vector3 slip = floor_slip(p, b);
  const double slip_m_s = slip.norm();
  const bool bounces = up_m_s * up_m_s > 2.0 * kGravity_m_s2 * kLeastBounce_m;
  if (slip_m_s > kSlips_m_s) {
    const double k = p.inertia_over_m_r2;
    const double normal_m_s = down_m_s + (bounces ? up_m_s : 0.0);  // impulse over mass
    const double friction = carpet.at(b.position.x(), b.position.y()).sliding_friction;
    const double t_m_s = std::min(friction * normal_m_s, slip_m_s / (1.0 + 1.0 / k));
    const Vector3 along = slip / slip_m_s;
    b.velocity -= t_m_s * along;
    b.spin += Vector3(0, 0, p.radius_m).cross(along) * (t_m_s / (k * p.radius_m * p.radius_m));
  }
  b.velocity.z() = bounces ? up_m_s : 0.0;
  b.position.z() = p.radius_m;
  b.on_floor = !bounces;
}

// Until the step ends or it lands; true: it landed.
bool fly(const BallParams& p, BallState& b, double& left_s) {
  const double height_m = b.position.z() - p.radius_m, v_m_s = b.velocity.z();
  // h + v t - g t^2 / 2 = 0
  const double lands_s =
      (v_m_s + std::sqrt(std::max(0.0, v_m_s * v_m_s + 2.0 * kGravity_m_s2 * height_m))) / kGravity_m_s2;
  const double part_s = std::clamp(lands_s, 0.0, left_s);
  b.position += b.velocity * part_s;
  b.position.z() -= 0.5 * kGravity_m_s2 * part_s * part_s;
  b.velocity.z() -= kGravity_m_s2 * part_s;
  left_s -= part_s;
  return lands_s <= part_s;
}

// dv/dt = -c |v| v is 1 / (1 + c |v| t) exactly; lift turns the velocity and keeps its size.
void air(const BallParams& p, BallState& b, double step_s) {
  const double speed_m_s = b.velocity.norm();
  if (speed_m_s < kMoves_m_s) return;
  const double area_m2 = M_PI * p.radius_m * p.radius_m;
  const bool rolls = b.on_floor && floor_slip(p, b).norm() < kSlips_m_s;
  const double c = 0.5 * p.air_density_kg_m3 * p.drag_coefficient * area_m2 / p.mass_kg;
  // A rolling ball's spin is slowed with it: its inertia counts.
  const double share = rolls ? 1.0 / (1.0 + p.inertia_over_m_r2) : 1.0;
  const double ratio = 1.0 / (1.0 + share * c * speed_m_s * step_s);
  b.velocity *= ratio;
  if (rolls) {
    b.spin.x() *= ratio;
    b.spin.y() *= ratio;
  }
  if (p.lift_coefficient == 0.0 || b.on_floor) return;
  const Vector3 a_m_s2 =
      p.lift_coefficient * p.air_density_kg_m3 * area_m2 * p.radius_m / p.mass_kg * b.spin.cross(b.velocity);
  const double now_m_s = b.velocity.norm();
  b.velocity += a_m_s2 * step_s;
  b.velocity *= now_m_s / b.velocity.norm();
}

}  // namespace

Carpet::Here Carpet::at(double x_m, double y_m) const {
  Here here{sliding_friction, rolling_resistance};
  for (const CarpetPatch& patch : patches) {
    if (x_m < patch.x_from_m || x_m > patch.x_to_m || y_m < patch.y_from_m || y_m > patch.y_to_m) continue;
    here.sliding_friction *= patch.sliding_ratio;
    here.rolling_resistance *= patch.rolling_ratio;
  }
  return here;
}

BallState resting_ball(const BallParams& params, double x_m, double y_m) {
  BallState ball;
  ball.position = {x_m, y_m, params.radius_m};
  return ball;
}

Vector3 floor_slip(const BallParams& p, const BallState& b) {
  return {b.velocity.x() - b.spin.y() * p.radius_m, b.velocity.y() + b.spin.x() * p.radius_m, 0.0};
}

double ball_energy_J(const BallParams& p, const BallState& b) {
  return 0.5 * p.mass_kg * b.velocity.squaredNorm() + 0.5 * p.inertia_kg_m2() * b.spin.squaredNorm() +
         p.mass_kg * kGravity_m_s2 * (b.position.z() - p.radius_m);
}

int advance_ball(const BallParams& p, const Carpet& carpet, BallState& b, double step_s) {
  int landings = 0;
  double left_s = step_s;
  air(p, b, step_s);
  for (int phase = 0; phase < kMostPhases && left_s > 0.0; ++phase) {
    if (!b.on_floor) {
      if (!fly(p, b, left_s)) break;
      land(p, carpet, b);
      ++landings;
      continue;
    }
    const Carpet::Here here = carpet.at(b.position.x(), b.position.y());
    const Vector3 slip = floor_slip(p, b);
    if (slip.norm() > kSlips_m_s && here.sliding_friction > 0.0)
      slide(p, carpet, here.sliding_friction, slip, b, left_s);
    else
      roll(p, carpet, here.rolling_resistance, b, left_s);
  }
  if (b.on_floor) spin_down(p, carpet, b, step_s);
  return landings;
}

}  // namespace omnihil
