// One step of a robot that rolls (rolling_robot.h): the slips on which floor, rotors and body agree.
//
//   RollingBalance<double, 4> b;           // filled by rolling_robot.cc
//   if (!b.newton(slip, inverse)) b.sweep(slip);
#pragma once
#include <Eigen/LU>
#include <array>

#include "sim/rolling/rolling_grip.h"

namespace omnihil {

// Equations of floor, rotors and body for one step, as values:
//   s - (hub + A F) + lever omega+ = 0,  F = begun - end_share f(s)
// A is symmetric but for the step's turn and positive, f and the rotors' response are increasing: one solution, but for
// the falling part of a tyre's curve.
// Size: room for so many wheels; those beyond the robot's own have no lever, no mobility and no grip, so that their slip is 0.
template <typename T, int Size>
struct RollingBalance {
  using Vector = Eigen::Matrix<double, Size, 1>;
  using Square = Eigen::Matrix<double, Size, Size>;
  // Newton's last change: by its square over a slip of 1 cm/s the solution is then off, 1e-16 m/s; or what is left of the
  // equations, by which it is off at most: whoever asks takes one more step of Newton's (rolling_solution.cc).
  static constexpr double kSolved_m_s = 1e-9, kLeft_m_s = 1e-9;
  static constexpr double kFastest_m_s = 1e3;  // no slip is faster
  static constexpr int kBisections = 60;
  static constexpr int kHalvings = 8;
  static constexpr int kIterations = 12;
  std::array<const Grip<T>*, Size> grips{};
  Square mobility;  // A: rim speed per floor force
  // per rotor: speed without floor force and friction, speed per torque, radius over gear, what friction
  // takes
  Vector hub, rotor, speed_per_torque, lever, up, down;
  Vector end_share, begun;  // mean force of a step: begun + end_share times the force at its end

  const Grip<T>& grip(Eigen::Index i) const { return *grips[static_cast<std::size_t>(i)]; }
  double omega(Eigen::Index i, double force_N) const {
    return shrunk(rotor(i) - speed_per_torque(i) * lever(i) * force_N, up(i), down(i));
  }
  double mean_force(Eigen::Index i, double slip_m_s) const {
    return begun(i) - end_share(i) * grip(i).force(slip_m_s);
  }
  Vector forces(const Vector& slip) const {
    Vector force;
    for (Eigen::Index i = 0; i < Size; ++i) force(i) = mean_force(i, slip(i));
    return force;
  }
  // What is left of the equations; `turning`: of each rotor, 1 or, held by its friction, 0.
  Vector residual(const Vector& slip, Vector& turning) const {
    const Vector force = forces(slip);
    Vector r = slip - hub - mobility * force;
    for (Eigen::Index i = 0; i < Size; ++i) {
      const double turns = omega(i, force(i));
      turning(i) = turns != 0.0 ? 1.0 : 0.0;
      r(i) += lever(i) * turns;
    }
    return r;
  }
  Square slopes(const Vector& slip) const {
    Vector turning;
    residual(slip, turning);
    return slopes(slip, turning);
  }
  Square slopes(const Vector& slip, const Vector& turning) const {
    Square out;
    for (Eigen::Index i = 0; i < Size; ++i) {
      const double slope = end_share(i) * grip(i).slope(slip(i));
      out.col(i) = mobility.col(i) * slope;
      out(i, i) += 1.0 + turning(i) * lever(i) * lever(i) * speed_per_torque(i) * slope;
    }
    return out;
  }
  // Newton, no further than what is left shrinks. `inverse`: of the slopes where the last step began.
  bool newton(Vector& slip, Square& inverse) const {
    Vector turning, left = residual(slip, turning);
    for (int round = 0; round < kIterations; ++round) {
      inverse = slopes(slip, turning).inverse();
      Vector change = inverse * left;
      if (change.cwiseAbs().maxCoeff() <= kSolved_m_s) {
        slip -= change;
        return true;
      }
      Vector next = residual(slip - change, turning);
      for (int part = 0; part < kHalvings && next.squaredNorm() > left.squaredNorm(); ++part) {
        change *= 0.5;
        next = residual(slip - change, turning);
      }
      slip -= change;
      left = next;
      if (left.cwiseAbs().maxCoeff() <= kLeft_m_s) return true;
    }
    return false;
  }
  // Wheel by wheel, each by bisection: slow, and nothing can go wrong.
  void sweep(Vector& slip) const {
    for (Eigen::Index i = 0; i < Size; ++i) {
      const Vector force = forces(slip);
      const double others = hub(i) + mobility.row(i).dot(force) - mobility(i, i) * force(i);
      const auto left = [&](double at) {
        const double own_N = mean_force(i, at);
        return at - others - mobility(i, i) * own_N + lever(i) * omega(i, own_N);
      };
      double low = -kFastest_m_s, high = kFastest_m_s;
      for (int n = 0; n < kBisections; ++n) {
        const double middle = 0.5 * (low + high);
        (left(middle) > 0.0 ? high : low) = middle;
      }
      slip(i) = 0.5 * (low + high);
    }
  }
};

}  // namespace omnihil
