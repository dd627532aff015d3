// Play and compliance between rotor and wheel in a robot: absent at zero, rigid in the limit, never a source
// of energy, the same in both back ends, and seen by the encoder against the camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/robot/validate.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

using test::drive_for;
using test::floor_with;
using test::robot_with;

const Physics kAllPhysics[] = {Physics::kSimbody, Physics::kSimbodyFree, Physics::kPlanar};

std::vector<double> motion_of(const Plant& plant) {
  const RobotTruth t = plant.truth(0);
  std::vector<double> out{t.x_m, t.y_m, t.yaw_rad, t.v_forward_m_s, t.v_left_m_s, t.omega_body_rad_s};
  for (std::size_t i = 0; i < kWheels; ++i) {
    out.insert(out.end(),
               {t.theta_rotor_rad[i], t.omega_rotor_rad_s[i], t.omega_wheel_rad_s[i], t.motor_current_A[i]});
  }
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

RobotDrive turning(double duty) { return duty_drive({duty, duty, duty, duty}); }

TEST(PlantShaft, OfNoGapAndNoComplianceChangesNothingBitForBit) {
  for (const Physics physics : kAllPhysics) {
    Plant neutral = floor_with(sample_robot(),
                               {"backlash.gap_rad=0", "shaft_compliance.compliance_rad_per_Nm=0"}, physics);
    Plant without = floor_with(sample_robot(), {}, physics);
    excite(neutral, 0.2);
    excite(without, 0.2);
    const auto a = motion_of(neutral), b = motion_of(without);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
    }
  }
}

