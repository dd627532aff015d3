// What an image tells of its wheels by radio is what its telemetry says, when a host has it, in its packets' steps; of one that
// tells none there is no feedback.
#include "hil/dataset/booted_image.h"

#include "tests/hil/dataset/telling_firmware.h"

namespace omnihil {
namespace {

constexpr double kTick_s = 1e-3, kBoot_s = 0.05;
constexpr int kEvery = 10, kBootTicks = 50, kLate = 2;  // ticks: a packet, the boot, the way to the host

RobotConfig config() {
  RobotConfig c{};
  c.robot_id = 3;
  c.wheel_radius_m = 0.027;
  c.gear_ratio = 3.6;
  c.encoder_counts_per_rotor_turn = 4096.0;
  return c;
}

std::unique_ptr<Firmware> boards(const Telling& how) {
  return std::make_unique<TellingFirmware>(nullptr, how, config());
}

// Ticks since it was switched on of the newest packet that is at the host after tick n of the record; -1: none.
int newest_packet(int n) {
  const int arrived = kBootTicks + n - kLate;
  return arrived - (arrived + 1) % kEvery;
}

RobotFeedback step(BootedImage& image, double theta_rad, double omega_rad_s) {
  RobotSensors s{};
  RobotShafts shafts{};
  for (std::size_t w = 0; w < kWheels; ++w) {
    shafts.theta_rotor_rad[w] = theta_rad, shafts.omega_rotor_rad_s[w] = omega_rad_s;
    s.encoder_counts[w] = static_cast<std::int64_t>(
        std::floor(theta_rad * config().encoder_counts_per_rotor_turn / (2.0 * std::numbers::pi)));
  }
  image.shafts(shafts);
  image.tick(s);
  return image.feedback();
}

// Counted over a packet's time: one count of it, and half a step of the packet. theta = a t^2 / 2 from the record's start.
TEST(BootedImage, SpeedsThatItCountsAreTheShaftsToTheirQuantum) {
  constexpr double kAccel_rad_s2 = 300.0;
  BootedImage image(boards({.every = kEvery}), &telling_format(), config(), kBoot_s);
  const auto theta = [](int tick) {  // since it was switched on
    const double t_s = std::max(0, tick - kBootTicks) * kTick_s;
    return 0.5 * kAccel_rad_s2 * t_s * t_s;
  };
  const double count_rad_s = 2.0 * std::numbers::pi / 4096.0 / (kEvery * kTick_s) / config().gear_ratio;
  for (int n = 0; n < 400; ++n) {
    const int tick = kBootTicks + n, told = newest_packet(n);
    const RobotFeedback f = step(image, theta(tick), kAccel_rad_s2 * n * kTick_s);
    ASSERT_GT(f.now_us, 0u);
    const double mean_rad_s = (theta(told) - theta(told - kEvery)) / (kEvery * kTick_s) / config().gear_ratio;
    for (std::size_t w = 0; w < kWheels; ++w) {
      ASSERT_NEAR(f.omega_wheel_rad_s[w], mean_rad_s, count_rad_s + 0.5 * kToldStep_rad_s) << n;
      const double steps = f.omega_wheel_rad_s[w] / kToldStep_rad_s;
      ASSERT_NEAR(steps, std::round(steps), 1e-6) << n;
    }
  }
}

// A step of the speed at the record's start, low-passed tick by tick: 1 - exp(-t / tau).
TEST(BootedImage, SpeedsThatItFiltersAreToldAsFiltered) {
  constexpr double kOmega_rad_s = 200.0, kFilter_s = 0.03;
  BootedImage image(boards({.every = kEvery, .filter_s = kFilter_s, .counted = false}), &telling_format(),
                    config(), kBoot_s);
  for (int n = 0; n < 200; ++n) {
    const RobotFeedback f = step(image, kOmega_rad_s * n * kTick_s, kOmega_rad_s);
    const int ticks = std::max(0, newest_packet(n) - kBootTicks + 1);  // that it has seen it turn
    const double expected = -std::expm1(-ticks * kTick_s / kFilter_s) * kOmega_rad_s / config().gear_ratio;
    ASSERT_NEAR(f.omega_wheel_rad_s[0], expected, 0.5001 * kToldStep_rad_s) << n;
  }
}

TEST(BootedImage, OneThatTellsNoSpeedsHasNoFeedback) {
  BootedImage silent(boards({.every = 0}), &telling_format(), config(), kBoot_s);
  BootedImage by_wire(boards({.every = kEvery}), nullptr, config(), kBoot_s);
  for (int n = 0; n < 50; ++n) {
    EXPECT_EQ(step(silent, 0.1 * n, 100.0).now_us, 0u);
    EXPECT_EQ(step(by_wire, 0.1 * n, 100.0).now_us, 0u);
  }
}

TEST(BootedImage, PacketsOfAnotherRobotAreNotItsOwn) {
  RobotConfig other = config();
  other.robot_id = 4;
  BootedImage image(std::make_unique<TellingFirmware>(nullptr, Telling{.every = kEvery}, other),
                    &telling_format(), config(), kBoot_s);
  for (int n = 0; n < 50; ++n) EXPECT_EQ(step(image, 0.1 * n, 100.0).now_us, 0u);
}

}  // namespace
}  // namespace omnihil
