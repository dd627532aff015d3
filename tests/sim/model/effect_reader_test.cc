#include "sim/model/effect_reader.h"

#include <gtest/gtest.h>

#include "sim/model/axis_model.h"
#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr std::string_view kBase = R"(format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = 0.464
torque_constant_Nm_per_A = 0.0335
pole_pairs = 8
slots = 12
rotor_inertia_kg_m2 = 1.35e-5
[supply]
voltage_V = 24.0
)";

AxisReading read(const std::string& effects) {
  return read_axis_model(std::string(kBase) + effects, "bench.toml", nullptr);
}

TEST(EffectReader, ReadsBareAndAnnotatedNumbersAndStartsShapesFromTheMotor) {
  const AxisReading r = read(
      "[effects.cogging]\namplitude_Nm = { value = 0.004, tolerance = 0.5, source = \"map\" }\n"
      "[effects.dead_time]\nvoltage_V = 0.3\n");
  ASSERT_TRUE(r.model) << (r.problems.empty() ? "" : r.problems.front().text());
  ASSERT_EQ(r.model->effects.size(), 2u);
  EXPECT_EQ(r.model->effects[0].values[0], 0.004);
  EXPECT_EQ(r.model->effects[0].tolerances[0], 0.5);
  EXPECT_EQ(r.model->effects[0].values[1], 48.0);
  EXPECT_EQ(r.model->effects[1].values[0], 0.3);
}

TEST(EffectReader, ReportsEveryProblemWithItsPlace) {
  const AxisReading r = read(
      "[effects.coging]\namplitude_Nm = 1\n"
      "[effects.dead_time]\nvoltage = 0.3\ncurrent_width_A = -1\n"
      "[effects.actuator_delay]\ndelay_s = \"long\"\n");
  EXPECT_FALSE(r.model);
  ASSERT_EQ(r.problems.size(), 4u);
  std::string all;
  for (const ModelProblem& p : r.problems) all += p.text() + "\n";
  EXPECT_NE(all.find("bench.toml:11:"), std::string::npos) << all;
  EXPECT_NE(all.find("did you mean \"cogging\"?"), std::string::npos) << all;
  EXPECT_NE(all.find("did you mean \"voltage_V\"?"), std::string::npos) << all;
  EXPECT_NE(all.find("0.001 to 10 A"), std::string::npos) << all;
  EXPECT_NE(all.find("a number is needed"), std::string::npos) << all;
}

TEST(EffectReader, ReportsProblemsOfBaseAndEffectsTogether) {
  const AxisReading r = read_axis_model(
      "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = -1\n"
      "torque_constant_Nm_per_A = 0.03\nrotor_inertia_kg_m2 = 0\n[effects.dead_time]\nvoltage_V = -1\n",
      "bad.toml", nullptr);
  EXPECT_FALSE(r.model);
  EXPECT_GE(r.problems.size(), 3u);
}

TEST(EffectReader, UsesLinearNamesOnALinearAxis) {
  const std::string text =
      "format = \"omnihil-model/1\"\nrig = \"axis\"\nlinear = true\n[load]\nmass_kg = 95\n[motor]\n"
      "viscous_friction_N_s_per_m = 200\n[effects.coulomb_friction]\ntorque_N = 20\n";
  const AxisReading r = read_axis_model(text, "emps.toml", nullptr);
  ASSERT_TRUE(r.model) << (r.problems.empty() ? "" : r.problems.front().text());
  EXPECT_EQ(r.model->drive.load_inertia_kg_m2, 95.0);
  EXPECT_EQ(r.model->effects.at(0).values[0], 20.0);
}

