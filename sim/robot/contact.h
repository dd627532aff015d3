// Forces of the floor on the wheels of one robot, for given speeds: slip, tyre curves, wheel loads.
//
//   ContactLaw<double> law = contact_law(model);
//   WheelContacts<double> c = contact_forces(law, wheel_motion(law, velocity, omega_wheel_rad_s));
//   c.force_longitudinal_N[i], c.force_x_N, c.force_y_N, c.moment_z_Nm;
//
// Law: force_longitudinal = -grip_longitudinal(slip) N   along the drive direction t_i = (-sin a_i, cos a_i)
//      force_lateral      = -grip_lateral(slip) N        along the axle, outward, rho_i = (cos a_i, sin a_i)
//      eq. (4) with S = N. N depends on the sum F of these forces (wheel_load.h) and F on N, both linearly:
//      F = G N, N = N_rest + K F  =>  (1 - G K) F = G N_rest, a 2x2 system solved exactly; nothing is taken
//      from the step before, so the law is a function of the speeds alone and the same in every back end.
//       Where a load would fall below zero, the transfer is scaled down until the lightest wheel carries nothing.
// Source: eqs. (4) and (6) and Table I of Bakhshandeh and Sharbafi 2012 as read in tyre.h and slip.h.
// Combined slip: the two directions do not limit each other (the rollers turn, the ring drives).
// Cannot represent: a wheel in the air (kSimbodyFree does), bumps of the rollers, contact off the wheel's
// middle.
#pragma once
#include "sim/robot/geometry.h"
#include "sim/robot/slip.h"
#include "sim/robot/tyre.h"
#include "sim/robot/wheel_load.h"

