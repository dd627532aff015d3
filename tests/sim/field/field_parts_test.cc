// Kicker, chip kick, dribbler motor, break beam, goals: against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/field/break_beam.h"
#include "sim/field/chip_kick.h"
#include "sim/field/dribbler.h"
#include "sim/field/field_size.h"
#include "sim/field/kicker.h"

namespace omnihil {
namespace {

TEST(Kicker, SeedPolynomialReachesTenMetresPerSecondAtTwentyFour) {
  EXPECT_NEAR(kick_speed_m_s(kSeedKick, 0.024, 1.0), 10.12, 0.005);
  EXPECT_NEAR(kick_speed_m_s(kSeedKick, 0.010, 1.0), -0.1 + 2.13 - 0.315 - 0.0098, 1e-12);
}

TEST(Kicker, OutsideItsRangeThePolynomialIsNoKick) {
  EXPECT_EQ(kick_speed_m_s(kSeedKick, 0.0, 1.0), 0.0);
  EXPECT_EQ(kick_speed_m_s(kSeedKick, 0.0015, 1.0), 0.0);  // V(1.5) = -0.01
  EXPECT_EQ(kick_speed_m_s(kSeedKick, 0.141, 1.0), kick_speed_m_s(kSeedKick, 0.024, 1.0));
  EXPECT_NEAR(kick_speed_m_s(kSeedKick, 0.024, 0.5), 0.5 * kick_speed_m_s(kSeedKick, 0.024, 1.0), 1e-12);
}

TEST(Kicker, ItsOwnTableGivesThePolynomialBack) {
  std::vector<KickPoint> table;
  for (int k = 2; k <= 24; ++k) {
    const double x = k;
    table.push_back({x, -0.0001 * x * x * x + 0.0213 * x * x - 0.0315 * x - 0.0098});
  }
  const KickFit fit = fit_kick(table, 1e-3);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fit.law.c[i], kSeedKick.c[i], 1e-9);
  EXPECT_LT(fit.rms_m_s, 1e-9);
  EXPECT_EQ(fit.law.k_most, 24.0);
  table.resize(3);
  EXPECT_THROW(fit_kick(table, 1e-3), std::invalid_argument);
}

TEST(Capacitor, TakesItsEnergyOutOfTheBus) {
  const KickCapacitor c;
  double V = 0.0, bus_J = 0.0, time_s = 0.0;
  while (V < c.full_V - 1e-9 && time_s < 10.0) {
    bus_J += charge_capacitor(c, V, 24.0, 1e-3).bus_current_A * 24.0 * 1e-3;
    time_s += 1e-3;
  }
  const double stored_J = 0.5 * c.capacitance_F * c.full_V * c.full_V;
  EXPECT_NEAR(bus_J, stored_J / c.charge_efficiency, 1e-6 * bus_J);
  EXPECT_NEAR(time_s, stored_J / (c.charge_efficiency * c.charge_power_W), 2e-3);
  const double after_V = voltage_after_kick_V(c, V, 0.046, 8.0);
  EXPECT_NEAR(0.5 * c.capacitance_F * (V * V - after_V * after_V), 0.5 * 0.046 * 64.0 / 0.15, 1e-9);
}

TEST(ChipKick, TheDefaultFollowsItsStatedModel) {
  for (double k = 0.25; k < 8.0; k += 0.25) {
    for (double y = -0.0275; y < 0.03; y += 0.005) {
      const ChipKick kick = chip_kick(kDefaultChip, k, y);
      const double speed = 0.75 * k * (1.0 - y * y / 0.0036);
      EXPECT_NEAR(kick.speed_m_s, speed, 0.005);
      const double angle = (45.0 - 0.6 * k - 5.0 * y * y / 0.0009) * M_PI / 180.0;
      EXPECT_NEAR(kick.angle_rad, angle, 1e-3);
    }
  }
}

TEST(ChipKick, TrainingFindsAnUnseenLaw) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> k(1.0, 10.0), y(-0.03, 0.03);
  std::normal_distribution<double> noise;
  const auto law = [](double power, double at) {
    return ChipPoint{power, at, 5.0 * (1.0 - std::exp(-power / 4.0)), 0.9 - 0.02 * power + 3.0 * at};
  };
  std::vector<ChipPoint> table;
  for (int i = 0; i < 400; ++i) {
    ChipPoint p = law(k(random), y(random));
    p.speed_m_s += 0.02 * noise(random);
    p.angle_rad += 0.005 * noise(random);
    table.push_back(p);
  }
  const ChipTraining training = train_chip(table, {});
  double worst_m_s = 0.0;
  for (int i = 0; i < 200; ++i) {
    const ChipPoint truth = law(k(random), y(random));
    const ChipKick found = chip_kick(training.network, truth.k, truth.y_m);
    worst_m_s = std::max(worst_m_s, std::abs(found.speed_m_s - truth.speed_m_s));
  }
  EXPECT_LT(worst_m_s, 0.08);  // 4 of the noise's sigmas, at points that it has not seen
  table.resize(20);
  EXPECT_THROW(train_chip(table, {}), std::invalid_argument);
}

