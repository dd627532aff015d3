// The closed form against Simbody: mass matrix, velocity forces and trajectories.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "sim/model/model_file.h"
#include "sim/robot/chassis.h"
#include "sim/robot/electric_model.h"
#include "sim/robot/planar_law.h"
#include "tests/sim/effects/robot_bench.h"

namespace omnihil {
namespace {

// Largest difference of any true quantity of two plants, in its own SI unit.
double largest_difference(const Plant& a, const Plant& b) {
  double worst = 0.0;
  const auto note = [&](double x, double y) { worst = std::max(worst, std::abs(x - y)); };
  for (int n = 0; n < a.robot_count(); ++n) {
    const RobotTruth p = a.truth(n), s = b.truth(n);
    note(p.x_m, s.x_m);
    note(p.y_m, s.y_m);
    note(p.yaw_rad, s.yaw_rad);
    note(p.v_forward_m_s, s.v_forward_m_s);
    note(p.v_left_m_s, s.v_left_m_s);
    note(p.omega_body_rad_s, s.omega_body_rad_s);
    for (std::size_t i = 0; i < kWheels; ++i) {
      note(p.omega_wheel_rad_s[i], s.omega_wheel_rad_s[i]);
      note(p.theta_rotor_rad[i], s.theta_rotor_rad[i]);
      note(p.motor_current_A[i], s.motor_current_A[i]);
      note(p.load_N[i], s.load_N[i]);
    }
  }
  return worst;
}

// Every robot of the program's models, and the tests' own two.
std::vector<RobotModel> all_robots() {
  namespace fs = std::filesystem;
  std::vector<RobotModel> robots{sample_robot(), symmetric_robot()};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(OMNIHIL_SOURCE_DIR) / "models/robots")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const auto read = [](const fs::path& path) {
      std::ifstream in(path);
      return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const ModelReading reading = read_model(read(file), file.filename(), [&](const std::string& motor) {
      return MotorFileText{motor, read(file.parent_path() / motor), ""};
    });
    for (const ModelProblem& problem : reading.problems) ADD_FAILURE() << problem.text();
    if (!reading.model || !reading.model->robot) continue;
    robots.push_back(*reading.model->robot);
    // A rounded angle, and a bridge that commutes at Hall edges, make a step of the voltage out of a
    // difference in the last bit: here the mechanics are compared.
    if (electrics_of(robots.back()).any()) {
      set_electrics(robots.back(), [](ElectricModel& e) {
        e.angle.bits = 0;
        if (e.kind == DriveKind::kSwitched) e.kind = DriveKind::kDq;
      });
    }
  }
  return robots;
}

// The longest step that is stable for every model with either integrator.
constexpr std::int64_t kStep_ns = 500'000;

// 10 ms of hard driving, the same for all. Past the tyre's extremum the curve falls, so a robot that spins
// out amplifies any difference, the rounding of two back ends too: this drive slips, and recovers.
void drive_all(Plant& plant, double t_s) {
  for (int ms = 0; ms < 10; ++ms) {
    for (int n = 0; n < plant.robot_count(); ++n) plant.write(n, excitation_drive(0, t_s + ms * 1e-3));
    plant.advance(1'000'000);
  }
}

class Agreement : public testing::TestWithParam<Integrator> {};

TEST(Robots, TheAgreementCoversEveryRobotOfTheModelsFolder) { EXPECT_GE(all_robots().size(), 2u + 3u); }

TEST_P(Agreement, PlanarIsSimbodyWithin1e9OverTenSecondsOfHardDriving) {
  const std::vector<RobotModel> robots = all_robots();
  PlantOptions options = planar_options(kStep_ns, GetParam());
  Plant planar(robots, options);
  options.physics = Physics::kSimbody;
  Plant simbody(robots, options);
  double worst = 0.0;
  std::vector<double> fastest_m_s(robots.size()), largest_slip(robots.size());
  for (int ms = 0; ms < 10'000; ms += 10) {
    drive_all(planar, ms * 1e-3);
    drive_all(simbody, ms * 1e-3);
    worst = std::max(worst, largest_difference(planar, simbody));
    for (std::size_t n = 0; n < robots.size(); ++n) {
      const RobotTruth t = planar.truth(static_cast<int>(n));
      fastest_m_s[n] = std::max(fastest_m_s[n], std::hypot(t.v_forward_m_s, t.v_left_m_s));
      for (double slip : t.slip_longitudinal_ratio)
        largest_slip[n] = std::max(largest_slip[n], std::abs(slip));
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("largest_difference", std::to_string(worst * 1e15) + "e-15");
  for (std::size_t n = 0; n < robots.size(); ++n) {
    EXPECT_GT(fastest_m_s[n], 1.0) << robots[n].name << ": the drive was not hard";
    EXPECT_GT(largest_slip[n], robots[n].tyre_longitudinal.extremum_slip)
        << robots[n].name << ": no wheel slipped";
  }
}

// The same with effects in every place a robot has.
TEST_P(Agreement, PlanarIsSimbodyWithin1e9WithEffectsToo) {
  const std::vector<std::string> effects{"battery_sag",     "stribeck_friction",
                                         "cogging",         "torque_ripple",
                                         "winding_heating", "dead_time",
                                         "motor_mismatch",  "wheel_slip",
                                         "roller_ripple",   "rolling_resistance",
                                         "payload",         "center_of_mass_offset",
                                         "floor_tilt",      "wheel_radius_mismatch",
                                         "dribbler_drag",   "lateral_roller_friction"};
  const std::vector<RobotModel> robots{test::robot_with(sample_robot(), effects), symmetric_robot(),
                                       test::robot_with(symmetric_robot(), effects)};
  PlantOptions options = planar_options(kStep_ns, GetParam());
  Plant planar(robots, options);
  options.physics = Physics::kSimbody;
  Plant simbody(robots, options);
  double worst = 0.0, fastest_m_s = 0.0;
  for (int ms = 0; ms < 3'000; ms += 10) {
    drive_all(planar, ms * 1e-3);
    drive_all(simbody, ms * 1e-3);
    worst = std::max(worst, largest_difference(planar, simbody));
    const RobotTruth t = planar.truth(0);
    fastest_m_s = std::max(fastest_m_s, std::hypot(t.v_forward_m_s, t.v_left_m_s));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(fastest_m_s, 1.0) << "the drive was not hard";
}

// Random but repeatable numbers between -1 and 1.
double noise(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 11) / 4503599627370496.0 - 1.0;
}

TEST(MassMatrix, OfSimbodyIsConstantInTheBodyFrameAndTheClosedForms) {
  for (const RobotModel& m : all_robots()) {
    Chassis chassis({m}, Chassis::Joint::kPlanar);
    std::vector<double> q(7), u(7);
    std::uint64_t seed = 7;
    for (int trial = 0; trial < 20; ++trial) {
      for (double& x : q) x = 5.0 * noise(seed);
      for (double& x : u) x = 20.0 * noise(seed);
      chassis.set_state(q, u);
      const std::vector<double> mass = chassis.mass_matrix();
      // speeds are (yaw rate, v_x, v_y in W, wheels); to body axes by the yaw angle
      const double c = std::cos(q[0]), s = std::sin(q[0]);
      const double yaw_x = c * mass[1] + s * mass[2], yaw_y = -s * mass[1] + c * mass[2];
      EXPECT_NEAR(mass[0], m.yaw_inertia_kg_m2, 1e-12);
      EXPECT_NEAR(yaw_x, -m.mass_kg * m.center_of_mass_y_m, 1e-12);
      EXPECT_NEAR(yaw_y, m.mass_kg * m.center_of_mass_x_m, 1e-12);
      EXPECT_NEAR(mass[8], m.mass_kg, 1e-12);
      EXPECT_NEAR(mass[9], 0.0, 1e-12);
      EXPECT_NEAR(mass[16], m.mass_kg, 1e-12);
      for (std::size_t i = 0; i < kWheels; ++i) {
        for (std::size_t column = 0; column < 7; ++column) {
          EXPECT_NEAR(mass[(3 + i) * 7 + column], column == 3 + i ? spin_inertia_kg_m2(m) : 0.0, 1e-12);
        }
      }
      // velocity forces: -m w^2 c, turned into the field frame
      const std::vector<double> bias = chassis.velocity_forces();
      const double cx = c * m.center_of_mass_x_m - s * m.center_of_mass_y_m;
      const double cy = s * m.center_of_mass_x_m + c * m.center_of_mass_y_m;
      EXPECT_NEAR(bias[1], -m.mass_kg * u[0] * u[0] * cx, 1e-11);
      EXPECT_NEAR(bias[2], -m.mass_kg * u[0] * u[0] * cy, 1e-11);
      EXPECT_NEAR(bias[0], 0.0, 1e-11);
      EXPECT_NEAR(bias[5], 0.0, 1e-11);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Agreement,
                         testing::Values(Integrator::kSemiImplicitEuler, Integrator::kRungeKutta4),
                         [](const auto& test) {
                           return test.param == Integrator::kRungeKutta4 ? "RungeKutta4"
                                                                         : "SemiImplicitEuler";
                         });

}  // namespace
}  // namespace omnihil
