// Effects in the plant: absent when neutral, saved and restored, one bus for four motors, sensors and timing.
#include <gtest/gtest.h>

#include <bit>
#include <numbers>

#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

using test::drive_for;
using test::floor_with;
using test::forward;
using test::robot_with;

const Physics kAllPhysics[] = {Physics::kSimbody, Physics::kSimbodyFree, Physics::kPlanar};

std::vector<double> numbers_of(Plant& plant) {
  const RobotTruth t = plant.truth(0);
  const RobotSensors s = plant.sample_sensors(0);
  std::vector<double> out{
      t.x_m,          t.y_m,          t.yaw_rad,      t.v_forward_m_s, t.v_left_m_s, t.omega_body_rad_s,
      s.gyro_z_rad_s, s.accel_x_m_s2, s.accel_y_m_s2, s.bus_voltage_V};
  for (std::size_t i = 0; i < kWheels; ++i) {
    out.insert(out.end(), {t.theta_rotor_rad[i], t.omega_wheel_rad_s[i], t.motor_current_A[i],
                           s.motor_current_A[i], static_cast<double>(s.encoder_counts[i])});
  }
  return out;
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << "number " << i;
  }
}

TEST(PlantEffects, AtNeutralChangeNothingBitForBit) {
  for (const Physics physics : kAllPhysics) {
    Plant neutral = floor_with(sample_robot(),
                               {"cogging.amplitude_Nm=0", "floor_tilt.angle_rad=0", "payload.mass_kg=0",
                                "wheel_slip.compliance_m_s=0", "vision_delay.delay_s=0"},
                               physics);
    Plant without = floor_with(sample_robot(), {}, physics);
    excite(neutral, 0.3);
    excite(without, 0.3);
    expect_same_bits(numbers_of(neutral), numbers_of(without));
    EXPECT_EQ(neutral.save().size(), without.save().size());
  }
}

// The path with effects is another piece of code; a vanishing effect gives the numbers of the path without.
TEST(PlantEffects, OfVanishingSizeGiveTheNumbersOfTheBaseModel) {
  Plant tiny = floor_with(sample_robot(), {"quadratic_drag.coefficient_Nm_s2_per_rad2=1e-16"});
  Plant without = floor_with(sample_robot(), {});
  excite(tiny, 1.0);
  excite(without, 1.0);
  const RobotTruth a = tiny.truth(0), b = without.truth(0);
  EXPECT_NEAR(a.x_m, b.x_m, 2e-5);
  EXPECT_NEAR(a.y_m, b.y_m, 2e-5);
  for (std::size_t i = 0; i < kWheels; ++i) EXPECT_NEAR(a.omega_wheel_rad_s[i], b.omega_wheel_rad_s[i], 5e-3);
}

TEST(PlantEffects, AreSavedAndRestoredWithTheirStates) {
  const std::vector<std::string> effects{"winding_heating",   "actuator_delay",        "lugre_friction",
                                         "sampling_delay",    "encoder_missed_counts", "battery_sag",
                                         "rolling_resistance"};
  for (const Physics physics : kAllPhysics) {
    Plant plant = floor_with(sample_robot(), effects, physics);
    excite(plant, 0.3);
    (void)plant.sample_sensors(0);
    const auto middle = plant.save();
    excite(plant, 0.2);
    const auto first = numbers_of(plant);
    ASSERT_TRUE(plant.restore(middle));
    excite(plant, 0.2);
    expect_same_bits(numbers_of(plant), first);
  }
}

TEST(PlantEffects, OfAnotherModelDoNotRestore) {
  Plant a = floor_with(sample_robot(), {"floor_tilt.angle_rad=0.01"});
  Plant b = floor_with(sample_robot(), {"floor_tilt.angle_rad=0.02"});
  EXPECT_FALSE(b.restore(a.save()));
}

// Signature of sag: the bus dips by R times what all four take, at once; three idle motors see it too.
TEST(PlantEffects, BatterySagIsOneDipForAllMotorsTogether) {
  const RobotModel m = symmetric_robot();
  const auto bus = [&](const PerWheel<double>& duty) {
    Plant plant = floor_with(m, {"battery_sag.resistance_ohm=0.05"});
    drive_for(plant, duty_drive(duty), 0.004);
    const RobotTruth t = plant.truth(0);
    double taken_A = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) taken_A += duty[i] * t.motor_current_A[i];
    const double volt = plant.sample_sensors(0).bus_voltage_V;
    EXPECT_NEAR(volt, m.bus_voltage_V - 0.05 * taken_A, 0.02);
    return volt;
  };
  const double one = m.bus_voltage_V - bus({0.3, 0.0, 0.0, 0.0});
  const double four = m.bus_voltage_V - bus({0.3, 0.3, 0.3, 0.3});
  EXPECT_GT(one, 0.05);
  EXPECT_NEAR(four, 4.0 * one, 0.3 * four);
}

