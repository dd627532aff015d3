#include "sim/robot/geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

RobotModel crossed_robot() {  // four wheels on the axes: hand values
  RobotModel m = sample_robot();
  m.wheel_angle_rad = {0.0, 90 * kDegree, 180 * kDegree, 270 * kDegree};
  m.wheel_center_radius_m = 0.08;
  m.wheel_radius_m = 0.025;
  return m;
}

TEST(Geometry, WheelAtTheFrontTurnsOnlyByLeftwardMotionAndYaw) {
  const auto g = wheel_geometry(crossed_robot());
  EXPECT_NEAR(wheel_speeds<double>(g, {1.0, 0.0, 0.0})[0], 0.0, 1e-12);
  EXPECT_NEAR(wheel_speeds<double>(g, {0.0, 1.0, 0.0})[0], 1.0 / 0.025, 1e-12);
  EXPECT_NEAR(wheel_speeds<double>(g, {0.0, 0.0, 1.0})[0], 0.08 / 0.025, 1e-12);
}

TEST(Geometry, ForwardMotionTurnsTheLeftWheelBackwardsAndTheRightWheelForwards) {
  const auto w = wheel_speeds<double>(wheel_geometry(crossed_robot()), {1.0, 0.0, 0.0});
  EXPECT_NEAR(w[1], -1.0 / 0.025, 1e-12);  // at the left, its positive direction points backwards
  EXPECT_NEAR(w[3], 1.0 / 0.025, 1e-12);
}

TEST(Geometry, WheelRadiusAndMountingRadiusAreTwoNumbers) {
  RobotModel m = crossed_robot();
  const auto spin = wheel_speeds<double>(wheel_geometry(m), {0.0, 0.0, 1.0})[0];
  m.wheel_radius_m *= 2.0;
  EXPECT_NEAR(wheel_speeds<double>(wheel_geometry(m), {0.0, 0.0, 1.0})[0], spin / 2.0, 1e-12);
  m.wheel_center_radius_m *= 2.0;
  EXPECT_NEAR(wheel_speeds<double>(wheel_geometry(m), {0.0, 0.0, 1.0})[0], spin, 1e-12);
}

TEST(Geometry, FourWheelsSpanThreeSpeeds) {
  const auto m = rim_matrix(wheel_geometry(sample_robot()));
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(m).rank(), 3);
}

TEST(Geometry, BodyVelocityUndoesWheelSpeedsForAnyAngles) {
  for (double skew_deg : {0.0, 7.0, -11.0}) {
    RobotModel m = sample_robot();
    m.wheel_angle_rad[1] += skew_deg * kDegree;
    const auto g = wheel_geometry(m);
    const auto v = body_velocity(g, wheel_speeds<double>(g, {1.3, -0.4, 5.0}));
    EXPECT_NEAR(v.v_forward_m_s, 1.3, 1e-12);
    EXPECT_NEAR(v.v_left_m_s, -0.4, 1e-12);
    EXPECT_NEAR(v.omega_body_rad_s, 5.0, 1e-11);
  }
}

TEST(Geometry, WheelsThatContradictEachOtherLeaveTheLeastSquaresResidual) {
  const auto g = wheel_geometry(sample_robot());
  const PerWheel<double> omega{10.0, -3.0, 4.0, 20.0};
  const auto v = body_velocity(g, omega);
  const auto fitted = wheel_speeds(g, v);
  const auto m = rim_matrix(g);
  for (int column = 0; column < 3; ++column) {  // the residual is orthogonal to every column
    double product = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) {
      product += m(static_cast<Eigen::Index>(i), column) * (omega[i] - fitted[i]);
    }
    EXPECT_NEAR(product, 0.0, 1e-11);
  }
}

}  // namespace
}  // namespace omnihil
