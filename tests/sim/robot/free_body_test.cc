// The free body on four springs: stands, agrees with the planar joint where it should, and tips where that
// cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sim/robot/chassis.h"
#include "sim/robot/integrate.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

PlantOptions free_options() {
  PlantOptions o;
  o.physics = Physics::kSimbodyFree;
  o.mechanical_step_ns = 500'000;
  return o;
}

RobotModel square_robot() {
  RobotModel m = symmetric_robot();
  m.wheel_angle_rad = {45 * kDegree, 135 * kDegree, 225 * kDegree, 315 * kDegree};
  return m;
}

// Rolls a bare chassis for a time; wheels locked by friction where asked.
struct BareChassis {
  explicit BareChassis(const RobotModel& m)
      : back({m}, Chassis::Joint::kFree),
        q(free_layout(kWheels).q_per_robot),
        u(free_layout(kWheels).u_per_robot),
        scratch(q.size(), u.size()) {
    back.place(q, u, 0, 0.0, 0.0, 0.0);
  }
  void run(double time_s, bool locked) {
    std::vector<WheelTorques> torques(1);
    for (WheelTorque& t : torques[0]) t.locked = locked;
    for (double t = 0; t < time_s; t += 2.5e-4) {
      back.set_state(q, u);
      integrate(Integrator::kRungeKutta4, back, torques, 2.5e-4, q, u, scratch);
      back.normalise(q);
    }
    back.set_state(q, u);
  }
  Chassis back;
  std::vector<double> q, u;
  IntegratorScratch scratch;
};

