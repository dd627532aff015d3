// Break beam: a ray across the mouth, from sender to receiver, that the ball cuts.
//
//   bool cut = beam_cut(beam, outline, ball_in_body, 0.0215);
//   BeamMemory memory;
//   bool seen = beam_seen(beam, memory, cut, now_s, 0.0005, draw);                 // after its reaction time
//
// Geometry: the ray runs along body y at x = front + forward_m, z = height_m, as long as the flat front; it is cut when
// the ball's middle is nearer than its radius. The receiver answers reaction_s after a change that lasted that long.
// False triggers (dust, sunlight, another robot's sender): of rate false_rate_Hz, each false_time_s long, drawn per step
// from the world's seed. Cannot: a ray's width, a receiver that a kick shakes.
#pragma once
#include <cstdint>

#include "sim/robot/ball_handling.h"

namespace omnihil {

struct BeamMemory {
  double changed_s = -1.0;  // when `cut` last changed
  bool cut = false, seen = false;
  double false_until_s = -1.0;
};

bool beam_cut(const BreakBeam& beam, const RobotOutline& outline, const Vector3& ball_in_body,
              double ball_radius_m);
// draw: uniform in 0 … 1, of this step.
bool beam_seen(const BreakBeam& beam, BeamMemory& memory, bool cut, double now_s, double step_s, double draw);

}  // namespace omnihil
