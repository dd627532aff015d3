#include "sim/full_wheel/wheel_comparison.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/chassis.h"
#include "sim/robot/geometry.h"
#include "sim/robot/integrate.h"
#include "sim/robot/planar.h"

namespace omnihil {
namespace {

constexpr double kEvery_s = 0.01;

template <typename Back>
WheelRun run_back(Back& back, const RobotModel& model, const WheelManoeuvre& m, double step_s) {
  const StateLayout& layout = back.layout();
  std::vector<double> q(layout.q_per_robot), u(layout.u_per_robot);
  back.place(q, u, 0, 0.0, 0.0, 0.0);
  IntegratorScratch scratch(q.size(), u.size());
  std::vector<WheelTorques> torques(1);
  WheelRun run;
  double next_s = 0.0;
  const double k = model.motor.torque_constant_Nm_per_A, r_ohm = model.motor.resistance_ohm;
  for (double now_s = 0.0; now_s < m.duration_s - 0.5 * step_s; now_s += step_s) {
    if (now_s >= next_s - 1e-9) {
      run.at.push_back({q[1], q[2], q[0], u[1], u[2], u[0]});
      next_s += kEvery_s;
    }
    const auto volt = m.volt(now_s);
    for (std::size_t i = 0; i < kWheels; ++i) {
      torques[0][i].torque_Nm.fill(k * volt[i] / r_ohm);
      torques[0][i].omega_rad_s.fill(0.0);
      torques[0][i].slope_Nm_s_per_rad = k * k / r_ohm;
    }
    back.set_state(q, u);
    step_runge_kutta_4(back, torques, step_s, q, u, scratch);
  }
  run.at.push_back({q[1], q[2], q[0], u[1], u[2], u[0]});
  return run;
}

}  // namespace

std::vector<WheelManoeuvre> wheel_manoeuvres(const RobotModel& model) {
  const WheelGeometry<double> g = wheel_geometry(model);
  // The voltages that hold these speeds without load, ramped over `rise`.
  const auto drive = [&model, g](double vx, double vy, double w, double rise_s) {
    return [=](double t) {
      const double part = std::min(1.0, t / rise_s);
      const auto omega = wheel_speeds(g, BodyVelocity<double>{part * vx, part * vy, part * w});
      std::array<double, kWheels> volt{};
      for (std::size_t i = 0; i < kWheels; ++i)
        volt[i] = std::clamp(omega[i] * model.gear_ratio * model.motor.torque_constant_Nm_per_A,
                             -model.bus_voltage_V, model.bus_voltage_V);
      return volt;
    };
  };
  const auto curve = [drive](double t) {
    return drive(1.2 * std::cos(2.0 * t), 0.8 * std::sin(3.0 * t), 2.0 * std::sin(1.5 * t), 0.5)(t);
  };
  const auto hard = [&model, g](double t) {
    const auto omega = wheel_speeds(g, BodyVelocity<double>{t < 0.5 ? 1.0 : -1.0, 0.0, 0.0});
    std::array<double, kWheels> volt{};
    for (std::size_t i = 0; i < kWheels; ++i)
      volt[i] = (t < 1.0 ? 0.6 : 0.0) * std::copysign(model.bus_voltage_V, omega[i]);
    return volt;
  };
  return {{"forward", 1.5, drive(1.5, 0, 0, 0.5)},
          {"sideways", 1.5, drive(0, 1.2, 0, 0.5)},
          {"diagonal", 1.5, drive(0.9, 0.9, 0, 0.5)},
          {"turn", 1.5, drive(0, 0, 8.0, 0.5)},
          {"curve", 3.0, curve},
          {"hard start", 1.5, hard}};
}

WheelRun run_full_wheel(const RobotModel& model, const RollerParams& rollers, const WheelManoeuvre& m,
                        double step_s) {
  FullWheelRobot robot(model, rollers);
  WheelRun run;
  double next_s = 0.0;
  for (double now_s = 0.0; now_s < m.duration_s - 0.5 * step_s; now_s += step_s) {
    if (now_s >= next_s - 1e-9) {
      run.at.push_back(robot.state());
      next_s += kEvery_s;
    }
    robot.set_volts(m.volt(now_s));
    robot.advance(step_s);
  }
  run.at.push_back(robot.state());
  return run;
}

WheelRun run_simplified(const RobotModel& model, const WheelManoeuvre& m, Physics physics, double step_s) {
  const std::vector<RobotModel> robots{model};
  if (physics == Physics::kPlanar) {
    PlanarMechanics back(robots);
    return run_back(back, model, m, step_s);
  }
  Chassis back(robots, Chassis::Joint::kPlanar);
  return run_back(back, model, m, step_s);
}

WheelDifference difference_of(const WheelRun& full, const WheelRun& simplified) {
  WheelDifference d;
  const std::size_t n = std::min(full.at.size(), simplified.at.size());
  double sum2 = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const PlanarState &a = full.at[k], &b = simplified.at[k];
    const double off = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
    sum2 += off * off;
    d.end_m = off;
    d.end_rad = b.yaw_rad - a.yaw_rad;
    if (k == 0) continue;
    d.way_m += std::hypot(a.x_m - full.at[k - 1].x_m, a.y_m - full.at[k - 1].y_m);
    d.turned_rad += std::abs(a.yaw_rad - full.at[k - 1].yaw_rad);
  }
  d.rms_m = n > 0 ? std::sqrt(sum2 / static_cast<double>(n)) : 0.0;
  return d;
}

}  // namespace omnihil
