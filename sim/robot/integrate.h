// The two integrators, written once over any mechanics back end (mechanics.h), so that back ends differ by
// rounding only.
//
//   IntegratorScratch scratch(q.size(), u.size());
//   back.set_state(q, u);               // contacts() are wanted before the torques are known
//   integrate(Integrator::kRungeKutta4, back, torques, step_s, q, u, scratch);
//
// Law: semi-implicit Euler, u += h f(q, u), q += h N(q) u (order 1, one evaluation), and the classical
//      Runge-Kutta method of order 4 on (q, u) (four evaluations). The first sees the mean torques of
//      the step, the second their profile (mechanics.h).
// Expects back.set_state(q, u) to have been called for the step's start.
// Both are explicit: stable only while the stiffest contact mode is slow against the step; validate.h refuses
// models for which it is not.
#pragma once
#include <algorithm>
#include <vector>

#include "sim/robot/mechanics.h"
#include "sim/robot/plant.h"

namespace omnihil {

struct IntegratorScratch {
  IntegratorScratch(std::size_t nq, std::size_t nu)
      : q(nq), qdot(nq), q_sum(nq), u(nu), udot(nu), u_sum(nu) {}
  std::vector<double> q, qdot, q_sum;
  std::vector<double> u, udot, u_sum;
};

template <typename Back>
void step_semi_implicit_euler(Back& back, const std::vector<WheelTorques>& torques, double h,
                              std::vector<double>& q, std::vector<double>& u, IntegratorScratch& s) {
  back.accelerations(torques, StepPart::kHeld, s.udot);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += h * s.udot[i];
  back.position_rates(q, u, s.qdot);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += h * s.qdot[i];
}

// Of a stage: sum += weight rate, and where the next one looks, next = x + ahead rate.
inline void add_stage(const std::vector<double>& x, const std::vector<double>& rate, double weight,
                      double ahead_s, std::vector<double>& sum, std::vector<double>& next) {
  const double* __restrict const at = x.data(), * __restrict const rates = rate.data();
  double* __restrict const sums = sum.data(), * __restrict const nexts = next.data();
  for (std::size_t i = 0, n = x.size(); i < n; ++i) {
    sums[i] += weight * rates[i];
    nexts[i] = at[i] + ahead_s * rates[i];
  }
}
inline void add_last_stage(const std::vector<double>& rate, double weight, double step_s,
                           const std::vector<double>& sum, std::vector<double>& x) {
  const double* __restrict const rates = rate.data(), * __restrict const sums = sum.data();
  double* __restrict const at = x.data();
  for (std::size_t i = 0, n = x.size(); i < n; ++i) at[i] += step_s * (sums[i] + weight * rates[i]);
}

template <typename Back>
void step_runge_kutta_4(Back& back, const std::vector<WheelTorques>& torques, double h,
                        std::vector<double>& q, std::vector<double>& u, IntegratorScratch& s) {
  constexpr double kWeight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  constexpr StepPart kPart[4] = {StepPart::kStart, StepPart::kMiddle, StepPart::kMiddle, StepPart::kEnd};
  constexpr double kNext[4] = {0.5, 0.5, 1.0, 0.0};
  std::fill(s.q_sum.begin(), s.q_sum.end(), 0.0);
  std::fill(s.u_sum.begin(), s.u_sum.end(), 0.0);
  for (int stage = 0;; ++stage) {
    back.accelerations(torques, kPart[stage], s.udot);
    const std::vector<double>& at = stage == 0 ? q : s.q;
    const std::vector<double>& speeds = stage == 0 ? u : s.u;
    if constexpr (!Back::kRatesAreSpeeds) back.position_rates(at, speeds, s.qdot);
    const std::vector<double>& qdot = Back::kRatesAreSpeeds ? speeds : s.qdot;
    if (stage == 3) {
      add_last_stage(qdot, kWeight[3], h, s.q_sum, q);
      add_last_stage(s.udot, kWeight[3], h, s.u_sum, u);
      return;
    }
    const double weight = kWeight[stage], ahead_s = h * kNext[stage];
    add_stage(q, qdot, weight, ahead_s, s.q_sum, s.q);
    add_stage(u, s.udot, weight, ahead_s, s.u_sum, s.u);
    back.set_state(s.q, s.u);
  }
}

template <typename Back>
void integrate(Integrator integrator, Back& back, const std::vector<WheelTorques>& torques, double step_s,
               std::vector<double>& q, std::vector<double>& u, IntegratorScratch& scratch) {
  if (integrator == Integrator::kRungeKutta4) {
    step_runge_kutta_4(back, torques, step_s, q, u, scratch);
  } else {
    step_semi_implicit_euler(back, torques, step_s, q, u, scratch);
  }
  back.normalise(q);
}

}  // namespace omnihil
