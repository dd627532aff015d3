#include "sim/field/kicker.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace omnihil {
namespace {
double polynomial(const std::array<double, 4>& c, double k) {
  return c[0] + k * (c[1] + k * (c[2] + k * c[3]));
}
}  // namespace

double kick_power(const KickLaw& law, double pulse_s) {
  return std::clamp(pulse_s / law.pulse_unit_s, law.k_least, law.k_most);
}

double kick_speed_m_s(const KickLaw& law, double pulse_s, double charge_ratio) {
  if (!(pulse_s > 0.0) || pulse_s / law.pulse_unit_s < law.k_least) return 0.0;
  return std::max(0.0, charge_ratio * polynomial(law.c, kick_power(law, pulse_s)));
}

CapacitorFlow charge_capacitor(const KickCapacitor& c, double& voltage_V, double bus_voltage_V,
                               double step_s) {
  if (voltage_V >= c.full_V || !(bus_voltage_V > 0.0)) return {};
  const double room_J = 0.5 * c.capacitance_F * (c.full_V * c.full_V - voltage_V * voltage_V);
  const double charged_J = std::min(c.charge_efficiency * c.charge_power_W * step_s, room_J);
  voltage_V = std::sqrt(voltage_V * voltage_V + 2.0 * charged_J / c.capacitance_F);
  return {charged_J / (c.charge_efficiency * step_s * bus_voltage_V)};
}

double voltage_after_kick_V(const KickCapacitor& c, double voltage_V, double ball_mass_kg, double speed_m_s) {
  const double taken_J = 0.5 * ball_mass_kg * speed_m_s * speed_m_s / c.kick_efficiency;
  return std::sqrt(std::max(0.0, voltage_V * voltage_V - 2.0 * taken_J / c.capacitance_F));
}

KickFit fit_kick(std::span<const KickPoint> table, double pulse_unit_s) {
  std::set<double> different;
  for (const KickPoint& p : table) {
    if (!std::isfinite(p.k) || !std::isfinite(p.speed_m_s))
      throw std::invalid_argument("a kick table has finite numbers only");
    different.insert(p.k);
  }
  if (different.size() < 4) throw std::invalid_argument("a cubic needs at least four different k");
  const double scale = std::max(std::abs(*different.begin()), std::abs(*different.rbegin()));
  Eigen::MatrixXd a(static_cast<Eigen::Index>(table.size()), 4);
  Eigen::VectorXd v(static_cast<Eigen::Index>(table.size()));
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double x = table[i].k / scale;
    a.row(row) << 1.0, x, x * x, x * x * x;
    v(row) = table[i].speed_m_s;
  }
  const Eigen::Vector4d c = a.colPivHouseholderQr().solve(v);
  KickFit fit;
  fit.law.pulse_unit_s = pulse_unit_s;
  fit.law.c = {c[0], c[1] / scale, c[2] / (scale * scale), c[3] / (scale * scale * scale)};
  fit.law.k_least = *different.begin();
  fit.law.k_most = *different.rbegin();
  const double freedoms = static_cast<double>(table.size()) - 4.0;
  fit.rms_m_s = freedoms > 0.0 ? std::sqrt((a * c - v).squaredNorm() / freedoms) : 0.0;
  return fit;
}

}  // namespace omnihil
