// One exact time step of winding and rotor: the matrix exponential of the coupled (current, speed) system
// with voltage and load held, and the exact integrals of current and of its square over the step.
//
//   DcStep step = make_dc_step({.resistance_ohm = 1.2, .inductance_H = 5.6e-4, …}, 50e-6);
//   apply(step, current_A, omega, voltage_V, tau_load_Nm, charge_C, square_A2_s);
//
// Law: dc_law.h.  z = (i, omega, u, tau_load), dz/dt = M z with zero rows for u and tau_load;
//   z(h) = exp(M h) z,   integral of i = p z,   integral of i^2 = z' Q z.
// Method: Taylor series over h / 2^s, then doubling: F(2h) = F F, p(2h) = p + p F, Q(2h) = Q + F' Q F
// (C. Van Loan 1978, "Computing integrals involving the matrix exponential"), in long double.
// Valid for any h > 0; the step does not limit accuracy, only how often the inputs may change.
#pragma once
#include <array>

#include "sim/motor/dc_law.h"

namespace omnihil {

struct DcStep {
  double step_s = 0.0;
  std::array<double, 4> current_row{};  // i(h) = row . (i, omega, u, tau_load)
  std::array<double, 4> omega_row{};    // omega(h)
  std::array<double, 4> charge_row{};   // integral of i
  // Integral of i^2, upper triangle of Q with the off-diagonal terms doubled:
  // ii, i omega, i u, i tau, omega omega, omega u, omega tau, uu, u tau, tau tau
  std::array<double, 10> square_form{};
};

DcStep make_dc_step(const DcDriveConstants<double>& constants, double step_s);

// Advances current and speed by one step and adds to the two integrals. No branch, no library call.
inline void apply(const DcStep& s, double& current_A, double& omega_rad_s, double u, double tau,
                  double& charge_C, double& square_A2_s) {
  const double i = current_A, w = omega_rad_s;
  const auto& a = s.current_row;
  const auto& b = s.omega_row;
  const auto& p = s.charge_row;
  const auto& q = s.square_form;
  charge_C += p[0] * i + p[1] * w + p[2] * u + p[3] * tau;
  square_A2_s += i * (q[0] * i + q[1] * w + q[2] * u + q[3] * tau) + w * (q[4] * w + q[5] * u + q[6] * tau) +
                 u * (q[7] * u + q[8] * tau) + q[9] * tau * tau;
  current_A = a[0] * i + a[1] * w + a[2] * u + a[3] * tau;
  omega_rad_s = b[0] * i + b[1] * w + b[2] * u + b[3] * tau;
}

}  // namespace omnihil
