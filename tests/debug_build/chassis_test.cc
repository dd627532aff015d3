// The multibody model in a Debug build. The rest of the tests are a Release build, where the same model is
// stepped with NDEBUG around it; here every file is compiled without NDEBUG and without optimisation.
#include "sim/robot/chassis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/robot/integrate.h"
#include "sim/robot/planar.h"
#include "tests/sim/robot/sample_robot.h"

#ifdef NDEBUG
#error "this program is there to be compiled without NDEBUG"
#endif

namespace omnihil {
namespace {

TEST(DebugBuild, TheMultibodyModelAcceleratesAsTheClosedFormDoes) {
  const std::vector<RobotModel> robots{sample_robot(), symmetric_robot()};
  Chassis chassis(robots, Chassis::Joint::kPlanar);
  PlanarMechanics planar(robots);
  std::vector<double> q(14), u(14), of_chassis(14), of_planar(14);
  for (int step = 0; step < 20; ++step) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = std::sin(1.7 * static_cast<double>(i) + 0.3 * step);
      u[i] = 3.0 * std::cos(0.9 * static_cast<double>(i) - 0.2 * step);
    }
    std::vector<WheelTorques> torques(robots.size());
    for (WheelTorques& robot : torques)
      for (WheelTorque& wheel : robot) wheel.torque_Nm = {0.02, 0.02, 0.02, 0.02};
    chassis.set_state(q, u);
    planar.set_state(q, u);
    chassis.accelerations(torques, StepPart::kHeld, of_chassis);
    planar.accelerations(torques, StepPart::kHeld, of_planar);
    for (std::size_t i = 0; i < u.size(); ++i) {
      EXPECT_NEAR(of_chassis[i], of_planar[i], 1e-9 * (1.0 + std::abs(of_planar[i]))) << "speed " << i;
    }
  }
}

TEST(DebugBuild, TheFreeBodyStandsOnItsWheels) {
  Chassis chassis({sample_robot()}, Chassis::Joint::kFree);
  std::vector<double> q(11), u(10), udot(10);
  chassis.place(q, u, 0, 1.0, 2.0, 0.5);
  chassis.set_state(q, u);
  double load_N = 0.0;
  for (double wheel_N : chassis.contacts(0).load_N) load_N += wheel_N;
  chassis.accelerations({WheelTorques{}}, StepPart::kHeld, udot);
  EXPECT_NEAR(load_N, sample_robot().mass_kg * 9.81, 0.02 * load_N);
  EXPECT_TRUE(std::isfinite(udot[0]));
}

}  // namespace
}  // namespace omnihil
