// One exact time step of winding and rotor: the matrix exponential of the coupled (current, speed) system
// with voltage and load held, and the exact integrals of current and of its square over the step.
//
//   DcStep step = make_dc_step({.resistance_ohm = 1.2, .inductance_H = 5.6e-4, …}, 50e-6);
//   DcFlow flow{.current_A = i_A, .omega_rad_s = w};
//   apply(step, flow, voltage_V, tau_load_Nm);
//
// Law: dc_law.h.  z = (i, omega, u, tau_load), dz/dt = M z with zero rows for u and tau_load;
//   z(h) = exp(M h) z,   integrals of i and omega: rows times z,   integral of i^2 = z' Q z.
// Method: Taylor series over h / 2^s, then doubling: F(2h) = F F, p(2h) = p + p F, Q(2h) = Q + F' Q F
// (C. Van Loan 1978, "Computing integrals involving the matrix exponential"), in long double.
// Valid for any h > 0; the step does not limit accuracy, only how often the inputs may change.
#pragma once
#include <array>

#include "sim/drive/dc_law.h"

namespace omnihil {

struct DcStep {
  double step_s = 0.0;
  std::array<double, 4> current_row{};  // i(h) = row . (i, omega, u, tau_load)
  std::array<double, 4> omega_row{};    // omega(h)
  std::array<double, 4> charge_row{};   // integral of i
  std::array<double, 4> angle_row{};    // integral of omega
  // Integral of i^2, upper triangle of Q with the off-diagonal terms doubled:
  // ii, i omega, i u, i tau, omega omega, omega u, omega tau, uu, u tau, tau tau
  std::array<double, 10> square_form{};
};

DcStep make_dc_step(const DcDriveConstants<double>& constants, double step_s);

// What moves: current and speed, and their integrals since the flow began.
struct DcFlow {
  double current_A = 0.0;
  double omega_rad_s = 0.0;
  double charge_C = 0.0;     // integral of i
  double angle_rad = 0.0;    // integral of omega
  double square_A2_s = 0.0;  // integral of i^2
  double energy_J = 0.0;     // integral of u i
};

// One step with voltage and load held. No branch, no library call.
inline void apply(const DcStep& s, DcFlow& flow, double u, double tau) {
  const double i = flow.current_A, w = flow.omega_rad_s;
  const auto& a = s.current_row;
  const auto& b = s.omega_row;
  const auto& p = s.charge_row;
  const auto& t = s.angle_row;
  const auto& q = s.square_form;
  const double charge_C = p[0] * i + p[1] * w + p[2] * u + p[3] * tau;
  flow.charge_C += charge_C;
  flow.energy_J += u * charge_C;
  flow.angle_rad += t[0] * i + t[1] * w + t[2] * u + t[3] * tau;
  flow.square_A2_s += i * (q[0] * i + q[1] * w + q[2] * u + q[3] * tau) +
                      w * (q[4] * w + q[5] * u + q[6] * tau) + u * (q[7] * u + q[8] * tau) + q[9] * tau * tau;
  flow.current_A = a[0] * i + a[1] * w + a[2] * u + a[3] * tau;
  flow.omega_rad_s = b[0] * i + b[1] * w + b[2] * u + b[3] * tau;
}

}  // namespace omnihil
