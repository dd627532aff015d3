// SSL A-Team's wheel motor controller, unmodified, on its board: the registers and replies that it gave in
// another emulator, and its speed loop closed on the switched bridge and motor.
#include <cmath>
#include <cstdio>

#include "hil/firmware/image_firmware.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/firmware/esc_image.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {

constexpr unsigned kOpenLoop = 0, kVelocity = 1;

// The motor UART's command (52 bytes) and motion reply (56 bytes) of 2025.
std::vector<std::uint8_t> motion_command(unsigned control_type, float setpoint) {
  std::vector<std::uint8_t> bytes(52);
  bytes[0] = 0x21;
  bytes[8] = 2;  // telemetry on
  bytes[12] = static_cast<std::uint8_t>(control_type);
  put_bytes(bytes, 16, setpoint);
  return bytes;
}

struct AteamWheel : ThirdPartyImage {
  AteamWheel() : ThirdPartyImage("ateam-wheel.elf", "ateam_wheel_f031.toml") {}
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (!spec_) return;
    spec_->wheel_commands = {};
    spec_->radio_via = "USART1";  // here the test is the main board
  }
  // The command each 10 ms up to `end_ns`; replies as they come.
  std::vector<std::vector<std::uint8_t>> talk(mcu::McuBoard& board, const std::vector<std::uint8_t>& command,
                                              std::int64_t end_ns) {
    std::vector<std::vector<std::uint8_t>> replies;
    std::vector<std::uint8_t> frame;
    for (std::int64_t at = board.now_ns(); at < end_ns; at += 1'000'000) {
      if (at / 1'000'000 % 10 == 0) board.radio_receive(command);
      board.run_until_ns(at + 1'000'000);
      while (board.radio_transmit(frame)) replies.push_back(frame);
    }
    return replies;
  }
};

TEST_F(AteamWheel, GivesTheRegistersAndRepliesOfTheOtherEmulatorRowByRow) {
  const std::string file = third_party_vectors("ateam-wheel-firmware-io.json");
  if (file.empty()) GTEST_SKIP() << "OMNIHIL_SHARED names no folder with the rows";
  const auto rows = nlohmann::json::parse(third_party_text(file)).at("open_loop");
  for (const auto& row : rows) {
    const auto board = this->board();
    mcu::WorldState world;
    world.bus_voltage_V = 24.0;
    // a rotor whose sensors, inverted, show this code: the middle of its sector
    const unsigned hall = row.at("hall").get<unsigned>();
    for (int sector = 0; sector < 6; ++sector) {
      const double elec_rad = sector * std::numbers::pi / 3;
      if (mcu::HallLines::code(elec_rad) == (hall ^ 7u)) world.theta_rotor_rad[0] = elec_rad / 8;
    }
    board->set_world(world);
    board->run_until_ns(10'000'000);
    talk(*board, motion_command(kOpenLoop, 0.0f), 60'000'000);
    const auto replies =
        talk(*board, motion_command(row.at("motion_control_type"), row.at("setpoint")), 110'000'000);
    const std::string which = row.dump();
    const std::vector<std::uint32_t> ccr = row.at("tim1_ccr");
    for (unsigned x = 0; x < 3; ++x) EXPECT_EQ(peek(*board, "TIM1", 0x34 + 4 * x), ccr[x]) << which;
    const auto hex = [&row](const char* key) {
      return std::stoul(row.at(key).get<std::string>(), nullptr, 16);
    };
    EXPECT_EQ(peek(*board, "TIM1", 0x20), hex("tim1_ccer")) << which;
    EXPECT_EQ(peek(*board, "TIM1", 0x18), hex("tim1_ccmr1")) << which;
    EXPECT_EQ(peek(*board, "TIM1", 0x1C), hex("tim1_ccmr2")) << which;
    ASSERT_FALSE(replies.empty()) << which;
    const auto& last = replies.back();
    ASSERT_EQ(last.size(), 56u) << which;
    EXPECT_EQ(last[0], 0x81) << which;
    EXPECT_EQ(from_bytes<float>(last, 12), row.at("reported_vel_setpoint").get<float>()) << which;
    EXPECT_EQ(from_bytes<float>(last, 32), row.at("reported_vel_computed_setpoint").get<float>()) << which;
    EXPECT_EQ(from_bytes<std::uint32_t>(last, 8) & 1u, 0u) << which;
  }
}

