#include <gtest/gtest.h>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double age_of(Stamped what, double delay_s, double already_s) {
  TimingPort<double> port;
  port.what = what;
  port.age_s = already_s;
  find_effect("vision_delay")->simulate.timing(nullptr, &delay_s, nullptr, port);
  return port.age_s;
}

TEST(VisionDelay, MakesFramesOlderByItsTime) {
  EXPECT_DOUBLE_EQ(age_of(Stamped::kVision, 0.015, 0.002), 0.017);
}

TEST(VisionDelay, VanishesInTheLimit) { EXPECT_DOUBLE_EQ(age_of(Stamped::kVision, 1e-12, 0.0), 1e-12); }

// Signature, the part that an axis can show: its own sensors are exactly as old as before.
TEST(VisionDelay, LeavesTheDrivesOwnSensorsAlone) {
  EXPECT_EQ(age_of(Stamped::kDriveSensors, 0.015, 0.002), 0.002);
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto with_it = run_axis(small_drive(), with({use_of("vision_delay", {0.015})}), in);
  for (std::size_t n = 0; n < without.size(); ++n) {
    EXPECT_NEAR(with_it[n].position_rad, without[n].position_rad, 1e-9);
  }
}

}  // namespace
}  // namespace omnihil::test
