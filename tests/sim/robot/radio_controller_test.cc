// The controller between antenna and bridges: closed forms of a PI loop on a motor's first order, limits, derivatives.
#include "sim/robot/radio_controller.h"

#include <gtest/gtest.h>

#include <numbers>

namespace omnihil {
namespace {

constexpr double kK = 0.03, kR_ohm = 0.5, kJ_kg_m2 = 4e-5, kGear = 3.0;
constexpr std::array<double, kWheels> kAngle = {0.25 * std::numbers::pi, 0.75 * std::numbers::pi,
                                                1.25 * std::numbers::pi, 1.75 * std::numbers::pi};

RadioControllerParams<double> some_loop() {
  RadioControllerParams<double> p;
  p.loop.kp_V_s_per_rad = 0.02;
  p.wheel_radius_m = 0.027;
  p.wheel_center_radius_m = 0.08;
  return p;
}

// A motor without friction, J dw/dt = k (u - k w) / R, exact over a period; returns the rotor's speeds per period.
template <typename T>
std::vector<T> drive_motor(const RadioControllerParams<T>& p, double command_rad_s, double seconds,
                           double bus_V = 24.0) {
  RadioController<T> controller(p, kAngle, kGear);
  PerWheel<T> omega{}, mean{};
  std::vector<T> out;
  const double keep = std::exp(-p.period_s * kK * kK / (kR_ohm * kJ_kg_m2));
  for (double t = 0.0; t < seconds; t += p.period_s) {
    if (t == 0.0) controller.hear(0.0, {}, CommandFrame::kWheelSpeeds);
    if (out.size() == 10) controller.hear(t, {command_rad_s, 0, 0, 0}, CommandFrame::kWheelSpeeds);
    const auto duty = controller.update(t, mean, T(bus_V), 1.0);
    const T end = duty[0] * (bus_V / kK), before = omega[0];
    omega[0] = end + (omega[0] - end) * keep;
    mean[0] = 0.5 * (before + omega[0]);
    out.push_back(omega[0]);
  }
  return out;
}

// u = kp (r - w) + ff r, w = u / k:  w = (kp + ff) r / (kp + k)
TEST(RadioController, WithoutAnIntegralTheSpeedIsShortByTheClosedForm) {
  RadioControllerParams<double> p = some_loop();
  p.loop.feedforward_V_s_per_rad = 0.01;
  const std::vector<double> w = drive_motor(p, 100.0, 2.0);
  EXPECT_NEAR(w.back(), (0.02 + 0.01) * 300.0 / (0.02 + kK), 1e-6);
}

TEST(RadioController, AnIntegralTakesWhatIsLeft) {
  RadioControllerParams<double> p = some_loop();
  p.loop.ki_V_per_rad = 0.2;
  EXPECT_NEAR(drive_motor(p, 100.0, 8.0).back(), 300.0, 1e-6);
}

// The closed loop's time constant: J R / (k (k + kp)).
TEST(RadioController, TheLoopHasTheTimeConstantOfTheory) {
  const RadioControllerParams<double> p = some_loop();
  const std::vector<double> w = drive_motor(p, 10.0, 1.0);
  const double tau_s = kJ_kg_m2 * kR_ohm / (kK * (kK + 0.02));
  const auto at = 10 + static_cast<std::size_t>(std::lround(tau_s / p.period_s));
  EXPECT_NEAR(w[at] / w.back(), 1.0 - std::exp(-1.0), 0.05);  // the loop acts a period and a half late
}

TEST(RadioController, LatencyIsTheTimeToTheFirstDuty) {
  for (const double latency_s : {0.0, 0.005, 0.02}) {
    RadioControllerParams<double> p = some_loop();
    p.latency_s = latency_s;
    const std::vector<double> w = drive_motor(p, 100.0, 0.2);
    std::size_t first = 0;
    while (first < w.size() && w[first] < 1e-6) ++first;
    EXPECT_NEAR(static_cast<double>(first) * p.period_s - 0.010, latency_s, 1.001 * p.period_s);
  }
}

// A log that begins with its first command: the robot stood until then, and is as late as with any other command.
TEST(RadioController, TheFirstCommandIsLateAsWell) {
  RadioControllerParams<double> p = some_loop();
  p.latency_s = 0.02;
  RadioController<double> controller(p, kAngle, kGear);
  controller.begin({}, {}, kK, CommandFrame::kWheelSpeeds);
  controller.hear(0.0, {100.0, 0, 0, 0}, CommandFrame::kWheelSpeeds);
  for (int n = 0; n < 40; ++n) {
    const double t = n * p.period_s;
    const double duty = controller.update(t, {}, 24.0, 1.0)[0];
    if (std::abs(t - p.latency_s) > p.period_s) {
      EXPECT_EQ(duty > 0.0, t > p.latency_s) << t;
    }
  }
}

TEST(RadioController, AtItsLimitTheIntegralDoesNotWindUp) {
  RadioControllerParams<double> p = some_loop();
  p.loop.ki_V_per_rad = 2.0;
  RadioController<double> controller(p, kAngle, kGear);
  controller.hear(0.0, {1000, 0, 0, 0}, CommandFrame::kWheelSpeeds);
  for (int n = 0; n < 2000; ++n) controller.update(1e-3 * n, {}, 24.0, 1.0);  // held: not a turn
  controller.hear(2.0, {0, 0, 0, 0}, CommandFrame::kWheelSpeeds);
  double duty = 1.0;
  int periods = 0;
  for (; duty > 0.5 && periods < 2000; ++periods)
    duty = controller.update(2.0 + 1e-3 * periods, {50, 0, 0, 0}, 24.0, 1.0)[0];
  EXPECT_LT(periods, 250);  // 24 V of integral at 2 V/rad and 50 rad/s, the largest it may hold
}

TEST(RadioController, BodyCommandsBecomeTheFirmwaresWheelSpeeds) {
  RadioControllerParams<double> p = some_loop();
  p.loop.feedforward_V_s_per_rad = 1.0;
  p.loop.kp_V_s_per_rad = 0.0;
  RadioController<double> controller(p, kAngle, kGear);
  controller.hear(0.0, {0.5, -0.3, 2.0, 0.0}, CommandFrame::kBodyVelocity);
  const auto duty = controller.update(0.0, {}, 1e6, 1.0);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double rim = -std::sin(kAngle[i]) * 0.5 + std::cos(kAngle[i]) * -0.3 + 0.08 * 2.0;
    EXPECT_NEAR(duty[i] * 1e6, kGear * rim / 0.027, 1e-6);
  }
}

TEST(RadioController, TheBodysAccelerationIsLimitedInItsDirection) {
  RadioControllerParams<double> p = some_loop();
  p.loop.feedforward_V_s_per_rad = 1.0;
  p.loop.kp_V_s_per_rad = 0.0;
  p.acceleration_limit_m_s2 = 4.0;
  p.yaw_acceleration_limit_rad_s2 = 30.0;
  RadioController<double> controller(p, kAngle, kGear);
  controller.hear(0.0, {0.6, 0.8, 3.0, 0.0}, CommandFrame::kBodyVelocity);
  PerWheel<double> duty{};
  for (int n = 0; n < 50; ++n) duty = controller.update(1e-3 * n, {}, 1e6, 1.0);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double v = 4.0 * 0.05, w = 30.0 * 0.05;
    const double rim = -std::sin(kAngle[i]) * 0.6 * v + std::cos(kAngle[i]) * 0.8 * v + 0.08 * w;
    EXPECT_NEAR(duty[i] * 1e6, kGear * rim / 0.027, 1e-6);
  }
}

