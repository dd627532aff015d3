// A robot's arm instead of a robot's wheel: hundreds of times the torque that the catalogue's usual sizes are of.
#include <gtest/gtest.h>

#include <algorithm>

#include "identify/select/diagnosis.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// Directly driven, 2.5 kg m2 and 40 N m of torque; its model knows neither gravity nor dry friction.
constexpr const char* kArmModel =
    "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\n"
    "rotor_inertia_kg_m2 = { value = 2.5, tolerance = 0.1 }\n"
    "viscous_friction_Nm_s_per_rad = { value = 3.0, tolerance = 1.0 }\n";

TEST(SlowStrongDrive, GravityAndFrictionOfAnArmAreNamed) {
  BenchRecipe recipe;
  recipe.drive = CommandKind::kMotorTorque;
  recipe.drive_name = "motor_torque";
  recipe.amplitude = 40.0;
  recipe.with = {"gravity_load.torque_Nm=30", "coulomb_friction.torque_Nm=9"};
  recipe.excitations = {Excitation::kSteps, Excitation::kPrbs, Excitation::kSteps};
  recipe.duration_s = 6.0;
  recipe.counts_per_turn = 65536.0;
  recipe.model = kArmModel;
  const Bench bench = simulated_bench(recipe);
  EXPECT_GT(bench.nominal.torque_scale, 100.0);  // what read_dataset() found
  DiagnoseOptions options;
  options.jobs = 1;
  const Diagnosis d = diagnose(bench.dataset, bench.nominal, options);
  std::string why;
  for (const RankedEffect& r : d.ranking) why += r.effect + ": " + r.why + "\n";
  for (const char* name : {"gravity_load", "coulomb_friction"})
    EXPECT_NE(std::find(d.effects.begin(), d.effects.end(), name), d.effects.end()) << name << "\n" << why;
}

}  // namespace
}  // namespace omnihil