// Its filter and gains leave a ripple of some rad/s on a rotor without a wheel, here as on the other
// emulator: reached is what holds on the mean of the last second.
TEST_F(AteamWheel, SlowClosesItsSpeedLoopOnTheThreePhaseMotor) {
  const auto board = this->board();
  const Inverter bridge{.pwm_frequency_Hz = 48e6 / (2 * 999),
                        .dead_time_s = 7 / 48e6,
                        .switch_resistance_ohm = 0.012,
                        .diode_forward_V = 0.8};
  const PhaseMotor<double> windings = df45_windings(BackEmfShape::kTrapezoid);
  MotorsOnBoard bench(*board, 24.0, 4000);
  bench.add({.wheel = 0, .drive = make_switched_drive(windings, bridge, {}), .load_Nm = 0.01});
  const MotorOnBoard& motor = bench.motors[0];
  std::vector<std::uint8_t> frame;
  std::int64_t next_command_ns = 0;
  double turned_rad = 0.0;
  for (const float setpoint_rad_s : {100.0f, -200.0f, 40.0f}) {
    const double turn_before_rad = motor.theta_rad();
    const std::int64_t end_ns = board->now_ns() + 5'000'000'000, last_ns = end_ns - 1'000'000'000;
    double from_rad = 0.0, from_s = 0.0;
    float reported_rad_s = 0.0f;
    while (board->now_ns() < end_ns) {
      if (board->now_ns() >= next_command_ns) {
        board->radio_receive(motion_command(kVelocity, setpoint_rad_s));
        next_command_ns += 10'000'000;
      }
      bench.period();
      while (board->radio_transmit(frame)) reported_rad_s = from_bytes<float>(frame, 24);
      if (from_s == 0.0 && board->now_ns() >= last_ns) {
        from_s = 1e-9 * static_cast<double>(board->now_ns());
        from_rad = motor.theta_rad();
      }
    }
    // clockwise, the firmware's positive, is the plant's negative rotation on this board
    const double seconds = 1e-9 * static_cast<double>(board->now_ns()) - from_s;
    const double mean_rad_s = -(motor.theta_rad() - from_rad) / seconds;
    std::printf("commanded %g rad/s: reached %.2f, reported %.2f\n", setpoint_rad_s, mean_rad_s,
                reported_rad_s);
    EXPECT_NEAR(mean_rad_s, setpoint_rad_s, 0.03 * std::abs(setpoint_rad_s));
    EXPECT_NEAR(reported_rad_s, setpoint_rad_s, 0.03 * std::abs(setpoint_rad_s));
    turned_rad += std::abs(motor.theta_rad() - turn_before_rad);
  }
  EXPECT_EQ(word(*board, "slipped_control_frame_count"), 0u);
  // It counts as an error every commutation whose Hall value is not the next one: all 1 kHz ones, at an
  // unchanged value, and none of the 48 a turn that the Hall edges cause.
  const double cycles = 1e-6 * static_cast<double>(board->now_ns()),
               edges = turned_rad / (2 * std::numbers::pi) * 48;
  EXPECT_GT(edges, 10000);
  EXPECT_NEAR(word(*board, "hall_transition_error_count"), cycles, 0.01 * edges);
}

TEST_F(AteamWheel, ResetsItselfByItsWatchdogAfterATenthOfASecondWithoutCommands) {
  const auto board = this->board();
  talk(*board, motion_command(kVelocity, 100.0f), 100'000'000);
  board->run_until_ns(150'000'000);
  EXPECT_EQ(board->machine().report().resets.size(), 1u);  // power-on
  board->run_until_ns(250'000'000);
  const auto resets = board->machine().report().resets;
  ASSERT_EQ(resets.size(), 2u);
  EXPECT_EQ(resets[1].cause, "IWDG");
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  board->wire(0)->legs(leg, duty);
  for (std::size_t x = 0; x < 3; ++x)
    EXPECT_EQ(leg[x] == OMNIHIL_LEG_PWM ? duty[x] : 0.0, 0.0) << x;  // no voltage
}

