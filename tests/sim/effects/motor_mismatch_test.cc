#include <gtest/gtest.h>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil::test {
namespace {

TEST(MotorMismatch, ScalesTorqueAndBackEmfOfItsWheelAlike) {
  WindingPort<double> port;
  port.wheel = 2;
  port.torque_constant_Nm_per_A = port.back_emf_V_s_per_rad = 0.025;
  const auto out = called("motor_mismatch", {1.1, 1.2, 0.9, 1.3}, port);
  EXPECT_DOUBLE_EQ(out.torque_constant_Nm_per_A, 0.025 * 0.9);
  EXPECT_EQ(out.torque_constant_Nm_per_A, out.back_emf_V_s_per_rad) << "energy is kept";
}

// What a robot of fewer wheels lacks is as the model has it: four numbers and six of which two are neutral are one law.
TEST(MotorMismatch, HasARowForEachWheelThatARobotMayHave) {
  for (const char* id : {"motor_mismatch", "wheel_radius_mismatch"}) {
    const EffectInfo& info = *find_effect(id)->info;
    ASSERT_EQ(info.params.size(), kMaxWheels) << id;
    for (std::size_t i = 0; i < kMaxWheels; ++i) EXPECT_EQ(info.params[i].wheel, static_cast<int>(i) + 1);
    for (std::size_t wheels = kMinWheels; wheels <= kMaxWheels; ++wheels)
      EXPECT_EQ(neutral_use(*find_effect(id), nullptr, wheels).values.size(), wheels);
    EffectUse four = neutral_use(*find_effect(id), nullptr, 4), six = neutral_use(*find_effect(id));
    four.values = {1.1, 0.9, 1.05, 0.97};
    six.values = {1.1, 0.9, 1.05, 0.97, 1.0, 1.0};
    const EffectSet<double> of_four(std::vector{four}), of_six(std::vector{six});
    EXPECT_EQ(std::vector(of_four.values(), of_four.values() + 6),
              std::vector(of_six.values(), of_six.values() + 6));
  }
}

TEST(MotorMismatch, ReachesTheSixthWheel) {
  WindingPort<double> port;
  port.wheel = 5;
  port.torque_constant_Nm_per_A = 0.025;
  EXPECT_DOUBLE_EQ(called("motor_mismatch", {1, 1, 1, 1, 1, 0.9}, port).torque_constant_Nm_per_A, 0.0225);
}

// Signature: the same duty turns the robot; swapped left to right, it turns the other way.
TEST(MotorMismatch, ShowsAsYawDriftThatFollowsTheMotor) {
  const RobotModel m = symmetric_robot();  // wheels 1 and 2 on the left, 3 and 4 mirror them
  const auto yaw = [&](const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    drive_for(plant, forward(m, 0.2), 1.0);
    return plant.truth(0).yaw_rad;
  };
  const double left = yaw({"motor_mismatch.ratio_1=1.05", "motor_mismatch.ratio_2=1.05"});
  const double right = yaw({"motor_mismatch.ratio_4=1.05", "motor_mismatch.ratio_3=1.05"});
  EXPECT_NEAR(yaw({}), 0.0, 1e-9);
  EXPECT_GT(std::abs(left), 0.01);
  EXPECT_NEAR(left, -right, 1e-6);
}

// A motor of a larger constant runs slower at the same voltage.
TEST(MotorMismatch, TurnsTowardsTheStrongerAndSlowerMotorsAtSpeed) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"motor_mismatch.ratio_1=1.05", "motor_mismatch.ratio_2=1.05"});
  drive_for(plant, forward(m, 0.2), 2.0);
  EXPECT_GT(plant.truth(0).omega_body_rad_s, 0.0);  // the left side lags
}

}  // namespace
}  // namespace omnihil::test
