// Firmware that closes the motor loop itself: the reference FOC and six-step controllers through the C ABI,
// in a session with the plant's three-phase robot, by HERMES packets.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "firmware_iface/reference/phase_firmware.h"
#include "hil/loop/reference_firmware.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"
#include "protocols/radio_format.h"
#include "sim/robot/electric_model.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

SessionConfig phase_session(DriveKind kind, MotorLoop loop) {
  SessionSetup setup = test::one_robot("omni_default");
  SessionConfig config = session_config(setup);
  config.robots[0].motor_loop = loop;
  set_electrics(config.robots[0], [kind](ElectricModel& e) {
    e.kind = kind;
    e.inverter.dead_time_s = 3e-7;
    e.current_sensor.bits = 12;
    e.current_sensor.noise_sigma_V = 1e-3;
    e.angle.bits = 14;
  });
  return config;
}

Bytes speed_move(double vx, double vy, double vtheta) {
  const RadioFormat* radio = find_radio_format("ulaval-hermes");
  Values values;
  values.message = radio->find("SPEED_MOVE");
  values.set("robot", 0);
  values.set("vx", vx);
  values.set("vy", vy);
  values.set("vtheta", vtheta);
  Bytes bytes;
  EXPECT_EQ(radio->encode(values, bytes).error, PacketError::kNone);
  return bytes;
}

void run(Session& session, const Bytes& command, int ms) {
  Bytes out;
  for (int k = 0; k < ms; ++k) session.step(k % 50 == 0 ? command : Bytes{}, out);
}

std::uint64_t faults_of(const Session& session) {
  return dynamic_cast<const HostFirmware&>(session.firmware(0)).faults().total();
}

