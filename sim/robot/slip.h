// Slip of one wheel: eq. (6) completed for every combination of signs, for zero and for standstill.
//
//   double slip = slip_ratio(v_drive_m_s, omega_wheel_rad_s * wheel_radius_m, model.slip_speed_floor_m_s);
//
// Law:  slip = (v - R omega) / max(|v|, |R omega|, floor)
//       v        speed of the wheel's centre over the floor along the drive direction
//       R omega  rim speed;   floor  speed below which slip is taken relative to it
// Source: Bakhshandeh and Sharbafi 2012, eq. (6). It prints two of the cases,
//       1 - R omega / v  for v > R omega > 0    and    -1 + v / (R omega)  for R omega > v > 0,
// and both are the law above. It is odd under a change of both signs, continuous everywhere, 0 for rolling,
// within -1..1 for equal signs and within -2..2 when the wheel turns against the motion.
// At standstill eq. (6) is 0/0; with the floor, slip is proportional to the sliding speed there. The price:
// a robot at rest is held by viscous force, not by stiction, so under a steady side force it would creep; on
// a level floor none acts. The rollers are not driven, so across the drive direction R omega = 0:
// slip = v / max(|v|, floor).
#pragma once

namespace omnihil {

template <typename T>
T slip_scale_m_s(const T& v_m_s, const T& rim_m_s, const T& floor_m_s) {
  const T v = v_m_s < T(0) ? T(-v_m_s) : v_m_s;
  const T rim = rim_m_s < T(0) ? T(-rim_m_s) : rim_m_s;
  T scale = v < rim ? rim : v;
  return scale < floor_m_s ? floor_m_s : scale;
}

template <typename T>
T slip_ratio(const T& v_m_s, const T& rim_m_s, const T& floor_m_s) {
  return (v_m_s - rim_m_s) / slip_scale_m_s(v_m_s, rim_m_s, floor_m_s);
}

}  // namespace omnihil
