#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(DutyLimit, TurnsFullDutyIntoWhatIsLeft) {
  const auto effects = with({use_of("duty_limit", {0.25})});
  for (const double sign : {1.0, -1.0}) {
    const auto cut = run_axis(small_drive(), effects, held(CommandKind::kDuty, sign, 2.0)).back();
    const auto asked = run_axis(small_drive(), nothing(), held(CommandKind::kDuty, 0.75 * sign, 2.0)).back();
    EXPECT_NEAR(cut.omega_rotor_rad_s, asked.omega_rotor_rad_s, 1e-9);
  }
}

TEST(DutyLimit, ChangesNothingBelow) {
  const AxisInput in = excite(Excitation::kSteps, 0.74, 2.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto limited = run_axis(small_drive(), with({use_of("duty_limit", {0.25})}), in);
  for (std::size_t n = 0; n < limited.size(); ++n) {
    EXPECT_NEAR(limited[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s, 1e-9);
  }
}

TEST(DutyLimit, LeavesALowerLimitOfTheModelInPlace) {
  DriveParams<double> p = small_drive();
  p.duty_limit_ratio = 0.5;
  const auto limited =
      run_axis(p, with({use_of("duty_limit", {0.25})}), held(CommandKind::kDuty, 1.0, 1.0)).back();
  const auto model = run_axis(p, nothing(), held(CommandKind::kDuty, 1.0, 1.0)).back();
  EXPECT_NEAR(limited.omega_rotor_rad_s, model.omega_rotor_rad_s, 1e-9);
}

// Signature: on a ramp the speed stops rising at one duty; it then does not differ from full duty's.
TEST(DutyLimit, ShowsAsASpeedThatIsFlatAboveADuty) {
  const AxisInput in = excite(Excitation::kRamp, 1.0, 16.0);
  const auto out = run_axis(small_drive(), with({use_of("duty_limit", {0.25})}), in);
  const auto without = run_axis(small_drive(), nothing(), in);
  std::size_t top = 0;
  while (in.command[top + 1] > in.command[top]) ++top;  // full duty
  std::size_t before = top;
  while (in.command[before] > 0.93) --before;  // settled behind the limit
  EXPECT_NEAR(out[before].omega_rotor_rad_s, out[top].omega_rotor_rad_s, 1e-3 * out[top].omega_rotor_rad_s);
  EXPECT_GT(without[top].omega_rotor_rad_s, 1.05 * without[before].omega_rotor_rad_s);
}

}  // namespace
}  // namespace omnihil::test
