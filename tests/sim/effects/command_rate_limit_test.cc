#include <gtest/gtest.h>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// Duty from 0 to 0.5 at 0.05 s, bus 12 V, rotor held: the voltage of each period is that of the ramp.
std::vector<double> voltages(double inverse_rate_s, double loop_period_s = 0.0) {
  AxisInput in = held(CommandKind::kDuty, 0.0, 0.3);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 0.0);
  for (std::size_t n = 50; n < in.command.size(); ++n) in.command[n] = 0.5;
  std::vector<double> volts;
  const EffectUse limit = use_of("command_rate_limit", {inverse_rate_s, loop_period_s});
  for (const auto& s : run_axis(small_drive(), with({limit}), in)) volts.push_back(s.motor_voltage_V);
  return volts;
}

TEST(CommandRateLimit, RampsAStepAtItsRate) {
  const double inverse_rate_s = 0.2;  // 0.1 s for half a duty
  const std::vector<double> volts = voltages(inverse_rate_s);
  for (std::size_t n = 51; n <= 150; ++n) {
    const double middle_s = (static_cast<double>(n) - 50.5) * 1e-3;
    EXPECT_NEAR(volts[n], 12.0 * middle_s / inverse_rate_s, 1e-9) << n;
  }
  for (std::size_t n = 152; n < volts.size(); ++n) EXPECT_NEAR(volts[n], 6.0, 1e-9) << n;
}

// A ramp that ends within a sub-step loses what it lacks, so that the strength has a derivative at neutral.
TEST(CommandRateLimit, LosesTheTriangleOfAShortRamp) {
  const double inverse_rate_s = 40e-6;  // 20 us for half a duty, less than a sub-step
  const std::vector<double> volts = voltages(inverse_rate_s), plain = voltages(0.0);
  // mean over 1 ms lacks 1/2 * 20 us * 6 V
  EXPECT_NEAR(plain[51] - volts[51], 0.5 * 20e-6 * 6.0 / 1e-3, 1e-9);
  EXPECT_NEAR(volts[52], plain[52], 1e-12);
}

// Firmware that ramps once a row: y += min(u - y, P / q), held until the next row.
TEST(CommandRateLimit, OfALoopIsThatOfItsStepsInTheMean) {
  const double inverse_rate_s = 0.2, period_s = 1e-3;
  const std::vector<double> volts = voltages(inverse_rate_s, period_s);
  for (std::size_t n = 51; n <= 149; ++n)
    EXPECT_NEAR(volts[n], 12.0 * (static_cast<double>(n) - 50.0) * period_s / inverse_rate_s, 1e-9) << n;
  // the last half step, of which the mean of the law has its triangle
  EXPECT_NEAR(volts[150], 6.0, 0.25 * 12.0 * 0.5 * period_s / inverse_rate_s + 1e-9);
  for (std::size_t n = 151; n < volts.size(); ++n) EXPECT_NEAR(volts[n], 6.0, 1e-9) << n;
}

TEST(CommandRateLimit, LeavesWhatIsSlowerAlone) {
  AxisInput in = held(CommandKind::kDuty, 0.0, 0.5);
  for (std::size_t n = 0; n < in.command.size(); ++n) in.command[n] = 0.5 * in.time_s[n];
  const auto limited = run_axis(small_drive(), with({use_of("command_rate_limit", {0.05})}), in);
  const auto plain = run_axis(small_drive(), nothing(), in);
  for (std::size_t n = 0; n < plain.size(); ++n)
    EXPECT_NEAR(limited[n].omega_rotor_rad_s, plain[n].omega_rotor_rad_s,
                1e-3 * plain.back().omega_rotor_rad_s);
}

}  // namespace
}  // namespace omnihil::test