TEST(FreeBody, StandsOnItsSpringsWithTheStaticLoads) {
  const RobotModel m = sample_robot();
  Plant plant = one_robot(m, free_options());
  plant.advance(1'000'000'000);
  const RobotTruth t = plant.truth(0);
  const auto expected = contact_law(m).load.at_rest_N;
  for (std::size_t i = 0; i < kWheels; ++i) EXPECT_NEAR(t.load_N[i], expected[i], 0.02);
  EXPECT_NEAR(std::accumulate(t.load_N.begin(), t.load_N.end(), 0.0), m.mass_kg * 9.80665, 1e-6);
  EXPECT_NEAR(t.x_m, 0.0, 1e-4);
  EXPECT_NEAR(t.yaw_rad, 0.0, 1e-4);
}

TEST(FreeBody, SinksByTheStatedDepthAndIsLevelWhenTheMassIsInTheMiddle) {
  const RobotModel m = square_robot();
  BareChassis bare(m);
  bare.run(0.5, true);
  EXPECT_NEAR(bare.back.height_m(0), m.wheel_radius_m - kFloorSink_m, 1e-7);
  EXPECT_NEAR(bare.back.tilt_rad(0), 0.0, 1e-6);
}

TEST(FreeBody, QuaternionRatesTurnTheBodyByItsAngularVelocity) {
  BareChassis bare(square_robot());  // level: B and W coincide
  const double wx = 0.3, wy = -0.2, wz = 5.0, vx = 0.5, vy = -0.4, vz = 0.7;
  bare.u = {wx, wy, wz, vx, vy, vz, 10.0, 20.0, -15.0, 5.0};
  std::vector<double> rate(bare.q.size());
  bare.back.position_rates(bare.q, bare.u, rate);
  const double dt = 1e-7;
  std::vector<double> later = bare.q;
  for (std::size_t i = 0; i < later.size(); ++i) later[i] += dt * rate[i];
  const auto v0 = bare.back.motion(bare.q, bare.u, 0).velocity,
             v1 = bare.back.motion(later, bare.u, 0).velocity;
  // dv_B/dt = -omega x v for a velocity that is constant in W
  EXPECT_NEAR((v1.v_forward_m_s - v0.v_forward_m_s) / dt, -(wy * vz - wz * vy), 1e-5);
  EXPECT_NEAR((v1.v_left_m_s - v0.v_left_m_s) / dt, -(wz * vx - wx * vz), 1e-5);
  EXPECT_DOUBLE_EQ(rate[4], vx);
  EXPECT_DOUBLE_EQ(rate[7], 10.0);
}

TEST(FreeBody, QuaternionKeepsItsLength) {
  BareChassis bare(sample_robot());
  bare.u = {0.3, -0.2, 5.0, 0.5, -0.4, 0.0, 10.0, 20.0, -15.0, 5.0};
  bare.run(0.5, false);
  double norm = 0.0;
  for (std::size_t i = 0; i < 4; ++i) norm += bare.q[i] * bare.q[i];
  EXPECT_NEAR(norm, 1.0, 1e-12);
}

// Stated difference: under moderate driving (below 3 m/s^2) position within 3 % of the path, yaw within 0.05
// rad and speed within 3 %: pitch, roll and the springs' delay are what the planar joint leaves out.
TEST(FreeBody, FollowsThePlanarJointUnderModerateDriving) {
  const RobotModel m = sample_robot();
  Plant planar = one_robot(m, planar_options(500'000)), free = one_robot(m, free_options());
  double way_m = 0.0;
  for (int ms = 0; ms < 2000; ++ms) {
    const double rise = std::min(1.0, ms / 500.0);
    const RobotDrive d = duty_drive({-0.16 * rise, -0.13 * rise, 0.13 * rise, 0.16 * rise});
    planar.write(0, d);
    free.write(0, d);
    planar.advance(1'000'000);
    free.advance(1'000'000);
    way_m += std::hypot(planar.truth(0).v_forward_m_s, planar.truth(0).v_left_m_s) * 1e-3;
  }
  const RobotTruth p = planar.truth(0), f = free.truth(0);
  EXPECT_GT(way_m, 1.0);
  EXPECT_LT(std::hypot(p.x_m - f.x_m, p.y_m - f.y_m), 0.03 * way_m);
  EXPECT_NEAR(p.yaw_rad, f.yaw_rad, 0.05);
  EXPECT_NEAR(p.v_forward_m_s, f.v_forward_m_s, 0.03 * p.v_forward_m_s);
  EXPECT_GT(std::hypot(p.x_m - f.x_m, p.y_m - f.y_m), 1e-9) << "the free body has no freedom";
}

TEST(FreeBody, LoadsMoveToTheRearUnderForwardAccelerationAsInThePlanarLaw) {
  const RobotModel m = square_robot();
  Plant planar = one_robot(m, planar_options(500'000)), free = one_robot(m, free_options());
  const RobotDrive d = duty_drive({-0.15, -0.15, 0.15, 0.15});
  std::array<double, 2> front_N{};  // mean over 50 to 150 ms: the springs' ringing averages out
  for (int ms = 0; ms < 150; ++ms) {
    planar.write(0, d);
    free.write(0, d);
    planar.advance(1'000'000);
    free.advance(1'000'000);
    if (ms < 50) continue;
    front_N[0] += (planar.truth(0).load_N[0] + planar.truth(0).load_N[3]) / 100.0;
    front_N[1] += (free.truth(0).load_N[0] + free.truth(0).load_N[3]) / 100.0;
  }
  const double at_rest_N = m.mass_kg * 9.80665 / 2;
  EXPECT_LT(front_N[0], at_rest_N - 0.5);
  EXPECT_NEAR(front_N[1] - at_rest_N, front_N[0] - at_rest_N, 0.15 * (at_rest_N - front_N[0]));
}

TEST(FreeBody, ATopHeavyRobotStoppedHardLiftsWheelsThatThePlanarJointKeepsDown) {
  RobotModel m = symmetric_robot();
  m.center_of_mass_height_m = 0.09;
  Plant plant = one_robot(m, free_options());
  double highest_load_N = 0.0;
  bool lifted = false;
  for (int ms = 0; ms < 1500; ++ms) {
    const double duty = ms < 800 ? 0.5 : -0.8;
    plant.write(0, duty_drive({-duty, -duty, duty, duty}));
    plant.advance(1'000'000);
    for (double load_N : plant.truth(0).load_N) {
      lifted = lifted || load_N == 0.0;
      highest_load_N = std::max(highest_load_N, load_N);
    }
  }
  EXPECT_TRUE(lifted);
  EXPECT_GT(highest_load_N, m.mass_kg * 9.80665 / 2);
}

}  // namespace
}  // namespace omnihil
