// Two masses that warm up: the winding, heated by its losses, and the housing it sits in.
//
//   ThermalParams<double> p = {.winding_to_housing_K_per_W = 1.57, .housing_to_ambient_K_per_W = 8.28, …};
//   ThermalState<double> s;                                        // rises over ambient, K
//   advance_thermal(p, s, heat_W, 1.0);
//   double r = warm_resistance_ohm(r25_ohm, kCopperPerK, s.winding_K);
//
// Law: C_w dT_w/dt = P - (T_w - T_h) / R_wh,   C_h dT_h/dt = (T_w - T_h) / R_wh - T_h / R_ha
//      R(T) = R (1 + alpha dT),   lambda(T) = lambda (1 + beta dT), beta < 0
// Exact for held heat: the 2x2 matrix exponential by its two real eigenvalues. Steady: T_h = P R_ha,
// T_w = P (R_wh + R_ha).
// Source: Maxon, "Key information" (thermal model with R_th1, R_th2, tau_w, tau_m); alpha of copper 0.00393
// per K (IEC 60028); beta about -0.0011 per K (neodymium magnets' data sheets).
// Cannot: iron loss as a separate source, air flow that depends on speed, magnets at another temperature than
// the housing. Templates on the scalar.
#pragma once
#include <cmath>

namespace omnihil {

inline constexpr double kCopperPerK = 0.00393;
inline constexpr double kNeodymiumPerK = -0.0011;

template <typename T>
struct ThermalParams {
  T winding_to_housing_K_per_W = T(0);
  T housing_to_ambient_K_per_W = T(0);
  T winding_J_per_K = T(0);
  T housing_J_per_K = T(0);
};

// From a data sheet's time constants: tau_w = C_w R_wh, tau_m = C_h R_ha.
template <typename T>
ThermalParams<T> thermal_of_datasheet(const T& r_winding_housing, const T& r_housing_ambient,
                                      const T& tau_winding_s, const T& tau_motor_s) {
  return {r_winding_housing, r_housing_ambient, tau_winding_s / r_winding_housing,
          tau_motor_s / r_housing_ambient};
}

template <typename T>
struct ThermalState {
  T winding_K = T(0);  // over ambient
  T housing_K = T(0);
};

template <typename T>
void advance_thermal(const ThermalParams<T>& p, ThermalState<T>& s, const T& heat_W, double h_s) {
  using std::exp, std::sqrt;
  // d/dt (T_w, T_h) = A (T_w, T_h) + ...,  A = [-a a; b -(b + c)]
  const T a = 1.0 / (p.winding_J_per_K * p.winding_to_housing_K_per_W);
  const T b = 1.0 / (p.housing_J_per_K * p.winding_to_housing_K_per_W);
  const T c = 1.0 / (p.housing_J_per_K * p.housing_to_ambient_K_per_W);
  // eigenvalues m +- d, both negative: m = trace / 2, d^2 = m^2 - det > 0
  const T m = -0.5 * (a + b + c), d = sqrt(m * m - a * c);
  const T slow = exp((m + d) * h_s), fast = exp((m - d) * h_s);
  // exp(A h) = f I + g A
  const T g = (slow - fast) / (2.0 * d), f = slow - (m + d) * g;
  const T steady_housing = heat_W * p.housing_to_ambient_K_per_W;
  const T steady_winding = steady_housing + heat_W * p.winding_to_housing_K_per_W;
  const T w = s.winding_K - steady_winding, h = s.housing_K - steady_housing;
  s.winding_K = steady_winding + f * w + g * a * (h - w);
  s.housing_K = steady_housing + f * h + g * (b * w - (b + c) * h);
}

// R(T) = R (1 + alpha dT)
template <typename T>
T warm_resistance_ohm(const T& resistance_ohm, const T& per_K, const T& rise_K) {
  return resistance_ohm * (1.0 + per_K * rise_K);
}

// lambda(T) = lambda (1 + beta dT)
template <typename T>
T warm_flux_Wb(const T& flux_Wb, const T& per_K, const T& rise_K) {
  return flux_Wb * (1.0 + per_K * rise_K);
}

}  // namespace omnihil
