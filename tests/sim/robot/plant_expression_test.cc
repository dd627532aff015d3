// Formulas that a user writes, in a robot: a force on its body, a torque on its rotors, several at once.
#include <gtest/gtest.h>

#include "sim/model/model_document.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

using test::drive_for;
using test::floor_with;

Plant floor_with_formulas(RobotModel model, const std::string& text, Physics physics = Physics::kPlanar) {
  std::vector<ModelProblem> problems;
  const auto document = parse_document(text, "robot.toml", problems);
  auto uses = read_effects(*document, {}, problems);
  for (const ModelProblem& p : problems) ADD_FAILURE() << p.text();
  model.effects = std::make_shared<const std::vector<EffectUse>>(std::move(uses));
  PlantOptions options = planar_options(500'000);
  options.physics = physics;
  return one_robot(model, options);
}

constexpr const char* kPush =
    "[effects.expression.push]\nadds_to = \"force_x_N\"\nformula = \"f\"\n"
    "f = { value = 0.5, lower = 0, upper = 5, unit = \"N\" }\n";
constexpr const char* kFan =
    "[effects.expression.fan]\nadds_to = \"torque_Nm\"\n"
    "formula = \"-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)\"\n"
    "a = { value = 2e-7, lower = 0, upper = 1e-5, unit = \"N m s2/rad2\" }\n";

// F = (m + sum J (sin a_i / r)^2) dv/dt for a robot that rolls ahead freely, bridges off.
TEST(PlantExpression, PushesTheBody) {
  RobotModel m = frictionless_motor(symmetric_robot());
  m.tyre_lateral.extremum_value = m.tyre_lateral.asymptote_value = 0.0;
  double mass_kg = m.mass_kg;
  const double spin_kg_m2 = m.wheel_inertia_kg_m2 + m.gear_ratio * m.gear_ratio * m.motor.rotor_inertia_kg_m2;
  for (const double a : m.wheel_angle_rad) {
    mass_kg += spin_kg_m2 * std::sin(a) * std::sin(a) / (m.wheel_radius_m * m.wheel_radius_m);
  }
  for (const Physics physics : {Physics::kSimbody, Physics::kPlanar}) {
    Plant plant = floor_with_formulas(m, kPush, physics);
    plant.write(0, RobotDrive{});
    plant.advance(1'000'000'000);
    EXPECT_NEAR(plant.truth(0).v_forward_m_s, 0.5 / mass_kg, 0.01 * 0.5 / mass_kg);
    EXPECT_NEAR(plant.truth(0).v_left_m_s, 0.0, 1e-9);
  }
}

// The same law as a formula and as an effect of the program; that one is solved with the sub-step's end, the
// formula's torque is that of its middle: they differ in second order of 50 us.
TEST(PlantExpression, BrakesTheRotorsAsTheEffectOfTheSameLaw) {
  Plant formula = floor_with_formulas(sample_robot(), kFan);
  Plant effect = floor_with(sample_robot(), {"quadratic_drag.coefficient_Nm_s2_per_rad2=2e-7"});
  Plant without = floor_with(sample_robot(), {});
  for (Plant* plant : {&formula, &effect, &without}) excite(*plant, 0.5);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double expected = effect.truth(0).omega_rotor_rad_s[i];
    EXPECT_NEAR(formula.truth(0).omega_rotor_rad_s[i], expected, 2e-6);
    EXPECT_GT(std::abs(without.truth(0).omega_rotor_rad_s[i] - expected), 1e-3);
  }
}

// Two formulas at two places act both, and each as it does alone: the robot rolls ahead against the fan.
TEST(PlantExpression, ActsTogetherWithOthers) {
  const RobotModel m = symmetric_robot();
  const auto speed_m_s = [&](const std::string& text) {
    Plant plant = floor_with_formulas(m, text);
    drive_for(plant, test::forward(m, 0.3), 0.5);
    return plant.truth(0).v_forward_m_s;
  };
  const std::string both = std::string(kPush) + kFan;
  EXPECT_GT(speed_m_s(both), speed_m_s(kFan) + 1e-3);
  EXPECT_LT(speed_m_s(both), speed_m_s(kPush) - 1e-3);
}

}  // namespace
}  // namespace omnihil