// A parameter request without anything to change: what it runs with, as the other emulator has it.
TEST_F(AteamWheel, AnswersWithItsGains) {
  const auto board = this->board();
  board->run_until_ns(10'000'000);
  std::vector<std::uint8_t> request(52), reply;
  request[0] = 0x20;
  board->radio_receive(request);
  board->run_until_ns(20'000'000);
  ASSERT_TRUE(board->radio_transmit(reply));
  ASSERT_EQ(reply.size(), 56u);
  EXPECT_EQ(reply[0], 0x80);
  EXPECT_EQ(reply[9], 1);  // version 0.1.0
  EXPECT_EQ(from_bytes<float>(reply, 16), 5.5f);
  EXPECT_EQ(from_bytes<float>(reply, 20), 8.0f);
  EXPECT_EQ(from_bytes<float>(reply, 24), 0.1f);
  EXPECT_EQ(from_bytes<float>(reply, 28), 20.0f);
  EXPECT_EQ(from_bytes<float>(reply, 32), 1.0f);
}

SessionConfig ateam_robot(std::int64_t step_ns) {
  SessionSetup setup = test::one_robot("ateam_2025");
  setup.step_ns = step_ns;
  return session_config(setup);
}

TEST_F(AteamWheel, SlowFourBoardsGiveTheSameBitsWhateverTheLoopStep) {
  std::vector<RobotTruth> ends;
  for (const std::int64_t step_ns : {1'000'000, 1'000'000, 5'000'000}) {
    Session session(ateam_robot(step_ns), image_firmware(third_party_image(image_file_), board_file_));
    std::vector<std::uint8_t> out;
    while (session.now_ns() < 300'000'000) {
      const bool says = session.now_ns() == 50'000'000;
      session.step(says ? hermes_packet("SPEED_MOVE", {{"vx", 1.0}}) : std::vector<std::uint8_t>{}, out);
    }
    ends.push_back(session.plant().truth(0));
    EXPECT_NE(ends.back().omega_rotor_rad_s[0], 0.0);
    EXPECT_EQ(ends.back().omega_rotor_rad_s, ends.front().omega_rotor_rad_s) << step_ns;
    EXPECT_EQ(ends.back().theta_rotor_rad, ends.front().theta_rotor_rad) << step_ns;
  }
}

// Four of them in a robot, told by the main board's packets what the host's body velocity asks of each wheel.
TEST_F(AteamWheel, SlowFourBoardsDriveTheRobotWithinThreePercent) {
  Session session(ateam_robot(1'000'000), image_firmware(third_party_image(image_file_), board_file_));
  constexpr double kForward_m_s = 0.8, kLeft_m_s = 0.3, kAngle_deg[] = {60, 135, 225, 300}, kRadius_m = 0.030;
  const auto move = hermes_packet("SPEED_MOVE", {{"vx", kForward_m_s}, {"vy", kLeft_m_s}});
  double forward_m_s = 0.0, left_m_s = 0.0, wheel_rad_s[kWheels] = {};
  constexpr int kSteps = 4000, kLast = 1000;
  for (int i = 0; i < kSteps; ++i) {
    std::vector<std::uint8_t> out;
    session.step(i % 20 == 0 && i > 200 ? move : std::vector<std::uint8_t>{}, out);
    if (i < kSteps - kLast) continue;
    const RobotTruth t = session.plant().truth(0);
    forward_m_s += t.v_forward_m_s / kLast;
    left_m_s += t.v_left_m_s / kLast;
    for (std::size_t w = 0; w < kWheels; ++w) wheel_rad_s[w] += t.omega_wheel_rad_s[w] / kLast;
  }
  std::printf("commanded %.1f %.1f m/s: reached %.3f %.3f m/s, wheels", kForward_m_s, kLeft_m_s, forward_m_s,
              left_m_s);
  const double size_m_s = std::hypot(kForward_m_s, kLeft_m_s);
  EXPECT_NEAR(forward_m_s, kForward_m_s, 0.03 * size_m_s);
  EXPECT_NEAR(left_m_s, kLeft_m_s, 0.03 * size_m_s);
  for (std::size_t w = 0; w < kWheels; ++w) {
    const double angle_rad = kAngle_deg[w] * std::numbers::pi / 180;
    const double commanded_rad_s =
        (-kForward_m_s * std::sin(angle_rad) + kLeft_m_s * std::cos(angle_rad)) / kRadius_m;
    EXPECT_NEAR(wheel_rad_s[w], commanded_rad_s, 0.03 * std::abs(commanded_rad_s)) << w;
    std::printf(" %+.2f (%+.2f)", wheel_rad_s[w], commanded_rad_s);
  }
  std::printf(" rad/s\n");
}

}  // namespace
}  // namespace omnihil
