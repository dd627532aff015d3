// The true motion of the recent past, for measurements that are older than their stamp.
//
//   record.push({.time_s = t, .theta_rad = theta_rad, .omega_rad_s = w, .charge_C = q_C});
//   MotionPoint<Jet> p = record.at(t - age);      // derivative with respect to the age included
//
// Angle by cubic Hermite interpolation (its slope is the speed), the others linearly. Before the first point
// the axis moved at that point's speed.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "sim/law/scalar.h"

namespace omnihil {

template <typename T>
struct MotionPoint {
  double time_s = 0.0;
  T theta_rad = T(0);
  T omega_rad_s = T(0);
  T charge_C = T(0);  // integral of the current
  // The output's angle and speed less what the rotor's would be through a rigid gear.
  T lead_rad = T(0);
  T lead_rad_s = T(0);
};

template <typename T>
class MotionRecord {
 public:
  explicit MotionRecord(double span_s) : span_s_(span_s) {}

  void push(const MotionPoint<T>& p) {
    points_.push_back(p);
    // Forget what is too old in portions of half, so that a long span costs no more per point than a short
    // one.
    const std::size_t half = points_.size() / 2;
    if (points_.size() > 4096 && points_[half].time_s < p.time_s - span_s_)
      points_.erase(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(half - 1));
  }

  void clear() { points_.clear(); }

  MotionPoint<T> at(const T& time_s) const {
    const double t = value_of(time_s);
    const MotionPoint<T>& first = points_.front();
    if (t <= first.time_s) {
      MotionPoint<T> rest = first;
      rest.theta_rad += (time_s - first.time_s) * first.omega_rad_s;
      return rest;
    }
    const auto after = std::partition_point(points_.begin(), points_.end() - 1,
                                            [&](const MotionPoint<T>& p) { return p.time_s <= t; });
    const std::size_t i = static_cast<std::size_t>(after - points_.begin()) - 1;
    const MotionPoint<T>&a = points_[i], &b = points_[i + 1];
    const double h = b.time_s - a.time_s;
    const T s = (time_s - a.time_s) / h, r = 1.0 - s;
    MotionPoint<T> p;
    p.time_s = t;
    // Hermite: (1 + 2 s)(1 - s)^2 th_a + s (1 - s)^2 h w_a + s^2 (3 - 2 s) th_b - s^2 (1 - s) h w_b
    p.theta_rad = a.theta_rad + (b.theta_rad - a.theta_rad) * s * s * (3.0 - 2.0 * s) +
                  s * r * r * h * a.omega_rad_s - s * s * r * h * b.omega_rad_s;
    p.omega_rad_s = a.omega_rad_s + (b.omega_rad_s - a.omega_rad_s) * s;
    p.charge_C = a.charge_C + (b.charge_C - a.charge_C) * s;
    p.lead_rad = a.lead_rad + (b.lead_rad - a.lead_rad) * s;
    p.lead_rad_s = a.lead_rad_s + (b.lead_rad_s - a.lead_rad_s) * s;
    return p;
  }

 private:
  double span_s_;
  std::vector<MotionPoint<T>> points_;
};

}  // namespace omnihil
