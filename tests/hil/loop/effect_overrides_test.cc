// `--with` for a robot: what it makes of the texts of a model.
#include "hil/loop/effect_overrides.h"

#include <gtest/gtest.h>

#include "sim/law/expression.h"

namespace omnihil {
namespace {

constexpr const char* kFormulas =
    "\n[effects.expression.push]\nadds_to = \"force_x_N\"\nformula = \"f\"\n"
    "f = { value = 0.5, lower = 0, upper = 5, unit = \"N\" }\n"
    "[effects.expression.fan]\nadds_to = \"torque_Nm\"\nformula = \"-a*omega_rotor_rad_s\"\n"
    "a = { value = 2e-7, lower = 0, upper = 1e-5, unit = \"N m s/rad\" }\n"
    "[effects.cogging]\namplitude_Nm = 0.002\n";

ModelBundle robot_with_formulas() {
  ModelBundle bundle = load_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  bundle.robot_text += kFormulas;
  return bundle;
}

double value_in(const ModelBundle& bundle, const std::string& name) {
  const ModelReading reading = read_bundle(bundle);
  EXPECT_TRUE(reading.model.has_value());
  if (!reading.model) return 0.0;
  for (const EffectUse& use : *reading.model->robot->effects) {
    if ((use.name.empty() ? use.entry->info->id : std::string_view(use.name)) == name) return use.values[0];
  }
  ADD_FAILURE() << "no " << name;
  return 0.0;
}

TEST(EffectOverrides, ChangeSeveralFormulasOfOneRobot) {
  ModelBundle bundle = robot_with_formulas();
  std::vector<std::string> faults;
  add_effects(bundle, {"expression.push.f=1.5", "expression.fan.a=3e-7"}, faults);
  EXPECT_TRUE(faults.empty()) << faults[0];
  EXPECT_EQ(value_in(bundle, "push"), 1.5);
  EXPECT_EQ(value_in(bundle, "fan"), 3e-7);
  EXPECT_EQ(value_in(bundle, "cogging"), 0.002);
}

TEST(EffectOverrides, LeaveTheOtherFormulasAlone) {
  ModelBundle bundle = robot_with_formulas();
  std::vector<std::string> faults;
  add_effects(bundle, {"expression.push.f=1.5", "cogging.amplitude_Nm=0.003"}, faults);
  EXPECT_TRUE(faults.empty()) << faults[0];
  EXPECT_EQ(value_in(bundle, "fan"), 2e-7);
  EXPECT_EQ(value_in(bundle, "cogging"), 0.003);
}

TEST(EffectOverrides, NameAFormulaThatIsNotThere) {
  ModelBundle bundle = robot_with_formulas();
  const ModelBundle before = bundle;
  std::vector<std::string> faults;
  add_effects(bundle, {"expression.fun.a=3e-7", "expression.push.g=1"}, faults);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_NE(faults[0].find("did you mean \"fan\"?"), std::string::npos) << faults[0];
  EXPECT_EQ(bundle, before);
}

}  // namespace
}  // namespace omnihil
