// A firmware in the loop of a prediction: when it hears, what it sees, when it runs.
#include "identify/predict/firmware_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/predict/predictor.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil {
namespace {

// Notes what it is told; drives wheel 0 by the command, lets the others go.
struct Noted {
  std::vector<double> heard_v, heard_at_s;
  std::vector<RobotSensors> seen;
  std::vector<RobotShafts> shafts;
};
class Stub final : public Firmware {
 public:
  explicit Stub(Noted& noted) : noted_(noted) {}
  std::string_view name() const override { return "stub"; }
  std::string_view radio_format() const override { return ""; }
  std::int64_t control_period_ns() const override { return 2'000'000; }
  void command(const RobotCommand& c, std::int64_t now_ns) override {
    noted_.heard_v.push_back(c.v_forward_m_s);
    noted_.heard_at_s.push_back(1e-9 * static_cast<double>(now_ns));
  }
  void radio_receive(std::span<const std::uint8_t>, std::int64_t) override {}
  std::size_t radio_transmit(std::span<std::uint8_t>) override { return 0; }
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  void shafts(const RobotShafts& exact) override { noted_.shafts.push_back(exact); }
  RobotDrive tick(const RobotSensors& s) override {
    noted_.seen.push_back(s);
    RobotDrive d{};
    d.mode[0] = OMNIHIL_DRIVE_DUTY;
    d.duty_ratio[0] = noted_.heard_v.empty() ? 0.1 : noted_.heard_v.back();
    d.duty_ratio[1] = 0.9;  // of a bridge that is off
    return d;
  }
  RobotFeedback feedback() const override { return {}; }

 private:
  Noted& noted_;
};
class Stubs final : public FirmwareSource {
 public:
  explicit Stubs(Noted& noted) : noted_(noted) {}
  std::unique_ptr<Firmware> fresh() const override { return std::make_unique<Stub>(noted_); }
  double counts_per_rotor_turn() const override { return 100.0; }

 private:
  Noted& noted_;
};

// Every tick of 2 ms from 10 s on, n of them.
void run(FirmwareLoop& loop, int n) {
  int ran = 0;
  for (int k = 0; ran < n; ++k) {
    const double now_s = 10.0 + 0.0005 * k;
    if (!loop.due(now_s)) continue;
    loop.tick(now_s, {});
    EXPECT_NEAR(now_s, 10.0 + 0.002 * ran, 1e-9);
    ++ran;
  }
}

TEST(FirmwareLoop, APacketIsHeardAtTheFirstTickThatIsNotBeforeItsLatency) {
  Noted noted;
  FirmwareLoop loop(Stubs(noted), 0.005, 10.0);
  loop.hear(10.0, std::array{0.5, 0.0, 0.0}, CommandFrame::kBodyVelocity);
  loop.hear(10.001, std::array{0.7, 0.0, 0.0}, CommandFrame::kBodyVelocity);
  run(loop, 6);
  EXPECT_EQ(noted.heard_v, (std::vector<double>{0.5, 0.7}));
  ASSERT_EQ(noted.heard_at_s.size(), 2U);
  // both are due by 6 ms, the fourth tick; its clock began at one period
  EXPECT_NEAR(noted.heard_at_s[0], 0.002 + 0.006, 1e-9);
  EXPECT_NEAR(noted.heard_at_s[1], 0.002 + 0.006, 1e-9);
}

TEST(FirmwareLoop, ALatencyOfWholeTicksIsThatManyTicks) {
  Noted noted;
  FirmwareLoop loop(Stubs(noted), 0.004, 10.0);
  loop.hear(10.002, std::array{0.5, 0.0, 0.0}, CommandFrame::kBodyVelocity);
  run(loop, 6);
  ASSERT_EQ(noted.heard_at_s.size(), 1U);
  EXPECT_NEAR(noted.heard_at_s[0], 0.002 + 0.006, 1e-9);
}

TEST(FirmwareLoop, BridgesAreWhatItAsksAndOffWhereItLetsGo) {
  Noted noted;
  FirmwareLoop loop(Stubs(noted), 0.0, 10.0);
  EXPECT_FALSE(loop.enabled()[0]);  // before it ran
  loop.tick(10.0, {});
  EXPECT_TRUE(loop.enabled()[0]);
  EXPECT_EQ(loop.duty()[0], 0.1);
  EXPECT_FALSE(loop.enabled()[1]);
  EXPECT_EQ(loop.duty()[1], 0.0);
  std::array<double, kWheels> told{};
  EXPECT_FALSE(loop.tells(1.0, told));  // its feedback has no time
}

TEST(FirmwareLoop, EncodersCountDownRoundedAndCurrentsAreMeansSinceTheTickBefore) {
  Noted noted;
  FirmwareLoop loop(Stubs(noted), 0.0, 10.0);
  RobotInstant sees{.gyro_rad_s = 1.5, .bus_voltage_V = 20.0};
  sees.theta_rotor_rad = {-0.001, 0.0, 0.019 * std::numbers::pi, 2.0 * std::numbers::pi + 1e-9};
  loop.tick(10.0, sees);
  sees.omega_rotor_rad_s[2] = 7.0;
  sees.charge_C[2] = 0.006;
  loop.tick(10.002, sees);
  ASSERT_EQ(noted.seen.size(), 2U);
  EXPECT_EQ(noted.seen[0].encoder_counts[0], -1);
  EXPECT_EQ(noted.seen[0].encoder_counts[1], 0);
  EXPECT_EQ(noted.seen[0].encoder_counts[2], 0);  // 0.95 counts
  EXPECT_EQ(noted.seen[0].encoder_counts[3], 100);
  EXPECT_EQ(noted.seen[0].motor_current_A[2], 0.0);
  EXPECT_NEAR(noted.seen[1].motor_current_A[2], 3.0, 1e-9);  // 6 mC in 2 ms
  EXPECT_EQ(noted.seen[1].bus_voltage_V, 20.0);
  EXPECT_EQ(noted.seen[1].gyro_z_rad_s, 1.5);
  ASSERT_EQ(noted.shafts.size(), 2U);  // unrounded, for sensors that are emulated
  EXPECT_EQ(noted.shafts[1].theta_rotor_rad[2], sees.theta_rotor_rad[2]);
  EXPECT_EQ(noted.shafts[1].omega_rotor_rad_s[2], 7.0);
  EXPECT_EQ(noted.seen[1].now_us - noted.seen[0].now_us, 2000U);
}

// Rows at 60 Hz, ticks at 500 Hz: no whole number of ticks in a row.
TEST(FirmwareLoop, TicksAreAPeriodApartWhateverTheRowsAre) {
  Noted noted;
  Dataset d = test::blank_radio(2.0);
  d.firmware = std::make_shared<Stubs>(noted);
  const auto predictor = make_predictor(d, test::radio_candidate(), {});
  noted = {};
  ASSERT_TRUE(predictor->predict(test::radio_candidate(), 0).finite);
  const std::size_t n = noted.seen.size();
  EXPECT_NEAR(static_cast<double>(n), (2.0 - 1.0 / 60.0) / 0.002, 1.0);
  for (std::size_t i = 1; i < n; ++i)  // but for the microsecond that it is rounded to
    EXPECT_NEAR(static_cast<double>(noted.seen[i].now_us - noted.seen[i - 1].now_us), 2000.0, 1.0);
}

}  // namespace
}  // namespace omnihil
