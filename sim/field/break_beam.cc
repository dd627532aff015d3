#include "sim/field/break_beam.h"

#include <algorithm>
#include <cmath>

namespace omnihil {

bool beam_cut(const BreakBeam& beam, const RobotOutline& outline, const Vector3& ball, double ball_radius_m) {
  const double x_m = ball.x() - outline.front_m - beam.forward_m, z_m = ball.z() - beam.height_m;
  const double past_m = std::max(0.0, std::abs(ball.y()) - outline.half_front_m());
  return x_m * x_m + z_m * z_m + past_m * past_m < ball_radius_m * ball_radius_m;
}

bool beam_seen(const BreakBeam& beam, BeamMemory& m, bool cut, double now_s, double step_s, double draw) {
  if (cut != m.cut) {
    m.cut = cut;
    m.changed_s = now_s;
  }
  if (m.seen != m.cut && now_s - m.changed_s >= beam.reaction_s) m.seen = m.cut;
  // Poisson: within a step, 1 - exp(-rate h)
  if (beam.false_rate_Hz > 0.0 && draw < -std::expm1(-beam.false_rate_Hz * step_s))
    m.false_until_s = now_s + beam.false_time_s;
  return m.seen || now_s < m.false_until_s;
}

}  // namespace omnihil
