// Kicker: what a pulse makes of the capacitor's charge, straight (eq. 1) and chipped, and the capacitor itself.
//
//   double v_m_s = kick_speed_m_s(kSeedKick, 0.024, 1.0);                 // 10.1 m/s: k = 24, capacitor full
//   CapacitorFlow flow = charge_capacitor(capacitor, voltage_V, 24.0, 0.001);   // voltage_V rises
//
// Law: v = (V / V_full) P(k), P of degree 3, k = pulse / unit, held to its range: P of the seed paper, eq. (1),
//        V(k) = -0.0001 k^3 + 0.0213 k^2 - 0.0315 k - 0.0098, is negative below k = 1.9 and was fitted up to the 10 m/s
//        that the paper says its robots kick (k = 24); beyond, it has no meaning and goes on to 138 m/s at k = 141.
//      speed goes with the voltage, since the energy in the ball is a share of the capacitor's.
//      C V dV/dt = eta P while charging;   a kick takes 1/2 m v^2 / eta_kick out of 1/2 C V^2
// Cannot: the coil's current and heat, a plunger's way and its return, the ball's spin at the plunger.
#pragma once
#include <span>
#include <vector>

#include "sim/robot/ball_handling.h"

namespace omnihil {

// charge_ratio: V / V_full. 0 below the law's range; the speed of its end above it.
double kick_speed_m_s(const KickLaw& law, double pulse_s, double charge_ratio);
double kick_power(const KickLaw& law, double pulse_s);  // k, held to the range

struct CapacitorFlow {
  double bus_current_A = 0.0;
};
CapacitorFlow charge_capacitor(const KickCapacitor& capacitor, double& voltage_V, double bus_voltage_V,
                               double step_s);
// What is left after a kick at that speed.
double voltage_after_kick_V(const KickCapacitor& capacitor, double voltage_V, double ball_mass_kg,
                            double speed_m_s);

struct KickPoint {
  double k = 0.0, speed_m_s = 0.0;
};
// Polynomial of degree 3 by least squares over a team's own table, its range that of the table.
// Throws std::invalid_argument with fewer than four different k, or with values that are not finite.
struct KickFit {
  KickLaw law;
  double rms_m_s = 0.0;
};
KickFit fit_kick(std::span<const KickPoint> table, double pulse_unit_s);

}  // namespace omnihil
