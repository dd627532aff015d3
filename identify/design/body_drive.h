// Drives of a robot by commanded velocities that show most of what it does and stay near where they begin.
//
//   std::vector<BodyStep> steps = random_body_drive({.duration_s = 12.0, .speed_m_s = 1.0, .room_m = 1.0, .seed = 7});
//   steps[0].at_s; steps[0].value;                 // m/s ahead, m/s to the left, rad/s; held until the next
//
// random_body_drive: levels held 0.3 to 0.9 s, all directions, turning for a third of them, at rest for a tenth: what a first
// measurement needs (random steps are rich in frequency and visit every combination; Ljung 1999, ch. 13). scan_body_drive: out and
// back in twelve directions, then turns both ways: another kind of motion, for what must not be fitted to. Where the robot would be,
// if it did at once what it is asked, stays within room_m of the start; a candidate that would leave it is drawn again, and after
// kTries the robot is sent back. Cannot: know where a real robot has drifted to.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace omnihil {

struct BodyStep {
  double at_s = 0.0;
  std::array<double, 3> value{};
};

struct BodyDriveOptions {
  double duration_s = 12.0;
  double speed_m_s = 1.0;   // at most
  double turn_rad_s = 3.0;  // at most
  double room_m = 1.0;
  std::uint64_t seed = 1;
};

std::vector<BodyStep> random_body_drive(const BodyDriveOptions& options);
std::vector<BodyStep> scan_body_drive(const BodyDriveOptions& options);

// Farthest from the start, m, of a robot that does at once what it is asked.
double farthest_m(const std::vector<BodyStep>& steps, double duration_s);

}  // namespace omnihil