// The rigid robot in the same step of the mechanics is the limit, down to the compliance that the step itself
// adds (shaft_step.h).
TEST(PlantShaft, BecomesTheRigidRobotAsItStiffens) {
  Plant rigid = one_robot(sample_robot(), planar_options(50'000));
  excite(rigid, 1.0);
  const RobotTruth limit = rigid.truth(0);
  const auto departure_rad_s = [&](std::vector<std::string> effects) {
    effects.push_back("shaft_compliance.damping_Nm_s_per_rad=0.1");
    Plant plant = floor_with(sample_robot(), effects);
    excite(plant, 1.0);
    const RobotTruth t = plant.truth(0);
    EXPECT_LT(std::hypot(t.x_m - limit.x_m, t.y_m - limit.y_m), 5e-3);
    double most = 0.0;
    for (std::size_t i = 0; i < kWheels; ++i) {
      most = std::max(most, std::abs(t.omega_wheel_rad_s[i] - limit.omega_wheel_rad_s[i]));
    }
    return most;
  };
  double before = 1e9;
  for (const char* compliance : {"0.1", "0.01", "1e-4", "1e-6"}) {
    const double now = departure_rad_s({std::string("shaft_compliance.compliance_rad_per_Nm=") + compliance});
    EXPECT_LT(now, 0.3 * before) << compliance;
    before = now;
  }
  EXPECT_LT(before, 1e-4);
  EXPECT_LT(departure_rad_s({"backlash.gap_rad=1e-6", "backlash.contact_compliance_rad_per_Nm=0"}), 1e-4);
}

TEST(PlantShaft, IsTheSameInBothBackEnds) {
  const std::vector<std::string> effects{"backlash", "shaft_compliance"};
  Plant planar = floor_with(sample_robot(), effects, Physics::kPlanar);
  Plant simbody = floor_with(sample_robot(), effects, Physics::kSimbody);
  excite(planar, 0.4);
  excite(simbody, 0.4);
  EXPECT_LT(largest_difference(motion_of(planar), motion_of(simbody)), 1e-9);
}

// Within the play the floor does not feel the motor: the rotor alone turns, k i = J_r domega/dt.
TEST(PlantShaft, LeavesTheWheelAloneWithinThePlay) {
  const RobotModel m = frictionless_motor(sample_robot());
  for (const Physics physics : {Physics::kSimbody, Physics::kPlanar}) {
    Plant plant = floor_with(m, {"backlash.gap_rad=0.4"}, physics);
    double impulse = 0.0;
    for (int n = 0; n < 10; ++n) {
      plant.write(0, turning(0.05));
      plant.advance(500'000);
      impulse += m.motor.torque_constant_Nm_per_A * plant.sample_sensors(0).motor_current_A[0] * 5e-4;
    }
    const RobotTruth t = plant.truth(0);
    EXPECT_GT(t.theta_rotor_rad[0], 1e-3);
    EXPECT_LT(t.theta_rotor_rad[0], 0.2 * m.gear_ratio);
    EXPECT_NEAR(t.omega_rotor_rad_s[0], impulse / m.motor.rotor_inertia_kg_m2, 1e-9);
    EXPECT_EQ(t.omega_wheel_rad_s[0], 0.0);
    EXPECT_EQ(t.yaw_rad, 0.0);
  }
}

// Bridges off, nothing but the floor and the shafts act: all kinetic energy and the springs' only fall.
TEST(PlantShaft, NeverAddsEnergyToACoastingRobot) {
  const RobotModel m = frictionless_motor(symmetric_robot());
  const double gap = 0.02, compliance = 0.05;
  for (const Physics physics : {Physics::kSimbody, Physics::kPlanar}) {
    for (const bool soft : {false, true}) {
      std::vector<std::string> effects{"backlash.gap_rad=0.02"};
      if (soft) effects.push_back("shaft_compliance.compliance_rad_per_Nm=0.05");
      Plant plant = floor_with(m, effects, physics);
      const auto energy = [&] {
        const RobotTruth t = plant.truth(0);
        double e = 0.5 * m.mass_kg * (t.v_forward_m_s * t.v_forward_m_s + t.v_left_m_s * t.v_left_m_s) +
                   0.5 * m.yaw_inertia_kg_m2 * t.omega_body_rad_s * t.omega_body_rad_s;
        for (std::size_t i = 0; i < kWheels; ++i) {
          e += 0.5 * m.wheel_inertia_kg_m2 * t.omega_wheel_rad_s[i] * t.omega_wheel_rad_s[i] +
               0.5 * m.motor.rotor_inertia_kg_m2 * t.omega_rotor_rad_s[i] * t.omega_rotor_rad_s[i];
          const double twist = std::abs(t.theta_rotor_rad[i] / m.gear_ratio - t.theta_wheel_rad[i]);
          const double pressed = std::max(0.0, twist - 0.5 * gap);
          if (soft) e += 0.5 * pressed * pressed / compliance;
        }
        return e;
      };
      drive_for(plant, test::forward(m, 0.3), 0.3);
      RobotDrive off{};
      plant.write(0, off);
      plant.advance(2'000'000);  // currents die
      double before = energy();
      const double first = before;
      for (int n = 0; n < 400; ++n) {
        plant.advance(500'000);
        const double now = energy();
        EXPECT_LE(now, before + 1e-6 * first) << n;
        before = now;
      }
      EXPECT_LT(before, first);
    }
  }
}

// Signature: turning on the spot to and fro, the encoder runs ahead of what the camera sees on the way there
// and behind it on the way back: a hysteresis as wide as the gap. The robot without play has none.
TEST(PlantShaft, ShowsAsHysteresisOfTheEncoderAgainstTheCamera) {
  const RobotModel m = symmetric_robot();
  const double rad_per_count = 2.0 * M_PI / m.encoder.counts_per_turn / m.gear_ratio;
  const auto hysteresis_rad = [&](const std::vector<std::string>& effects) {
    Plant plant = floor_with(m, effects);
    double there = 0.0, back = 0.0;  // lead of the encoder over the camera, at the wheel
    for (int ms = 1; ms <= 2700; ++ms) {
      plant.write(0, turning(0.02 * std::sin(2.0 * M_PI * ms / 4000.0)));
      plant.advance(1'000'000);
      const double encoder = rad_per_count * static_cast<double>(plant.sample_sensors(0).encoder_counts[0]);
      const double lead = encoder - m.wheel_center_radius_m / m.wheel_radius_m * plant.vision(0).yaw_rad;
      if (ms == 700) there = lead;
      if (ms == 2700) back = lead;
    }
    return there - back;
  };
  EXPECT_NEAR(hysteresis_rad({"backlash.gap_rad=0.05"}) - hysteresis_rad({}), 0.05, 0.005);
}

TEST(PlantShaft, IsSavedAndRestoredWithItsRotors) {
  for (const Physics physics : kAllPhysics) {
    Plant plant = floor_with(sample_robot(), {"backlash", "shaft_compliance", "rolling_resistance"}, physics);
    excite(plant, 0.1);
    const auto middle = plant.save();
    excite(plant, 0.1);
    const auto first = motion_of(plant);
    ASSERT_TRUE(plant.restore(middle));
    excite(plant, 0.1);
    EXPECT_EQ(motion_of(plant), first);
  }
}

// Placed elsewhere by hand, no rotor has turned.
TEST(PlantShaft, KeepsItsRotorsWhereTheyAreWhenPlaced) {
  Plant plant = floor_with(sample_robot(), {"backlash.gap_rad=0.1"});
  drive_for(plant, turning(0.1), 0.3);
  const RobotSensors before = plant.sample_sensors(0);
  plant.set_pose(0, 1.0, 2.0, 0.5);
  const RobotSensors after = plant.sample_sensors(0);
  for (std::size_t i = 0; i < kWheels; ++i) EXPECT_EQ(after.encoder_counts[i], before.encoder_counts[i]);
  EXPECT_EQ(plant.truth(0).omega_rotor_rad_s[0], 0.0);
}

// With dry friction on rotor and wheel the robot comes to rest and stays, to the bit.
TEST(PlantShaft, ComesToRestExactly) {
  Plant plant = floor_with(sample_robot(), {"backlash", "shaft_compliance", "rolling_resistance"});
  drive_for(plant, turning(0.1), 0.3);
  plant.write(0, RobotDrive{});
  plant.advance(6'000'000'000);
  const auto then = motion_of(plant);
  plant.advance(500'000'000);
  EXPECT_EQ(motion_of(plant), then);
  EXPECT_EQ(plant.truth(0).v_forward_m_s, 0.0);
}

TEST(PlantShaft, NeedsBothMasses) {
  RobotModel m = robot_with(sample_robot(), {"backlash"});
  m.wheel_inertia_kg_m2 = 0.0;
  const std::vector<RobotModel> robots{m};
  const auto problems = plant_problems(robots, planar_options());
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("wheel_inertia_kg_m2"), std::string::npos) << problems[0];
}

}  // namespace
}  // namespace omnihil
