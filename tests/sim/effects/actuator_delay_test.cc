#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

TEST(ActuatorDelay, ShiftsTheResponseByWholeSamplesExactly) {
  const AxisInput in = excite(Excitation::kPrbs, 0.6, 1.0);
  const auto now = run_axis(small_drive(), nothing(), in);
  const auto later = run_axis(small_drive(), with({use_of("actuator_delay", {0.004})}), in);
  // Before its first command a drive is taken to have been asked the same for ever, so the first value acts
  // early.
  const AxisInput still = [&] {
    AxisInput shifted = in;
    for (std::size_t n = shifted.command.size(); n-- > 4;) shifted.command[n] = shifted.command[n - 4];
    for (std::size_t n = 0; n < 4; ++n) shifted.command[n] = in.command[0];
    return shifted;
  }();
  const auto expected = run_axis(small_drive(), nothing(), still);
  for (std::size_t n = 0; n < now.size(); ++n) {
    EXPECT_NEAR(later[n].omega_rotor_rad_s, expected[n].omega_rotor_rad_s, 1e-6);
  }
}

// The longest delay with a command that changes every 50 us: what was asked 2000 changes ago.
TEST(ActuatorDelay, ReachesItsUpperBoundWhateverTheRateOfCommands) {
  const double delay_s = find_effect("actuator_delay")->info->params[0].upper;
  for (const double period_s : {50e-6, 200e-6, 1e-3}) {
    CommandHistory history;
    const auto asked = [&](double time_s) {
      return std::sin(300.0 * std::floor(time_s / period_s + 0.5) * period_s);
    };
    const int count = static_cast<int>(0.35 / period_s);
    for (int n = 0; n < count; ++n) history.push(n * period_s, asked(n * period_s));
    CommandPort<double> port;
    port.history = &history;
    port.now_s = (count - 1) * period_s;
    port.dt_s = 10e-6;  // within one held value
    find_effect("actuator_delay")->simulate.command(nullptr, &delay_s, nullptr, port);
    const double then_s = std::floor((port.now_s - delay_s) / period_s + 1e-6) * period_s;
    EXPECT_NEAR(port.setpoint, asked(then_s), 1e-9) << period_s;
  }
}

// u from 0 to 1 at t = 0.1 ms; over [0.05, 0.15] ms delayed by 0.025 ms the mean is a quarter.
TEST(ActuatorDelay, TakesTheMeanOverTheSubStep) {
  CommandHistory history;
  history.push(0.0, 0.0);
  history.push(1e-4, 1.0);
  CommandPort<double> port;
  port.history = &history;
  port.now_s = 0.5e-4;
  port.dt_s = 1e-4;
  const double delay_s = 0.25e-4;
  find_effect("actuator_delay")->simulate.command(nullptr, &delay_s, nullptr, port);
  EXPECT_NEAR(port.setpoint, 0.25, 1e-12);
}

TEST(ActuatorDelay, ActsAtOnceInTheLimit) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  const auto now = run_axis(small_drive(), nothing(), in);
  const auto soon = run_axis(small_drive(), with({use_of("actuator_delay", {1e-9})}), in);
  for (std::size_t n = 0; n < now.size(); ++n)
    EXPECT_NEAR(soon[n].omega_rotor_rad_s, now[n].omega_rotor_rad_s, 1e-3);
}

// The whole response has the derivative that differences show, at any delay.
TEST(ActuatorDelay, HasAnHonestDerivativeOfTheWholeResponse) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  for (const double d : {0.00031, 0.00412}) {
    const EffectUse use = use_of("actuator_delay", {d});
    const std::vector<Jet> unknown{Jet(d, 0)};
    const auto jets =
        run_axis(drive_params_as<Jet>(small_drive()), EffectSet<Jet>(std::vector{use}, unknown), in);
    const auto up = run_axis(small_drive(), with({use_of("actuator_delay", {d + 1e-7})}), in);
    const auto down = run_axis(small_drive(), with({use_of("actuator_delay", {d - 1e-7})}), in);
    double most = 0.0;
    for (std::size_t n = 0; n < up.size(); ++n) {
      const double slope = (up[n].omega_rotor_rad_s - down[n].omega_rotor_rad_s) / 2e-7;
      EXPECT_NEAR(jets[n].omega_rotor_rad_s.v[0], slope, 1e-3 * std::abs(slope) + 0.05);
      most = std::max(most, std::abs(slope));
    }
    EXPECT_GT(most, 1000.0);
  }
}

// Signature: the phase of the speed falls by omega d, in proportion to the frequency; the gain stays.
TEST(ActuatorDelay, ShowsAsAPhaseInProportionToTheFrequency) {
  const double d = 0.003;
  for (const double f : {5.0, 10.0, 20.0}) {
    AxisInput in = held(CommandKind::kDuty, 0.0, 3.0);
    for (std::size_t n = 0; n < in.time_s.size(); ++n) {
      in.command[n] = 0.5 * std::sin(2.0 * M_PI * f * in.time_s[n]);
    }
    const auto now = run_axis(small_drive(), nothing(), in);
    const auto later = run_axis(small_drive(), with({use_of("actuator_delay", {d})}), in);
    double re[2] = {}, im[2] = {};
    for (std::size_t n = 2000; n < 3000; ++n) {  // whole periods, settled
      const double c = std::cos(2.0 * M_PI * f * in.time_s[n]), s = std::sin(2.0 * M_PI * f * in.time_s[n]);
      re[0] += now[n].omega_rotor_rad_s * c, im[0] += now[n].omega_rotor_rad_s * s;
      re[1] += later[n].omega_rotor_rad_s * c, im[1] += later[n].omega_rotor_rad_s * s;
    }
    const double phase = std::atan2(re[0], im[0]) - std::atan2(re[1], im[1]);
    EXPECT_NEAR(std::remainder(phase, 2.0 * M_PI), 2.0 * M_PI * f * d, 2e-3) << f;
    EXPECT_NEAR(std::hypot(re[1], im[1]) / std::hypot(re[0], im[0]), 1.0, 2e-3) << f;
  }
}

}  // namespace
}  // namespace omnihil::test
