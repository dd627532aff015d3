// Lost commands beside an effect that hides which they were: decided once more when it is found.
#include <gtest/gtest.h>

#include "identify/select/diagnosis.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil::test {
namespace {

// One motor with seven tenths of its torque constant: by the base model two of the five lost commands are found, and the
// wheels' speeds are left at 2.2 times their noise when the effect is.
TEST(SlowRadioDiagnosis, LostCommandsAreDecidedOnceMoreByTheModelWithItsEffects) {
  const std::vector<std::size_t> lost = {40, 77, 78, 131, 205};
  Candidate truth = with_effect(radio_candidate(), *find_effect("motor_mismatch"));
  ASSERT_EQ(set_value(truth, "motor_mismatch.ratio_1", 0.7), "");
  const Dataset d = measured_without(with_quiet_wheels(staircase(5.0)), lost, truth);
  DiagnoseOptions options;
  options.max_effects = 1;
  const Diagnosis found = diagnose(d, radio_candidate(), options);
  EXPECT_EQ(found.effects, std::vector<std::string>{"motor_mismatch"});
  std::vector<double> counts;
  for (const DataFinding& f : found.findings)
    if (f.kind == "lost_commands") counts.push_back(f.size);
  EXPECT_EQ(counts, (std::vector<double>{5.0, 5.0}));
  EXPECT_EQ(found.ladder.back().added, "lost commands decided anew");
  EXPECT_NEAR(found.final_comparison.pooled(Split::kTraining), 1.0, 0.05);
  EXPECT_NEAR(found.final_comparison.pooled(Split::kValidation), 1.0, 0.05);
}

}  // namespace
}  // namespace omnihil::test
