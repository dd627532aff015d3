// What cannot act says why, in words that name what is missing: per drive input and sensors of an axis, and
// per sensors of a robot.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "identify/predict/predictor_axis.h"
#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

Candidate axis_model(const std::string& motor = "", const std::string& load = "") {
  const std::string text = "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = 0.5\n" +
                           motor + "torque_constant_Nm_per_A = 0.03\nrotor_inertia_kg_m2 = 1e-5\n[load]\n" +
                           load + "[supply]\nvoltage_V = 24\n[servo]\nkp_duty_per_rad = 2\n";
  const AxisReading r = read_axis_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

Dataset measured_axis(const std::vector<std::string>& signals) {
  Dataset d;
  for (const std::string& s : signals) d.channels.push_back({.signal = s, .column = "", .unit = ""});
  return d;
}

constexpr const char* kTwoInertias = "inertia_kg_m2 = 2e-5\n";

std::string refusal_of(const char* id, const std::vector<std::string>& signals,
                       const Candidate& model = axis_model("", kTwoInertias)) {
  return refusal(*find_effect(id)->info, axis_capabilities(measured_axis(signals), model));
}

TEST(AxisRefusals, ByWhatDrivesIt) {
  const std::string winding = "needs a drive by duty, voltage or current",
                    supply = "the drive has no supply in these data";
  const std::string duty = "needs a drive by duty", target = "needs a position target",
                    voltage = "needs a winding";
  const std::string measured = "the motion is taken as measured; actuator_delay shows the same lag";
  // by:                        duty    voltage   current   torque    position target
  const std::map<std::string, std::array<std::string, 5>> expected = {
      {"cogging", {"", "", "", "", ""}},
      {"actuator_delay", {"", "", "", "", ""}},
      {"battery_sag", {"", "", supply, supply, ""}},
      {"torque_ripple", {"", "", "", winding, ""}},
      {"dead_time", {"", "", "", winding, ""}},
      {"target_speed_limit", {target, target, target, target, ""}},
      {"duty_limit", {"", duty, duty, duty, ""}},
      {"pwm_dead_band", {"", duty, duty, winding, ""}},
      {"thermal_derating", {"", "", voltage, winding, ""}},
      {"backlash", {"", "", "", "", ""}},
      {"sampling_delay", {"", "", measured, measured, ""}},
      {"encoder_missed_counts", {"", "", measured, measured, ""}},
  };
  const std::array<std::string, 5> inputs = {"duty", "motor_voltage", "motor_current", "motor_torque",
                                             "position_target"};
  for (const auto& [id, refusals] : expected) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      EXPECT_EQ(refusal_of(id.c_str(), {inputs[i], "encoder"}), refusals[i]) << id << " by " << inputs[i];
  }
}

TEST(AxisRefusals, ByWhatIsMeasured) {
  EXPECT_EQ(refusal_of("hall_speed_estimator", {"duty", "encoder"}), "needs a speed that the drive reports");
  EXPECT_EQ(refusal_of("hall_speed_estimator", {"duty", "velocity"}), "");
  EXPECT_EQ(refusal_of("encoder_missed_counts", {"duty", "position"}), "needs an encoder");
  EXPECT_EQ(refusal_of("encoder_eccentricity", {"duty", "position"}), "");
  EXPECT_EQ(refusal_of("encoder_eccentricity", {"duty", "velocity"}), "needs an encoder");
}

TEST(AxisRefusals, ByTheBaseModel) {
  const std::vector<std::string> signals = {"duty", "encoder"};
  EXPECT_EQ(refusal_of("shaft_compliance", signals, axis_model()),
            "needs an inertia on either side of the shaft");
  EXPECT_EQ(refusal_of("winding_inductance", signals, axis_model("inductance_H = 1e-3\n")), "");
  EXPECT_EQ(refusal_of("winding_inductance", signals,
                       axis_model("inductance_H = { value = 1e-3, tolerance = 0.3 }\n")),
            "the base model's motor.inductance_H is free");
  EXPECT_EQ(refusal_of("gravity_load", signals), "");
  EXPECT_EQ(refusal_of("gravity_load", signals, axis_model("", "gravity_torque_Nm = 0.1\n")),
            "the base model has load.gravity_torque_Nm");
}

TEST(AxisRefusals, WhatIsOfARobotActsOnOne) {
  for (const char* id : {"wheel_slip", "payload", "floor_tilt", "vision_delay", "motor_mismatch"})
    EXPECT_EQ(refusal_of(id, {"duty", "encoder"}), "acts on a robot on the floor") << id;
}

std::string robot_refusal(const char* id, const std::vector<std::string>& without = {}) {
  Dataset d = blank_robot(0.1, true);
  std::erase_if(d.channels, [&](const Channel& c) {
    return std::any_of(without.begin(), without.end(),
                       [&](const std::string& w) { return c.signal.starts_with(w); });
  });
  return make_predictor(d, robot_candidate(), {})->applies(*find_effect(id));
}

TEST(RobotRefusals, ByWhatARobotsModelLacks) {
  EXPECT_EQ(robot_refusal("backlash"),
            "needs a freedom between rotor and wheel, which a robot's model lacks");
  EXPECT_EQ(robot_refusal("target_speed_limit"), "needs a position servo");
  EXPECT_EQ(robot_refusal("hall_speed_estimator"), "needs a speed that the drive's electronics estimate");
  for (const char* id : {"cogging", "battery_sag", "duty_limit", "thermal_derating", "winding_inductance",
                         "gravity_load", "sampling_delay", "floor_tilt", "motor_mismatch"}) {
    EXPECT_EQ(robot_refusal(id), "") << id;
  }
}

TEST(RobotRefusals, ByWhatIsMeasured) {
  EXPECT_EQ(robot_refusal("vision_delay"), "");
  EXPECT_EQ(robot_refusal("vision_delay", {"vision"}), "needs a camera");
  EXPECT_EQ(robot_refusal("wheel_slip", {"vision"}), "") << "a gyro is left";
  EXPECT_EQ(robot_refusal("wheel_slip", {"vision", "gyro"}),
            "needs a body's speed: camera, gyro or accelerometer");
  EXPECT_EQ(robot_refusal("dribbler_drag"), "needs the dribbler's speed (channel dribbler)");
  EXPECT_EQ(robot_refusal("encoder_eccentricity"), "");
  EXPECT_EQ(robot_refusal("encoder_eccentricity", {"encoder"}), "needs encoders");
  EXPECT_EQ(robot_refusal("coulomb_friction", {"encoder"}), "");
}

}  // namespace
}  // namespace omnihil::test
