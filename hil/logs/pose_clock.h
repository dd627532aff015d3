// Where the clock of a log of poses (a video, a motion capture) stands against the robot's own log, whose clock is another.
//
//   PoseClock c = pose_clock(of_robot, of_pose);
//   if (!c.problem.empty()) throw BadLog(c.problem);
//   // a pose of time t on its clock was at t - c.offset_s on the robot's
//
// Law: both tell a velocity in the plane, v as a complex number: the robot by its wheels, turned by its heading; the pose
// by its path. The lag is where |sum conj(v_robot) v_pose| / sqrt(sum |v_robot|^2 sum |v_pose|^2) is largest, both means over
// kSmooth_s, in steps of kStep_s, refined by a parabola. The angle of that sum is that between the two frames, its size under
// sum |v_pose|^2 how far the pose goes where the wheels say one. A pose without a place is lined up by its turn rate.
// Its spread is that of four stretches. Cannot: clocks that drift; a robot that drives one way at one speed.
#pragma once
#include <complex>
#include <string>
#include <vector>

namespace omnihil {

struct MotionTrack {
  std::vector<double> time_s;  // increasing, n
  std::vector<std::complex<double>>
      velocity_m_s;  // in a frame at rest; of the turn rate alone: rad/s, no imaginary part
};

struct PoseClock {
  double offset_s = 0.0, sigma_s = 0.0;  // sigma: infinite where the motion does not tell it
  double correlation = 0.0;              // 0 to 1
  double frame_rad = 0.0;                // the pose's frame is turned so against the robot's heading
  double frame_sigma_rad = 0.0;
  double scale = 1.0;   // way of the pose over way of the wheels
  std::string problem;  // not empty: they do not tell one motion
};

// dx/dt of a path at its own samples, by the chord over `span_s`.
MotionTrack track_of_path(const std::vector<double>& time_s, const std::vector<std::complex<double>>& place,
                          double span_s);

PoseClock pose_clock(const MotionTrack& robot, const MotionTrack& pose);

}  // namespace omnihil
