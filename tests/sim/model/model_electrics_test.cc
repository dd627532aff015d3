// The electrics of a robot's model file: drive, bridge, sensors, battery, heat; neutral when not named.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "sim/model/model_file.h"
#include "sim/robot/electric_model.h"

namespace omnihil {
namespace {

constexpr const char* kMotor = R"(format = "omnihil-model/1"
rig = "motor"
[motor]
resistance_ohm = 1.2
inductance_H = 4e-4
torque_constant_Nm_per_A = 0.0255
rotor_inertia_kg_m2 = 9e-6
pole_pairs = 8
back_emf = "trapezoid"
[thermal]
winding_to_housing_K_per_W = 4.57
housing_to_ambient_K_per_W = 7.0
winding_time_constant_s = 13
housing_time_constant_s = 250
[hall]
mounting_error_deg = 6
offset_3_deg = -3
)";

const std::string kRobot = R"(format = "omnihil-model/1"
rig = "robot"
[motor]
file = "m.toml"
[supply]
voltage_V = 24
[robot]
mass_kg = 2.5
yaw_inertia_kg_m2 = 0.012
center_of_mass_height_m = 0.045
wheel_center_radius_m = 0.08
wheel_radius_m = 0.027
wheel_inertia_kg_m2 = 2.2e-5
wheel_angle_deg = [45, 135, 225, 315]
)";

ModelReading read(const std::string& more) {
  return read_model(kRobot + more, "r.toml", [](const std::string& file) {
    return MotorFileText{file, kMotor, ""};
  });
}

TEST(ModelElectrics, SayNothingUnlessTheyAreNamed) {
  const ModelReading r = read("[thermal]\nwinding_to_housing_K_per_W = 0\n");
  ASSERT_TRUE(r.model.has_value()) << r.problems.at(0).text();
  EXPECT_FALSE(electrics_of(*r.model->robot).any());
  EXPECT_EQ(r.model->robot->motor_loop, MotorLoop::kDuty);
  EXPECT_EQ(r.model->parameters.find("drive.kind")->text, "dc");
}

TEST(ModelElectrics, AreReadFromTheRobotsAndTheMotorsFile) {
  const ModelReading r = read(R"([drive]
kind = "switched"
pwm_frequency_Hz = 40000
pwm_mode = "fast_decay"
dead_time_s = { value = 5e-7, source = "driver's register" }
[battery]
cells = 6
capacity_Ah = 2.2
charge_ratio = 0.9
[current_sensor]
place = "low_side"
bits = 12
[firmware]
motor_loop = "six_step"
)");
  ASSERT_TRUE(r.model.has_value()) << r.problems.at(0).text();
  const RobotModel& robot = *r.model->robot;
  const ElectricModel& e = electrics_of(robot);
  EXPECT_EQ(e.kind, DriveKind::kSwitched);
  EXPECT_EQ(e.inverter.pwm_frequency_Hz, 40e3);
  EXPECT_EQ(e.inverter.dead_time_s, 5e-7);
  EXPECT_EQ(e.pwm_mode, PwmMode::kFastDecay);
  EXPECT_EQ(e.back_emf.shape, BackEmfShape::kTrapezoid);
  EXPECT_DOUBLE_EQ(e.back_emf.flat_top_rad, 2.0 * std::numbers::pi / 3.0);
  EXPECT_EQ(e.battery.capacity_C, 2.2 * 3600);
  EXPECT_EQ(e.battery_charge_ratio, 0.9);
  EXPECT_TRUE(e.battery.takes_charge);
  EXPECT_EQ(e.current_sensor.place, ShuntPlace::kLowSide);
  EXPECT_EQ(e.current_sensor.bits, 12);
  EXPECT_TRUE(e.has_heat());
  EXPECT_DOUBLE_EQ(e.hall.mounting_error_rad, 6 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(e.hall.sensor_offset_rad[2], -3 * std::numbers::pi / 180);
  EXPECT_EQ(robot.motor_loop, MotorLoop::kSixStep);
  EXPECT_NEAR(phase_motor(robot).resistance_ohm, 0.6, 1e-15);
}

TEST(ModelElectrics, MisspeltWordsAreNamedWithTheNearestAndAllAtOnce) {
  const ModelReading r = read(R"([drive]
kind = "switchd"
pwm_mod = "fast_decay"
[batery]
cells = 6
[firmware]
motor_loop = "sixstep"
)");
  std::string all;
  for (const ModelProblem& p : r.problems) all += p.text() + "\n";
  ASSERT_EQ(r.problems.size(), 4u) << all;
  for (const char* words :
       {"drive.kind = \"switchd\": is not a choice; allowed: \"dc\", \"dq\", \"switched\"; did you mean "
        "\"switched\"?",
        "drive.pwm_mod: unknown key; did you mean \"pwm_mode\"?", "did you mean \"battery\"?",
        "did you mean \"six_step\"?"}) {
    EXPECT_NE(all.find(words), std::string::npos) << words << " in\n" << all;
  }
}

TEST(ModelElectrics, NumbersThatContradictEachOtherAreAllNamedAtTheirPlace) {
  const ModelReading r = read(R"([drive]
kind = "dq"
pwm_frequency_Hz = 200000
[battery]
cells = 6
refuses_charge = true
)");
  std::string all;
  for (const ModelProblem& p : r.problems) all += p.text() + "\n";
  ASSERT_EQ(r.problems.size(), 3u) << all;
  EXPECT_NE(all.find("m.toml:9:12: motor.back_emf"), std::string::npos) << all;
  EXPECT_NE(all.find("drive.pwm_frequency_Hz = 200000: must be 8000 to 100000"), std::string::npos) << all;
  EXPECT_NE(all.find("battery.refuses_charge"), std::string::npos) << all;
}

TEST(ModelElectrics, AFirmwareForPhasesNeedsThem) {
  const ModelReading r = read("[firmware]\nmotor_loop = \"foc\"\n");
  ASSERT_EQ(r.problems.size(), 1u);
  EXPECT_NE(r.problems[0].text().find("firmware.motor_loop"), std::string::npos);
  EXPECT_NE(r.problems[0].text().find("drive.kind must be"), std::string::npos);
}

}  // namespace
}  // namespace omnihil