TEST(EffectReader, TakesOverridesFromACommandLine) {
  std::vector<EffectUse> uses;
  const DriveParams<double> drive = small_drive();
  const EffectContext context{.drive = &drive};
  EXPECT_EQ(add_override("cogging.amplitude_Nm=0.002", context, uses), "");
  EXPECT_EQ(add_override("cogging.phase_rad=1", context, uses), "");
  EXPECT_EQ(add_override("actuator_delay", context, uses), "");
  ASSERT_EQ(uses.size(), 2u);
  EXPECT_EQ(uses[0].values[0], 0.002);
  EXPECT_EQ(uses[0].values[2], 1.0);
  EXPECT_EQ(uses[1].values[0], find_effect("actuator_delay")->info->params[0].typical);
}

TEST(EffectReader, RefusesOverridesWithAReason) {
  std::vector<EffectUse> uses;
  EXPECT_NE(add_override("coging.amplitude_Nm=1", {}, uses).find("cogging"), std::string::npos);
  EXPECT_NE(add_override("cogging.amplitud_Nm=1", {}, uses).find("amplitude_Nm"), std::string::npos);
  EXPECT_NE(add_override("actuator_delay.delay_s=9", {}, uses).find("0 to 0.1 s"), std::string::npos);
  EXPECT_NE(add_override("actuator_delay.delay_s=1ms", {}, uses).find("not a number"), std::string::npos);
  EXPECT_NE(add_override("actuator_delay=1", {}, uses), "");
  EXPECT_TRUE(uses.empty());
}

constexpr const char* kKiwi = R"(
format = "omnihil-model/1"
rig = "robot"
[motor]
resistance_ohm = 0.464
inductance_H = 0.0003
torque_constant_Nm_per_A = 0.0335
rotor_inertia_kg_m2 = 1.35e-5
[gear]
ratio = 3.0
[supply]
voltage_V = 22.2
[robot]
mass_kg = 2.4
yaw_inertia_kg_m2 = 0.012
center_of_mass_height_m = 0.045
wheel_center_radius_m = 0.0805
wheel_radius_m = 0.027
wheel_inertia_kg_m2 = 2.2e-5
wheel_angle_deg = [150, 270, 30]
[effects.motor_mismatch]
ratio_1 = 0.93
)";

TEST(EffectReader, RefusesANumberOfAWheelThatTheRobotLacks) {
  const ModelReading good = read_model(kKiwi, "kiwi.toml", nullptr);
  for (const ModelProblem& p : good.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(good.model);
  EXPECT_EQ(good.model->robot->effects->front().values, (std::vector{0.93, 1.0, 1.0}));
  EXPECT_EQ(write_effects(*good.model->robot->effects, false),
            "\n[effects.motor_mismatch]\nratio_1 = 0.93\nratio_2 = 1\nratio_3 = 1\n");

  const ModelReading bad = read_model(std::string(kKiwi) + "ratio_4 = 1.1\n", "kiwi.toml", nullptr);
  ASSERT_EQ(bad.problems.size(), 1u);
  EXPECT_EQ(bad.problems[0].text(),
            "kiwi.toml:23:1: effects.motor_mismatch.ratio_4: is of wheel 4, and the robot has 3; "
            "allowed: ratio_1, ratio_2, ratio_3");
  std::vector<EffectUse> uses;
  const std::string fault = add_override("motor_mismatch.ratio_4=1.1", {.wheels = 3}, uses);
  EXPECT_NE(fault.find("is of wheel 4, and the robot has 3"), std::string::npos) << fault;
  EXPECT_EQ(add_override("wheel_radius_mismatch", {.wheels = 3}, uses), "");
  EXPECT_EQ(uses.at(0).values.size(), 3u);
}

TEST(EffectReader, ReadsBackWhatItWrites) {
  std::vector<EffectUse> uses{use_of("cogging", {0.0031, 48, 0.1}), use_of("dead_time", {0.1 + 0.2, 0.2})};
  const AxisReading r = read(write_effects(uses, false));
  ASSERT_TRUE(r.model) << (r.problems.empty() ? "" : r.problems.front().text());
  EXPECT_EQ(r.model->effects[0].values, uses[0].values);
  EXPECT_EQ(r.model->effects[1].values, uses[1].values);
}

}  // namespace
}  // namespace omnihil::test
