#include "sim/robot/plant.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "sim/drive/encoder.h"
#include "sim/robot/validate.h"
#include "tests/count_allocations.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

const Physics kAllPhysics[] = {Physics::kSimbody, Physics::kSimbodyFree, Physics::kPlanar};

Plant three_robots(Physics physics) {
  const std::vector<RobotModel> robots{sample_robot(), symmetric_robot(), sample_robot()};
  PlantOptions o;
  o.physics = physics;
  o.mechanical_step_ns = 500'000;
  return Plant(robots, o);
}

std::string refusal(const RobotModel& model, const PlantOptions& options = planar_options()) {
  try {
    one_robot(model, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

// Builds in which this file sees NDEBUG (Release) and builds without must both step: chassis.cc refuses to
// compile with NDEBUG, because Simbody as packaged would then crash on the first call.
TEST(Plant, SimbodyStepsInReleaseAndInDebugBuilds) {
#ifdef NDEBUG
  RecordProperty("build", "NDEBUG");
#else
  RecordProperty("build", "asserts");
#endif
  for (Physics physics : {Physics::kSimbody, Physics::kSimbodyFree}) {
    Plant plant = three_robots(physics);
    excite(plant, 0.05);
    EXPECT_EQ(plant.now_ns(), 50'000'000);
    EXPECT_GT(std::abs(plant.truth(1).omega_wheel_rad_s[0]), 1.0);
    EXPECT_FALSE(plant.fault());
  }
}

TEST(Plant, RestoredStateGivesTheSameBitsAgain) {
  for (Physics physics : kAllPhysics) {
    Plant plant = three_robots(physics);
    excite(plant, 0.3);
    (void)plant.sample_sensors(1);
    const auto middle = plant.save();
    excite(plant, 0.2);
    const auto end = plant.save();
    ASSERT_NE(middle, end);
    ASSERT_TRUE(plant.restore(middle));
    EXPECT_EQ(plant.now_ns(), 300'000'000);
    excite(plant, 0.2);
    EXPECT_EQ(plant.save(), end);
    Plant other = three_robots(physics);
    ASSERT_TRUE(other.restore(middle));
    excite(other, 0.2);
    EXPECT_EQ(other.save(), end);
  }
}

TEST(Plant, RefusesAStateOfOtherModelsOrOptionsOrACutOne) {
  Plant plant = three_robots(Physics::kPlanar);
  auto state = plant.save();
  EXPECT_FALSE(three_robots(Physics::kSimbody).restore(state));
  RobotModel heavier = sample_robot();
  heavier.mass_kg += 1e-9;
  Plant one = one_robot(sample_robot(), planar_options());
  EXPECT_FALSE(one_robot(heavier, planar_options()).restore(one.save()));
  state.pop_back();
  EXPECT_FALSE(plant.restore(state));
}

TEST(Plant, LookingAtTheTruthChangesNothing) {
  for (Physics physics : kAllPhysics) {
    Plant looked_at = three_robots(physics), left_alone = three_robots(physics);
    for (int ms = 0; ms < 100; ++ms) {
      excite(looked_at, 0.001);
      for (int n = 0; n < 3; ++n) (void)looked_at.truth(n);
      excite(left_alone, 0.001);
    }
    EXPECT_EQ(looked_at.save(), left_alone.save());
  }
}

TEST(Plant, OneLongAdvanceIsManyShortOnes) {
  Plant a = three_robots(Physics::kPlanar), b = three_robots(Physics::kPlanar);
  for (int n = 0; n < 3; ++n) a.write(n, excitation_drive(n, 0.4)), b.write(n, excitation_drive(n, 0.4));
  a.advance(100'000'000);
  for (int i = 0; i < 200; ++i) b.advance(500'000);
  EXPECT_EQ(a.save(), b.save());
}

TEST(Plant, ARobotDrivesTheSameAloneAndAmongOthers) {
  Plant alone = one_robot(symmetric_robot(), [] {
    PlantOptions o;
    o.physics = Physics::kPlanar;
    o.mechanical_step_ns = 500'000;
    return o;
  }());
  alone.set_pose(0, 0.0, 0.3, 0.0);  // the place of robot 1 in the row
  Plant fleet = three_robots(Physics::kPlanar);
  for (int ms = 0; ms < 500; ++ms) {
    const double t_s = ms * 1e-3;
    alone.write(0, excitation_drive(1, t_s));
    for (int n = 0; n < 3; ++n) fleet.write(n, excitation_drive(n, t_s));
    alone.advance(1'000'000);
    fleet.advance(1'000'000);
  }
  EXPECT_EQ(alone.truth(0).x_m, fleet.truth(1).x_m);
  EXPECT_EQ(alone.truth(0).y_m, fleet.truth(1).y_m);
  EXPECT_EQ(alone.sample_sensors(0).encoder_counts[2], fleet.sample_sensors(1).encoder_counts[2]);
}

TEST(Plant, ThePlanarPathAllocatesNothingPerStep) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers bring their own allocator";
#endif
  Plant plant = three_robots(Physics::kPlanar);
  excite(plant, 0.01);
  const std::uint64_t before = allocations;
  excite(plant, 0.2);
  for (int n = 0; n < 3; ++n) {
    (void)plant.sample_sensors(n);
    (void)plant.truth(n);
  }
  EXPECT_EQ(allocations - before, 0u);
}

TEST(Plant, ThePlanarPathWithEffectsAllocatesNothingPerStep) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers bring their own allocator";
#endif
  Plant plant =
      test::floor_with(sample_robot(), {"battery_sag", "cogging", "lugre_friction", "winding_heating",
                                        "actuator_delay", "wheel_slip", "floor_tilt", "sampling_delay",
                                        "encoder_missed_counts", "vision_delay"});
  excite(plant, 0.01);
  const std::uint64_t before = allocations;
  for (int ms = 0; ms < 200; ++ms) {
    plant.write(0, excitation_drive(0, ms * 1e-3));
    plant.advance(1'000'000);
    (void)plant.sample_sensors(0);
    (void)plant.vision(0);
  }
  EXPECT_EQ(allocations - before, 0u);
}

TEST(Plant, CountsAreTheTrueRotorAngleAndDirectionTurnsThem) {
  RobotModel reversed = sample_robot();
  reversed.encoder.direction = -1;
  const std::vector<RobotModel> robots{sample_robot(), reversed};
  Plant plant(robots, planar_options());
  for (int n = 0; n < 2; ++n) plant.write(n, duty_drive({0.2, -0.1, 0.15, 0.05}));
  plant.advance(700'000'000);
  for (int n = 0; n < 2; ++n) {
    const RobotTruth t = plant.truth(n);
    const RobotSensors s = plant.sample_sensors(n);
    const int direction = n == 0 ? 1 : -1;
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double exact = direction * t.theta_rotor_rad[i] / (2 * std::numbers::pi) * 4096;
      EXPECT_NEAR(static_cast<double>(s.encoder_counts[i]), exact, 1.0);
      EXPECT_GT(std::abs(s.encoder_counts[i]), 1000);
    }
  }
}

template <class P>
concept SamplesSensorsThroughConst = requires(const P& plant) {
  plant.sample_sensors(0);
};

// Sampling ends the averaging interval of the motor currents: two samples in a row differ, so it is no getter.
TEST(Plant, SamplingTheSensorsIsNotConst) {
  EXPECT_FALSE(SamplesSensorsThroughConst<Plant>);
  Plant plant = one_robot(sample_robot(), planar_options());
  plant.write(0, duty_drive({0.3, 0.3, 0.3, 0.3}));
  plant.advance(1'000'000);
  const Plant& watched = plant;
  const double before_A = watched.truth(0).motor_current_A[1];
  const double mean_A = plant.sample_sensors(0).motor_current_A[1];
  EXPECT_EQ(watched.truth(0).motor_current_A[1], before_A);         // a look at the truth changes nothing
  EXPECT_LT(mean_A, before_A);                                      // the current rises within the interval
  EXPECT_EQ(plant.sample_sensors(0).motor_current_A[1], before_A);  // the next interval is empty
}

TEST(Plant, MotorCurrentIsTheMeanSinceTheLastSample) {
  Plant plant = one_robot(sample_robot(), planar_options());
  plant.write(0, duty_drive({0.3, 0.3, 0.3, 0.3}));
  double sum_A = 0.0;
  for (int ms = 0; ms < 20; ++ms) {
    plant.advance(1'000'000);
    // the mean torque of one step is k times its mean current
    sum_A += plant.truth(0).motor_torque_Nm[1] / sample_robot().motor.torque_constant_Nm_per_A;
  }
  EXPECT_NEAR(plant.sample_sensors(0).motor_current_A[1], sum_A / 20, 1e-9);
  // nothing since: the current itself
  EXPECT_EQ(plant.sample_sensors(0).motor_current_A[1], plant.truth(0).motor_current_A[1]);
}

TEST(Plant, SensorsTellYawRateTimeVoltageAndMeanAcceleration) {
  for (Physics physics : {Physics::kPlanar, Physics::kSimbody}) {
    PlantOptions o = planar_options(250'000);
    o.physics = physics;
    Plant plant = one_robot(sample_robot(), o);
    plant.set_pose(0, 0.0, 0.0, 2.0);
    plant.write(0, duty_drive({-0.2, -0.3, 0.15, 0.3}));
    plant.advance(200'000'000);
    const RobotTruth before = plant.truth(0);
    plant.advance(250'000);
    const RobotTruth t = plant.truth(0);
    const RobotSensors s = plant.sample_sensors(0);
    EXPECT_EQ(s.now_us, 200'250u);
    EXPECT_EQ(s.bus_voltage_V, 24.0);
    EXPECT_EQ(s.gyro_z_rad_s, t.omega_body_rad_s);
    // a = dv/dt + omega x v, in the body frame
    const double h = 250e-6;
    EXPECT_NEAR(s.accel_x_m_s2,
                (t.v_forward_m_s - before.v_forward_m_s) / h - t.omega_body_rad_s * t.v_left_m_s, 0.05);
    EXPECT_NEAR(s.accel_y_m_s2, (t.v_left_m_s - before.v_left_m_s) / h + t.omega_body_rad_s * t.v_forward_m_s,
                0.05);
    EXPECT_GT(std::hypot(s.accel_x_m_s2, s.accel_y_m_s2), 0.5);
  }
}

TEST(Plant, DutyIsLimitedByTheModelAndCurrentByItsLimit) {
  RobotModel m = sample_robot();
  m.motor.duty_limit_ratio = 0.2;
  Plant limited = one_robot(m, planar_options()), asked = one_robot(sample_robot(), planar_options());
  limited.write(0, duty_drive({1.0, 1.0, 1.0, 1.0}));
  asked.write(0, duty_drive({0.2, 0.2, 0.2, 0.2}));
  limited.advance(300'000'000);
  asked.advance(300'000'000);
  EXPECT_NEAR(limited.truth(0).yaw_rad, asked.truth(0).yaw_rad, 1e-12);
  asked.write(0, duty_drive({-1.0, -1.0, -1.0, -1.0}));
  for (int ms = 0; ms < 50; ++ms) {
    asked.advance(1'000'000);
    EXPECT_LE(std::abs(asked.sample_sensors(0).motor_current_A[0]),
              sample_robot().motor.current_limit_A * 1.001);
  }
}

TEST(Plant, AnInputThatIsNotFiniteStopsItAndIsNamed) {
  Plant plant = three_robots(Physics::kPlanar);
  excite(plant, 0.01);
  plant.write(1, duty_drive({0.1, 0.1, std::numeric_limits<double>::quiet_NaN(), 0.1}));
  plant.advance(1'000'000);
  ASSERT_TRUE(plant.fault());
  EXPECT_EQ(plant.fault()->robot, 1);
  EXPECT_EQ(plant.fault()->signal, "duty_ratio");
  EXPECT_EQ(plant.fault()->index, 2);
  EXPECT_EQ(plant.fault()->now_ns, 10'000'000);
  EXPECT_TRUE(std::isfinite(plant.truth(1).x_m));
}

TEST(Plant, AdvancingByAPartOfAStepIsTheCallersMistake) {
  Plant plant = one_robot(sample_robot(), planar_options());
  EXPECT_THROW(plant.advance(1'500'000), std::logic_error);
  EXPECT_THROW(plant.advance(-1'000'000), std::logic_error);
}

TEST(PlantRefuses, EveryProblemOfModelAndOptionsAtOnce) {
  RobotModel m = sample_robot();
  m.mass_kg = -2.4;
  m.wheel_radius_m = 0.0;
  m.encoder.direction = 3;
  PlantOptions o = planar_options();
  o.electrical_step_ns = 30'000;
  const std::string text = refusal(m, o);
  EXPECT_NE(text.find("robot 0 \"sample\": mass_kg = -2.4 kg: must be more than 0"), std::string::npos)
      << text;
  EXPECT_NE(text.find("wheel_radius_m = 0 m"), std::string::npos) << text;
  EXPECT_NE(text.find("encoder.direction = 3: must be 1 or -1"), std::string::npos) << text;
  EXPECT_NE(text.find("electrical_step_ns = 30000: must divide mechanical_step_ns = 1000000"),
            std::string::npos)
      << text;
}

TEST(PlantRefuses, ACentreOfMassOutsideTheWheels) {
  RobotModel m = sample_robot();
  m.center_of_mass_x_m = 0.06;
  EXPECT_NE(refusal(m).find("the centre of mass must lie within the wheels"), std::string::npos)
      << refusal(m);
}

TEST(PlantRefuses, WheelsThatCannotDriveInEveryDirection) {
  RobotModel m = sample_robot();
  m.wheel_angle_rad = {90 * kDegree, 90 * kDegree, 270 * kDegree, 270 * kDegree};
  EXPECT_NE(refusal(m).find("cannot drive in every direction"), std::string::npos) << refusal(m);
}

TEST(PlantRefuses, InertiaAndMassThatTheWheelsAloneExceed) {
  RobotModel m = sample_robot();
  m.yaw_inertia_kg_m2 = 0.0005;
  EXPECT_NE(refusal(m).find("wheels and centre of mass alone make"), std::string::npos) << refusal(m);
  m = sample_robot();
  m.wheel_mass_kg = 0.7;
  EXPECT_NE(refusal(m).find("four wheels weigh 2.8 kg"), std::string::npos) << refusal(m);
}

TEST(PlantRefuses, NumbersThatAreNotNumbers) {
  RobotModel m = sample_robot();
  m.center_of_mass_x_m = std::numeric_limits<double>::quiet_NaN();
  m.motor.inductance_H = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(m).find("center_of_mass_x_m = nan m: must be finite"), std::string::npos) << refusal(m);
  EXPECT_NE(refusal(m).find("motor.inductance_H = inf H"), std::string::npos) << refusal(m);
}

TEST(PlantRefuses, NoRobotAtAll) {
  EXPECT_THROW(Plant(std::span<const RobotModel>(), planar_options()), std::invalid_argument);
}

}  // namespace
}  // namespace omnihil
