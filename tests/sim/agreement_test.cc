// The closed form against Simbody: mass matrix, velocity forces and trajectories.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/robot/chassis.h"
#include "sim/robot/planar_law.h"
#include "tests/sim/sample_robot.h"

namespace omnihil {
namespace {

// Largest difference of any true quantity of two plants, in its own SI unit.
double largest_difference(const Plant& a, const Plant& b) {
  double worst = 0.0;
  const auto note = [&](double x, double y) { worst = std::max(worst, std::abs(x - y)); };
  for (int n = 0; n < a.robot_count(); ++n) {
    const RobotTruth p = a.truth(n), s = b.truth(n);
    note(p.x_m, s.x_m);
    note(p.y_m, s.y_m);
    note(p.yaw_rad, s.yaw_rad);
    note(p.v_forward_m_s, s.v_forward_m_s);
    note(p.v_left_m_s, s.v_left_m_s);
    note(p.omega_body_rad_s, s.omega_body_rad_s);
    for (std::size_t i = 0; i < kWheels; ++i) {
      note(p.omega_wheel_rad_s[i], s.omega_wheel_rad_s[i]);
      note(p.theta_rotor_rad[i], s.theta_rotor_rad[i]);
      note(p.motor_current_A[i], s.motor_current_A[i]);
      note(p.load_N[i], s.load_N[i]);
    }
  }
  return worst;
}

class Agreement : public testing::TestWithParam<Integrator> {};

TEST_P(Agreement, PlanarIsSimbodyWithin1e9OverTenSecondsOfHardDriving) {
  for (const RobotModel& model : {sample_robot(), symmetric_robot()}) {
    PlantOptions options = planar_options(1'000'000, GetParam());
    Plant planar = one_robot(model, options);
    options.physics = Physics::kSimbody;
    Plant simbody = one_robot(model, options);
    double worst = 0.0, fastest_m_s = 0.0, largest_slip = 0.0;
    for (int ms = 0; ms < 10'000; ms += 10) {
      drive_wildly(planar, 0.010);
      drive_wildly(simbody, 0.010);
      worst = std::max(worst, largest_difference(planar, simbody));
      const RobotTruth t = planar.truth(0);
      fastest_m_s = std::max(fastest_m_s, std::hypot(t.v_forward_m_s, t.v_left_m_s));
      for (double slip : t.slip_longitudinal_ratio) largest_slip = std::max(largest_slip, std::abs(slip));
    }
    EXPECT_LT(worst, 1e-9) << model.name;
    EXPECT_GT(fastest_m_s, 1.0) << "the drive was not hard";
    EXPECT_GT(largest_slip, model.tyre_longitudinal.extremum_slip) << "no wheel slipped past the extremum";
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Agreement,
                         testing::Values(Integrator::kSemiImplicitEuler, Integrator::kRungeKutta4),
                         [](const auto& test) {
                           return test.param == Integrator::kRungeKutta4 ? "RungeKutta4"
                                                                         : "SemiImplicitEuler";
                         });

}  // namespace
}  // namespace omnihil