TEST(RadioController, SilenceBringsItToZero) {
  RadioControllerParams<double> p = some_loop();
  p.timeout_s = 0.1;
  RadioController<double> controller(p, kAngle, kGear);
  controller.hear(0.0, {10, 0, 0, 0}, CommandFrame::kWheelSpeeds);
  EXPECT_GT(controller.update(0.099, {}, 24.0, 1.0)[0], 0.0);
  EXPECT_EQ(controller.update(0.101, {}, 24.0, 1.0)[0], 0.0);
}

// y_n = 1 - (tau / (tau + dt))^n after a step of one, as y += dt / (tau + dt) (1 - y) in the firmware makes it.
TEST(SpeedLoop, FiltersTheSpeedAsFirmwareDoes) {
  SpeedLoopParams<double> p{.speed_filter_s = 0.002};
  SpeedLoopState<double> state;
  for (int n = 1; n <= 5; ++n) {
    speed_loop_voltage(p, state, {.omega_rad_s = 1.0, .bus_voltage_V = 24.0, .dt_s = 1e-3});
    EXPECT_NEAR(state.filtered_rad_s, 1.0 - std::pow(2.0 / 3.0, n), 1e-12);
  }
}

// dy/dtau = -1 / dt: data that know of no filter can say so.
TEST(SpeedLoop, KnowsWhereAFilterBeginsFromNone) {
  SpeedLoopParams<Jet> p{.speed_filter_s = Jet(0.0, 0)};
  SpeedLoopState<Jet> state;
  speed_loop_voltage(p, state, {.omega_rad_s = Jet(1.0), .bus_voltage_V = Jet(24.0), .dt_s = 1e-3});
  EXPECT_DOUBLE_EQ(state.filtered_rad_s.a, 1.0);
  EXPECT_DOUBLE_EQ(state.filtered_rad_s.v[0], -1000.0);
}

TEST(RadioController, DerivativesAreExact) {
  const auto speed_at = [](double kp, double ki, double latency_s, double filter_s) {
    RadioControllerParams<double> p = some_loop();
    p.loop.kp_V_s_per_rad = kp;
    p.loop.ki_V_per_rad = ki;
    p.loop.speed_filter_s = filter_s;
    p.latency_s = latency_s;
    return drive_motor(p, 30.0, 0.05).back();
  };
  RadioControllerParams<Jet> p;
  p.loop.kp_V_s_per_rad = Jet(0.02, 0);
  p.loop.ki_V_per_rad = Jet(0.3, 1);
  p.loop.integral_limit_ratio = Jet(1.0);
  p.latency_s = Jet(0.0123, 2);
  p.loop.speed_filter_s = Jet(0.002, 3);
  const Jet w = drive_motor(p, 30.0, 0.05).back();
  const auto slope = [&](int which) {
    std::array<double, 4> x = {0.02, 0.3, 0.0123, 0.002}, y = x;
    const double h = 1e-5 * x[static_cast<std::size_t>(which)];
    x[static_cast<std::size_t>(which)] += h;
    y[static_cast<std::size_t>(which)] -= h;
    return (speed_at(x[0], x[1], x[2], x[3]) - speed_at(y[0], y[1], y[2], y[3])) / (2 * h);
  };
  for (int n = 0; n < 4; ++n) EXPECT_NEAR(w.v[n], slope(n), 1e-5 * std::abs(slope(n))) << n;
}

}  // namespace
}  // namespace omnihil