TEST(PlantEffects, HeatingWeakensTheMotorsOfTheRobot) {
  const RobotModel m = symmetric_robot();
  Plant cold = floor_with(m, {});
  Plant hot = floor_with(m, {"winding_heating.temperature_coefficient_per_K=0.00393",
                             "winding_heating.thermal_capacity_J_per_K=1"});
  for (Plant* plant : {&cold, &hot}) {
    for (int n = 0; n < 20; ++n) drive_for(*plant, forward(m, n % 2 == 0 ? 0.4 : -0.4), 0.1);
  }
  double cold_A = 0.0, hot_A = 0.0;
  for (std::size_t i = 0; i < kWheels; ++i) {
    cold_A += std::abs(cold.sample_sensors(0).motor_current_A[i]);
    hot_A += std::abs(hot.sample_sensors(0).motor_current_A[i]);
  }
  EXPECT_NE(cold_A, hot_A);
}

// Counts of a delayed encoder are those of the past: at constant speed the lag is speed times delay.
TEST(PlantEffects, SamplingDelayShowsAsCountsThatLagBySpeedTimesDelay) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"sampling_delay.delay_s=0.01"});
  for (int ms = 0; ms < 2000; ++ms) {
    drive_for(plant, duty_drive({0.1, 0.1, 0.1, 0.1}), 1e-3);
    (void)plant.sample_sensors(0);
  }
  const RobotTruth t = plant.truth(0);
  const RobotSensors s = plant.sample_sensors(0);
  const double counts_per_rad = m.encoder.counts_per_turn / (2.0 * std::numbers::pi);
  EXPECT_NEAR(t.theta_rotor_rad[0] * counts_per_rad - static_cast<double>(s.encoder_counts[0]),
              0.01 * t.omega_rotor_rad_s[0] * counts_per_rad, 2.0);
}

TEST(PlantEffects, VisionDelayShowsThePoseOfThePast) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"vision_delay.delay_s=0.05"});
  drive_for(plant, forward(m, 0.2), 0.5);
  const RobotTruth then = plant.truth(0);
  drive_for(plant, forward(m, 0.2), 0.05);
  EXPECT_NEAR(plant.vision(0).x_m, then.x_m, 1e-9);
  EXPECT_GT(plant.truth(0).x_m, then.x_m + 0.01);
  Plant exact = floor_with(m, {});
  drive_for(exact, forward(m, 0.2), 0.5);
  EXPECT_EQ(exact.vision(0).x_m, exact.truth(0).x_m);
}

// Eccentricity: counts depart by the amplitude once per rotor turn, the speed does not.
TEST(PlantEffects, EccentricityIsSeenByTheEncoderOnly) {
  const RobotModel m = symmetric_robot();
  Plant plant = floor_with(m, {"encoder_eccentricity.amplitude_rad=0.02"});
  const double counts_per_rad = m.encoder.counts_per_turn / (2.0 * std::numbers::pi);
  double most = 0.0;
  for (int ms = 0; ms < 500; ++ms) {
    drive_for(plant, duty_drive({0.05, 0.05, 0.05, 0.05}), 1e-3);
    const double seen = static_cast<double>(plant.sample_sensors(0).encoder_counts[0]) / counts_per_rad;
    most = std::max(most, std::abs(seen - plant.truth(0).theta_rotor_rad[0]));
  }
  EXPECT_NEAR(most, 0.02, 2e-3);
}

// Friction holds four wheels exactly still below the level, in every back end.
TEST(PlantEffects, FrictionOfEffectsHoldsExactlyStill) {
  for (const Physics physics : kAllPhysics) {
    Plant plant =
        floor_with(frictionless_motor(symmetric_robot()),
                   {"stribeck_friction.extra_torque_Nm=0.01", "stribeck_friction.speed_rad_s=5"}, physics);
    drive_for(plant, duty_drive({0.005, 0.005, 0.005, 0.005}), 0.2);
    for (const double w : plant.truth(0).omega_wheel_rad_s) EXPECT_EQ(w, 0.0);
  }
}

}  // namespace
}  // namespace omnihil
