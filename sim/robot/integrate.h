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

template <typename Back>
void step_runge_kutta_4(Back& back, const std::vector<WheelTorques>& torques, double h,
                        std::vector<double>& q, std::vector<double>& u, IntegratorScratch& s) {
  constexpr double kWeight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  constexpr StepPart kPart[4] = {StepPart::kStart, StepPart::kMiddle, StepPart::kMiddle, StepPart::kEnd};
  constexpr double kNext[4] = {0.5, 0.5, 1.0, 0.0};
  for (double& x : s.q_sum) x = 0.0;
  for (double& x : s.u_sum) x = 0.0;
  for (int stage = 0; stage < 4; ++stage) {
    back.accelerations(torques, kPart[stage], s.udot);
    if (stage == 0)
      back.position_rates(q, u, s.qdot);
    else
      back.position_rates(s.q, s.u, s.qdot);
    for (std::size_t i = 0; i < q.size(); ++i) s.q_sum[i] += kWeight[stage] * s.qdot[i];
    for (std::size_t i = 0; i < u.size(); ++i) s.u_sum[i] += kWeight[stage] * s.udot[i];
    if (stage == 3) break;
    for (std::size_t i = 0; i < q.size(); ++i) s.q[i] = q[i] + h * kNext[stage] * s.qdot[i];
    for (std::size_t i = 0; i < u.size(); ++i) s.u[i] = u[i] + h * kNext[stage] * s.udot[i];
    back.set_state(s.q, s.u);
  }
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += h * s.q_sum[i];
  for (std::size_t i = 0; i < u.size(); ++i) u[i] += h * s.u_sum[i];
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