namespace omnihil {

template <typename T>
struct ContactLaw {
  WheelGeometry<T> geometry;
  WheelLoadLaw<T> load;
  TyreCurve longitudinal;
  TyreCurve lateral;
  T slip_speed_floor_m_s{};
};

template <typename T>
struct WheelMotion {
  PerWheel<T> drive_speed_m_s{};   // wheel centre over the floor, along t_i
  PerWheel<T> roller_speed_m_s{};  // along rho_i
  PerWheel<T> rim_speed_m_s{};     // R omega_wheel
};

template <typename T>
struct WheelContacts {
  PerWheel<T> slip_longitudinal_ratio{};
  PerWheel<T> force_longitudinal_N{};
  PerWheel<T> force_lateral_N{};
  PerWheel<T> load_N{};
  T force_x_N{}, force_y_N{};  // sum, body frame
  T moment_z_Nm{};             // about the geometric centre
};

inline ContactLaw<double> contact_law(const RobotModel& model) {
  ContactLaw<double> law;
  law.geometry = wheel_geometry(model);
  law.load = wheel_load_law(law.geometry, model.mass_kg, model.center_of_mass_x_m, model.center_of_mass_y_m,
                            model.center_of_mass_height_m);
  law.longitudinal = model.tyre_longitudinal;
  law.lateral = model.tyre_lateral;
  law.slip_speed_floor_m_s = model.slip_speed_floor_m_s;
  return law;
}

// On the level floor.
template <typename T>
WheelMotion<T> wheel_motion(const ContactLaw<T>& law, const BodyVelocity<T>& v,
                            const PerWheel<T>& omega_wheel_rad_s) {
  WheelMotion<T> m;
  each_wheel(law.geometry.wheels, [&](std::size_t i) {
    m.drive_speed_m_s[i] = rim_speed_m_s(law.geometry, i, v);
    m.roller_speed_m_s[i] = roller_speed_m_s(law.geometry, i, v);
    m.rim_speed_m_s[i] = law.geometry.wheel_radius_m * omega_wheel_rad_s[i];
  });
  return m;
}

// Of all wheels at once. Divisions take most of a contact's time; in pairs they cost half, with the same bits. Where the
// count is odd, the divisor behind the last wheel's is 1.
template <typename T>
[[gnu::always_inline]] inline PerWheel<T> quotients(std::size_t wheels, const PerWheel<T>& a, PerWheel<T> b) {
  PerWheel<T> out;
  if constexpr (std::is_same_v<T, double>) {
    using Pair [[gnu::vector_size(16)]] = double;
    if (wheels % 2 != 0) b[wheels] = 1.0;
    each_wheel((wheels + 1) / 2 * 2, [&](std::size_t i) {
      if (i % 2 != 0) return;
      const Pair q = Pair{a[i], a[i + 1]} / Pair{b[i], b[i + 1]};
      out[i] = q[0];
      out[i + 1] = q[1];
    });
  } else {
    each_wheel(wheels, [&](std::size_t i) { out[i] = a[i] / b[i]; });
  }
  return out;
}
template <typename T>
[[gnu::always_inline]] inline PerWheel<T> quotients(std::size_t wheels, const PerWheel<T>& a, const T& b) {
  PerWheel<T> all;
  all.fill(b);
  return quotients(wheels, a, all);
}

// Force over load, signed, per wheel; fills the slips.
template <typename T>
struct WheelGrip {
  PerWheel<T> longitudinal_ratio{};
  PerWheel<T> lateral_ratio{};
};

template <typename T>
WheelGrip<T> wheel_grip(const ContactLaw<T>& law, const WheelMotion<T>& m, WheelContacts<T>& out) {
  const std::size_t wheels = law.geometry.wheels;
  PerWheel<T> slides{}, scale_along, scale_across;
  each_wheel(wheels, [&](std::size_t i) {
    slides[i] = m.drive_speed_m_s[i] - m.rim_speed_m_s[i];
    scale_along[i] = slip_scale_m_s(m.drive_speed_m_s[i], m.rim_speed_m_s[i], law.slip_speed_floor_m_s);
    scale_across[i] = slip_scale_m_s(m.roller_speed_m_s[i], T(0), law.slip_speed_floor_m_s);
  });
  const PerWheel<T> along = quotients(wheels, slides, scale_along),
                    across = quotients(wheels, m.roller_speed_m_s, scale_across),
                    x_along = quotients(wheels, along, T(law.longitudinal.extremum_slip)),
                    x_across = quotients(wheels, across, T(law.lateral.extremum_slip));
  WheelGrip<T> g;
  each_wheel(wheels, [&](std::size_t i) {
    out.slip_longitudinal_ratio[i] = along[i];
    g.longitudinal_ratio[i] = -grip_at(law.longitudinal, along[i], x_along[i]);
    g.lateral_ratio[i] = -grip_at(law.lateral, across[i], x_across[i]);
  });
  return g;
}

// Forces and their sum for loads that are known.
template <typename T>
void apply_loads(const ContactLaw<T>& law, const WheelGrip<T>& g, WheelContacts<T>& out) {
  T x_N = T(0), y_N = T(0), z_Nm = T(0);
  each_wheel(law.geometry.wheels, [&](std::size_t i) {
    const T f = g.longitudinal_ratio[i] * out.load_N[i];
    const T s = g.lateral_ratio[i] * out.load_N[i];
    out.force_longitudinal_N[i] = f;
    out.force_lateral_N[i] = s;
    x_N += -law.geometry.sin_angle[i] * f + law.geometry.cos_angle[i] * s;
    y_N += law.geometry.cos_angle[i] * f + law.geometry.sin_angle[i] * s;
    z_Nm += law.geometry.wheel_center_radius_m * f;
  });
  out.force_x_N = x_N;
  out.force_y_N = y_N;
  out.moment_z_Nm = z_Nm;
}

// Loads by the law of wheel_load.h, transfer included; with a further horizontal force of the floor, if any.
template <typename T>
void find_loads(const ContactLaw<T>& law, const WheelGrip<T>& g, WheelContacts<T>& out,
                const T& added_x_N = T(0), const T& added_y_N = T(0)) {
  // (1 - G K) F = G N_rest + F_added
  T a = T(1), b = T(0), c = T(0), d = T(1), right_x = added_x_N, right_y = added_y_N;
  const std::size_t wheels = law.geometry.wheels;
  each_wheel(wheels, [&](std::size_t i) {
    const T gx =
        -law.geometry.sin_angle[i] * g.longitudinal_ratio[i] + law.geometry.cos_angle[i] * g.lateral_ratio[i];
    const T gy =
        law.geometry.cos_angle[i] * g.longitudinal_ratio[i] + law.geometry.sin_angle[i] * g.lateral_ratio[i];
    a -= gx * law.load.per_force_x_ratio[i];
    b -= gx * law.load.per_force_y_ratio[i];
    c -= gy * law.load.per_force_x_ratio[i];
    d -= gy * law.load.per_force_y_ratio[i];
    right_x += gx * law.load.at_rest_N[i];
    right_y += gy * law.load.at_rest_N[i];
  });
  const T determinant = a * d - b * c;
  const T force_x_N = (d * right_x - b * right_y) / determinant;
  const T force_y_N = (a * right_y - c * right_x) / determinant;
  T part = T(1);  // of the transfer that the lightest wheel allows
  PerWheel<T> change_N;
  each_wheel(wheels, [&](std::size_t i) {
    change_N[i] = law.load.transfer(i, force_x_N, force_y_N);
    if (law.load.at_rest_N[i] + part * change_N[i] < T(0)) part = -law.load.at_rest_N[i] / change_N[i];
  });
  each_wheel(wheels, [&](std::size_t i) { out.load_N[i] = law.load.at_rest_N[i] + part * change_N[i]; });
}

// `out` may hold those of another instant of the same robot.
template <typename T>
void find_contacts(const ContactLaw<T>& law, const WheelMotion<T>& motion, WheelContacts<T>& out) {
  const WheelGrip<T> g = wheel_grip(law, motion, out);
  find_loads(law, g, out);
  apply_loads(law, g, out);
}

template <typename T>
WheelContacts<T> contact_forces(const ContactLaw<T>& law, const WheelMotion<T>& motion) {
  WheelContacts<T> out;
  find_contacts(law, motion, out);
  return out;
}

// Wheels in the air: nothing acts on them; the sums are those of the others.
inline void lift_wheels(const ContactLaw<double>& law, const PerWheel<bool>& lifted,
                        WheelContacts<double>& c) {
  if (lifted == PerWheel<bool>{}) return;
  c.force_x_N = c.force_y_N = c.moment_z_Nm = 0.0;
  for (std::size_t i = 0; i < law.geometry.wheels; ++i) {
    double& f = c.force_longitudinal_N[i];
    double& s = c.force_lateral_N[i];
    if (lifted[i]) f = s = c.load_N[i] = 0.0;
    c.force_x_N += -law.geometry.sin_angle[i] * f + law.geometry.cos_angle[i] * s;
    c.force_y_N += law.geometry.cos_angle[i] * f + law.geometry.sin_angle[i] * s;
    c.moment_z_Nm += law.geometry.wheel_center_radius_m * f;
  }
}

// Same with loads that something else knows (springs of the free body).
template <typename T>
WheelContacts<T> contact_forces_at(const ContactLaw<T>& law, const WheelMotion<T>& motion,
                                   const PerWheel<T>& load_N) {
  WheelContacts<T> out;
  const WheelGrip<T> g = wheel_grip(law, motion, out);
  out.load_N = load_N;
  apply_loads(law, g, out);
  return out;
}

}  // namespace omnihil
