// Dribbler: a bar with its motor above the ball's rear, on a spring-damper mount, that spins the ball towards the robot.
//
//   DribblerStep step = drive_bar(dribbler, omega_bar_rad_s, 0.8, 22.2, 0.0005);  // motor alone, one step
//   double a = held_acceleration_m_s2(dribbler, 0.0725, 0.0215, 0.046, 0.35);                      // braking that the ball stands
//
// Motor, at the bar (gear g, winding eq. 7):  J dw/dt = g k (u - k g w) / R - tau_f sign(w) - friction of the ball
// Contact of bar and ball: normal n = (c, 0, -s) from the bar to the ball, s = (z_bar - r) / (r_bar + r); spring and
// damper along n, Coulomb friction mu_b against the bar's surface speed (contact_solver.h).
// What holds the ball: spun backwards, it rubs on the carpet (mu_f), which pushes it to the robot. In a steady hold its
// torque balance asks friction at bar and carpet to be equal, F, and with N the bar's normal force
//   down:    N_f = m g + N s + F c,      F = mu_f N_f    (the carpet's friction is all used: the bar is faster)
//   back:    m a = F (1 + s) - N c,      F <= mu_b N
// N is the mount's spring at that place of the ball, s and c follow it; the ball stands between where it just touches the
// bar and the front, and a_most is the largest a over these places.
// A ball that was spun up before stands more for a while, at most mu_f g, where a_most is less than that; and nothing is
// held backwards faster than the ball's spun surface runs.
// Cannot: the bar's bending, wear, a ball that sinks in; a mount that turns about a pivot.
#pragma once
#include "sim/robot/ball_handling.h"

namespace omnihil {

struct DribblerStep {
  double omega_bar_rad_s = 0.0;
  double motor_current_A = 0.0;
  double bus_current_A = 0.0;
};
// Exact for a held voltage; the current is limited, duty_ratio 0 … 1 of the bus.
DribblerStep drive_bar(const DribblerModel& dribbler, double omega_bar_rad_s, double duty_ratio,
                       double bus_voltage_V, double step_s);

// Deceleration of the robot up to which a ball is held; 0 where none is. Infinite where friction locks it in.
double held_acceleration_m_s2(const DribblerModel& dribbler, double front_m, double ball_radius_m,
                              double ball_mass_kg, double carpet_friction);

}  // namespace omnihil