TEST(ChipKick, DistanceAndApexAreTheParabolas) {
  const ChipKick kick{4.0 * std::sqrt(2.0), 0.25 * M_PI};
  EXPECT_NEAR(chip_distance_m(kick, 0.0), 2.0 * 16.0 / 9.80665, 1e-9);
  EXPECT_NEAR(chip_apex_m(kick), 16.0 / (2.0 * 9.80665), 1e-9);
  EXPECT_EQ(chip_distance_m(kick, 0.0, 2.0), 0.0);
}

TEST(Dribbler, RunsUpToItsNoLoadSpeedAndDrawsWhatItsMotorDoes) {
  const DribblerModel d;
  double w = 0.0, current_A = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const DribblerStep step = drive_bar(d, w, 1.0, 22.2, 0.5e-3);
    w = step.omega_bar_rad_s;
    current_A = step.motor_current_A;
  }
  const double k = d.torque_constant_Nm_per_A * d.gear_ratio;
  EXPECT_NEAR(current_A, d.friction_Nm / k, 1e-6);
  EXPECT_NEAR(w, (22.2 - d.resistance_ohm * d.friction_Nm / k) / k, 1e-6);
  for (int i = 0; i < 20000; ++i) w = drive_bar(d, w, 0.0, 22.2, 0.5e-3).omega_bar_rad_s;
  EXPECT_EQ(w, 0.0);
}

TEST(BreakBeam, IsCutByABallThatIsNearerThanItsRadius) {
  const BreakBeam beam;
  const RobotOutline o;
  const double x = o.front_m + beam.forward_m;
  EXPECT_TRUE(beam_cut(beam, o, {x + 0.0214, 0, beam.height_m}, 0.0215));
  EXPECT_FALSE(beam_cut(beam, o, {x + 0.0216, 0, beam.height_m}, 0.0215));
  EXPECT_FALSE(beam_cut(beam, o, {x, o.half_front_m() + 0.022, beam.height_m}, 0.0215));
}

TEST(BreakBeam, AnswersAfterItsReactionTimeAndNotToAShorterCut) {
  BreakBeam beam;
  beam.reaction_s = 2e-3;
  BeamMemory memory;
  EXPECT_FALSE(beam_seen(beam, memory, true, 0.0, 1e-3, 1.0));
  EXPECT_FALSE(beam_seen(beam, memory, true, 1e-3, 1e-3, 1.0));
  EXPECT_FALSE(beam_seen(beam, memory, false, 2e-3, 1e-3, 1.0));
  EXPECT_FALSE(beam_seen(beam, memory, true, 3e-3, 1e-3, 1.0));
  EXPECT_TRUE(beam_seen(beam, memory, true, 5e-3, 1e-3, 1.0));
}

TEST(BreakBeam, FalseTriggersComeAtTheirRate) {
  BreakBeam beam;
  beam.false_rate_Hz = 2.0;
  beam.false_time_s = 1e-3;
  BeamMemory memory;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> draw(0.0, 1.0);
  int triggers = 0;
  bool before = false;
  for (int i = 0; i < 1'000'000; ++i) {
    const bool seen = beam_seen(beam, memory, false, 1e-3 * i, 1e-3, draw(random));
    triggers += seen && !before;
    before = seen;
  }
  EXPECT_NEAR(triggers, 2000, 5.0 * std::sqrt(2000.0));  // Poisson
}

TEST(Field, AGoalIsBehindTheLineAndBetweenThePosts) {
  const FieldSize& f = kFieldDivisionB;
  EXPECT_EQ(goal_at(f, 0.0215, 4.53, 0.0, 0.02), 1);
  EXPECT_EQ(goal_at(f, 0.0215, -4.53, 0.0, 0.02), -1);
  EXPECT_EQ(goal_at(f, 0.0215, 4.51, 0.0, 0.02), 0);  // not with all of it
  EXPECT_EQ(goal_at(f, 0.0215, 4.53, 0.51, 0.02), 0);
  EXPECT_EQ(goal_at(f, 0.0215, 4.53, 0.0, 0.3), 0);  // above
  EXPECT_EQ(find_field("division-a")->length_mm, 12000);
  EXPECT_EQ(find_field("nowhere"), nullptr);
}

TEST(ChipText, ANetworkComesBackAndDamageDoesNot) {
  const std::string text = chip_text(kDefaultChip);
  const auto back = chip_of_text(text);
  ASSERT_TRUE(back.has_value());
  for (const double k : {1.0, 4.5, 8.0})
    for (const double y : {-0.02, 0.0, 0.03}) {
      EXPECT_NEAR(chip_kick(*back, k, y).speed_m_s, chip_kick(kDefaultChip, k, y).speed_m_s, 1e-6);
      EXPECT_NEAR(chip_kick(*back, k, y).angle_rad, chip_kick(kDefaultChip, k, y).angle_rad, 1e-6);
    }
  EXPECT_FALSE(chip_of_text(text + " 1").has_value());
  EXPECT_FALSE(chip_of_text(text.substr(0, text.rfind(' '))).has_value());
  EXPECT_FALSE(chip_of_text("nan " + text.substr(text.find(' ') + 1)).has_value());
  EXPECT_FALSE(chip_of_text("").has_value());
}

}  // namespace
}  // namespace omnihil
