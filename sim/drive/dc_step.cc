#include "sim/drive/dc_step.h"

#include <Eigen/Core>

namespace omnihil {
namespace {

using Real = long double;
using Square = Eigen::Matrix<Real, 4, 4>;
using Row = Eigen::Matrix<Real, 1, 4>;

// i as a row over z = (i, omega, u, tau_load), and dz/dt = M z.
struct System {
  Row current = Row::Zero();
  Square rates = Square::Zero();
};

System system_of(const DcDriveConstants<double>& c) {
  const Real r = c.resistance_ohm, l = c.inductance_H, k = c.torque_constant_Nm_per_A, j = c.inertia_kg_m2;
  System s;
  if (l > 0) {
    s.current << 1, 0, 0, 0;
    s.rates.row(0) << -r / l, -k / l, 1 / l, 0;  // L di/dt = u - R i - k omega
  } else {
    s.current << 0, -k / r, 1 / r, 0;  // i = (u - k omega) / R
  }
  s.rates.row(1) = k / j * s.current;  // J domega/dt = k i - tau_load
  s.rates(1, 3) = -1 / j;
  return s;
}

struct Step {
  Square transition = Square::Identity();
  Square sum = Square::Zero();     // integral of exp(M t)
  Square square = Square::Zero();  // integral of i^2 as a quadratic form in z(0)
};

// Taylor series, short enough a step that 24 terms exhaust long double.
Step taylor_step(const System& s, Real h) {
  constexpr int kTerms = 24;
  Step step;
  Square power = Square::Identity();                    // (M h)^n / n!
  Square form = s.current.transpose() * s.current * h;  // n-th derivative of e' W e, times h^(n+1) / (n+1)!
  for (int n = 0; n < kTerms; ++n) {
    step.sum += power * (h / (n + 1));
    step.square += form;
    power = (power * s.rates * (h / (n + 1))).eval();
    step.transition += power;
    form = ((s.rates.transpose() * form + form * s.rates) * (h / (n + 2))).eval();
  }
  return step;
}

}  // namespace

DcStep make_dc_step(const DcDriveConstants<double>& constants, double step_s) {
  const System s = system_of(constants);
  // Doublings until the short step's dynamics are slow: the feedback block sets the pace, u and tau only
  // drive.
  Real fastest = s.rates.topLeftCorner<2, 2>().cwiseAbs().rowwise().sum().maxCoeff();
  Real h = step_s;
  int doublings = 0;
  for (; h * fastest > Real(0.25); h /= 2) ++doublings;
  Step e = taylor_step(s, h);
  for (int n = 0; n < doublings; ++n) {
    e.square = (e.square + e.transition.transpose() * e.square * e.transition).eval();
    e.sum = (e.sum + e.sum * e.transition).eval();
    e.transition = (e.transition * e.transition).eval();
  }
  const Row current = s.current * e.transition, charge = s.current * e.sum;
  DcStep out;
  out.step_s = step_s;
  std::size_t n = 0;
  for (int row = 0; row < 4; ++row) {
    const auto at = static_cast<std::size_t>(row);
    out.current_row[at] = static_cast<double>(current(row));
    out.omega_row[at] = static_cast<double>(e.transition(1, row));
    out.charge_row[at] = static_cast<double>(charge(row));
    out.angle_row[at] = static_cast<double>(e.sum(1, row));
    for (int col = row; col < 4; ++col) {
      out.square_form[n++] = static_cast<double>((row == col ? 1 : 2) * e.square(row, col));
    }
  }
  return out;
}

}  // namespace omnihil