struct Case {
  const char* name;
  DriveKind kind;
  MotorLoop loop;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
class MotorLoopTest : public ::testing::TestWithParam<Case> {};

TEST_P(MotorLoopTest, FollowsAVelocityCommandOverTheRadioAndStopsWhenItFallsSilent) {
  const SessionConfig config = phase_session(GetParam().kind, GetParam().loop);
  Session session(config, reference_firmware_for(config));
  ASSERT_EQ(session.firmware(0).drives_phases(), GetParam().loop != MotorLoop::kDuty);
  run(session, speed_move(0.8, 0.0, 0.0), 900);
  RobotTruth truth = session.plant().truth(0);
  EXPECT_NEAR(truth.v_forward_m_s, 0.8, 0.04);
  EXPECT_NEAR(truth.v_left_m_s, 0.0, 0.03);
  EXPECT_NEAR(truth.omega_body_rad_s, 0.0, 0.1);
  run(session, speed_move(-0.3, 0.4, 2.0), 900);
  truth = session.plant().truth(0);
  EXPECT_NEAR(truth.v_forward_m_s, -0.3, 0.03);
  EXPECT_NEAR(truth.v_left_m_s, 0.4, 0.03);
  EXPECT_NEAR(truth.omega_body_rad_s, 2.0, 0.1);
  run(session, {}, 2500);  // timeout, brake, bridges off
  truth = session.plant().truth(0);
  EXPECT_NEAR(std::hypot(truth.v_forward_m_s, truth.v_left_m_s), 0.0, 1e-3);
  for (const auto& wheel : session.plant().electric_truth(0).phase_current_A) {
    for (const double i : wheel) EXPECT_EQ(i, 0.0);
  }
  EXPECT_EQ(faults_of(session), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, MotorLoopTest,
    ::testing::Values(Case{"FocOnAveragedDrive", DriveKind::kDq, MotorLoop::kFoc},
                      Case{"FocOnSwitchedDrive", DriveKind::kSwitched, MotorLoop::kFoc},
                      Case{"SixStepOnSwitchedDrive", DriveKind::kSwitched, MotorLoop::kSixStep},
                      Case{"SixStepOnAveragedDrive", DriveKind::kDq, MotorLoop::kSixStep},
                      Case{"DutyOnAveragedDrive", DriveKind::kDq, MotorLoop::kDuty},
                      Case{"DutyOnSwitchedDrive", DriveKind::kSwitched, MotorLoop::kDuty}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(MotorLoop, FocKeepsTheCurrentAlongQ) {
  const SessionConfig config = phase_session(DriveKind::kSwitched, MotorLoop::kFoc);
  Session session(config, reference_firmware_for(config));
  run(session, speed_move(0.0, 0.0, 6.0), 150);  // speeding up
  double sum_d = 0.0, sum_q = 0.0;
  for (int k = 0; k < 60; ++k) {
    run(session, speed_move(0.0, 0.0, 6.0), 1);
    const ElectricTruth t = session.plant().electric_truth(0);
    for (std::size_t w = 0; w < kWheels; ++w) {
      const double theta = 8.0 * session.plant().truth(0).theta_rotor_rad[w];
      for (std::size_t x = 0; x < 3; ++x) {
        const double angle = theta - static_cast<double>(x) * 2.0943951023931953;
        sum_d += t.phase_current_A[w][x] * std::cos(angle);
        sum_q -= t.phase_current_A[w][x] * std::sin(angle);
      }
    }
  }
  EXPECT_GT(std::abs(sum_q), 10.0);
  EXPECT_LT(std::abs(sum_d), 0.1 * std::abs(sum_q));
}

TEST(MotorLoop, TheTickComesOncePerPwmPeriodWithTheTimeOfItsSample) {
  SessionConfig config = phase_session(DriveKind::kDq, MotorLoop::kFoc);
  set_electrics(config.robots[0], [](ElectricModel& e) {
    e.inverter.pwm_frequency_Hz = 16e3;
    e.current_sample_ratio = 0.5;
  });
  struct Probe : MotorControl {
    MotorDrive motor_tick(const MotorSensors& s) override {
      times_ns.push_back(s.now_ns);
      return {};
    }
    std::vector<std::uint64_t> times_ns;
  } probe;
  Plant plant(config.robots, config.plant);
  plant.set_motor_control(0, &probe);
  plant.advance(2'000'000);
  ASSERT_EQ(probe.times_ns.size(), 32u);
  for (std::size_t k = 0; k < 32; ++k) EXPECT_EQ(probe.times_ns[k], k * 62'500 + 31'250);
}

// A table as an older library has it: it ends before motor_init().
TEST(MotorLoop, ATableFromBeforeThereWerePhasesDrivesByDuty) {
  const SessionConfig config = phase_session(DriveKind::kDq, MotorLoop::kDuty);
  omnihil_firmware_api old = *omnihil_foc_firmware();
  old.struct_bytes = offsetof(omnihil_firmware_api, motor_init);
  HostFirmware firmware(&old, robot_config(config.robots[0], 0), motor_config(config.robots[0]));
  EXPECT_FALSE(firmware.drives_phases());
  EXPECT_EQ(firmware.motor_tick({}).leg[0][0], static_cast<std::uint32_t>(OMNIHIL_LEG_OFF));
}

MotorDrive bad_legs{};
TEST(MotorLoop, LegsThatNoBridgeHasAreOpenedAndCounted) {
  const SessionConfig config = phase_session(DriveKind::kDq, MotorLoop::kFoc);
  omnihil_firmware_api api = *omnihil_foc_firmware();
  api.motor_tick = [](void*, const omnihil_motor_sensors*, omnihil_motor_drive* drive) { *drive = bad_legs; };
  HostFirmware firmware(&api, robot_config(config.robots[0], 0), motor_config(config.robots[0]));
  for (auto& wheel : bad_legs.leg) {
    for (std::uint32_t& leg : wheel) leg = OMNIHIL_LEG_PWM;
  }
  for (auto& wheel : bad_legs.leg_duty_ratio) {
    for (double& duty : wheel) duty = 0.5;
  }
  bad_legs.leg_duty_ratio[0][1] = 1.01;
  bad_legs.leg_duty_ratio[1][2] = std::numeric_limits<double>::quiet_NaN();
  bad_legs.leg[2][0] = 4;
  const MotorDrive given = firmware.motor_tick({});
  for (int w = 0; w < 3; ++w) {
    for (int x = 0; x < kLegs; ++x) {
      EXPECT_EQ(given.leg[w][x], static_cast<std::uint32_t>(OMNIHIL_LEG_OFF)) << w;
      EXPECT_EQ(given.leg_duty_ratio[w][x], 0.0);
    }
  }
  EXPECT_EQ(given.leg[3][0], static_cast<std::uint32_t>(OMNIHIL_LEG_PWM));
  EXPECT_EQ(firmware.faults().leg_duty_out_of_range, 1u);
  EXPECT_EQ(firmware.faults().leg_duty_not_finite, 1u);
  EXPECT_EQ(firmware.faults().leg_unknown, 1u);
  EXPECT_EQ(firmware.faults().total(), 3u);
}

TEST(MotorLoop, PhasesOfAFirmwareWithoutThemCoastAndAreCounted) {
  const SessionConfig config = phase_session(DriveKind::kDq, MotorLoop::kDuty);
  omnihil_firmware_api api = *omnihil_reference_firmware();
  api.tick = [](void*, const omnihil_sensors*, omnihil_drive* drive) {
    for (std::uint32_t& mode : drive->mode) mode = OMNIHIL_DRIVE_PHASES;
  };
  HostFirmware firmware(&api, robot_config(config.robots[0], 0));
  EXPECT_EQ(firmware.tick({}).mode[0], static_cast<std::uint32_t>(OMNIHIL_DRIVE_COAST));
  EXPECT_EQ(firmware.faults().drive_mode_unknown, 4u);
}

TEST(MotorLoop, RefusesASessionWhoseRobotHasNoPhases) {
  SessionConfig config = phase_session(DriveKind::kDq, MotorLoop::kFoc);
  const auto maker = reference_firmware_for(config);
  config.robots[0].electric = nullptr;
  config.robots[0].motor_loop = MotorLoop::kDuty;
  try {
    Session session(config, maker);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("sets the legs of three phases"), std::string::npos)
        << error.what();
  }
}

TEST(MotorLoop, SameBytesGiveTheSameStates) {
  std::vector<std::uint8_t> states[2];
  for (auto& state : states) {
    const SessionConfig config = phase_session(DriveKind::kSwitched, MotorLoop::kFoc);
    Session session(config, reference_firmware_for(config));
    run(session, speed_move(0.5, 0.2, 1.0), 300);
    state = session.plant().save();
  }
  EXPECT_EQ(states[0], states[1]);
}

}  // namespace
}  // namespace omnihil
