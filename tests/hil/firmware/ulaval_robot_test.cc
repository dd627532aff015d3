// ULaval's robot board, unmodified: vendor library, RTOS, USB stack, nRF24 radio and battery monitor. It
// drives the simulated robot by the radio packets that its own dongle would send.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "hil/firmware/image_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/firmware/third_party.h"

namespace omnihil {
namespace {

struct UlavalRobot : ThirdPartyImage {
  UlavalRobot() : ThirdPartyImage("ulaval-f407.elf", "ulaval_delta_f407.toml") {}
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (IsSkipped()) return;
    setup_.model = load_robot_model("ulaval_delta_board", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
    setup_.radio_format = "ulaval-hermes";
    setup_.robot_ids = {0};
    setup_.plant.physics = Physics::kPlanar;
    session_ = std::make_unique<Session>(session_config(setup_),
                                         image_firmware(third_party_image(image_file_), board_file_));
    run(1.0);  // boots
  }
  // `again` every 20 ms.
  void run(double duration_s, const std::vector<std::uint8_t>& again = {}) {
    const std::int64_t end_ns = session_->now_ns() + std::llround(duration_s * 1e9);
    while (session_->now_ns() < end_ns) {
      session_->step(session_->now_ns() % 20'000'000 == 0 ? again : std::vector<std::uint8_t>{}, out_);
    }
  }

  SessionSetup setup_;
  std::unique_ptr<Session> session_;
  std::vector<std::uint8_t> out_;
};

struct Move {
  double v_forward_m_s, v_left_m_s, omega_body_rad_s;
};

// Every wheel within 3 % of what eq. (5) asks of it; of the body's three speeds, the turn taken at the
// wheels' radius, each within 3 % of the command's size.
TEST_F(UlavalRobot, ReachesEveryCommandedSpeedWithinThreePercent) {
  constexpr double kRadius_m = 0.0785, kWheelRadius_m = 0.033, kAngle_deg[] = {60, 141, -141, -60};
  for (const Move& m : {Move{1.0, 0, 0}, Move{0, 0.6, 0}, Move{0, 0, 10.0}, Move{-0.7, -0.4, 0}}) {
    const auto move = hermes_packet(
        "SPEED_MOVE", {{"vx", m.v_forward_m_s}, {"vy", m.v_left_m_s}, {"vtheta", m.omega_body_rad_s}});
    run(2.5, move);
    Move mean{0, 0, 0};
    double wheel_rad_s[kWheels] = {};
    constexpr int kSamples = 100;
    for (int i = 0; i < kSamples; ++i) {
      run(0.005, move);
      const RobotTruth t = session_->plant().truth(0);
      mean.v_forward_m_s += t.v_forward_m_s / kSamples;
      mean.v_left_m_s += t.v_left_m_s / kSamples;
      mean.omega_body_rad_s += t.omega_body_rad_s / kSamples;
      for (std::size_t w = 0; w < kWheels; ++w) wheel_rad_s[w] += t.omega_wheel_rad_s[w] / kSamples;
    }
    std::printf("commanded %.1f %.1f m/s %.1f rad/s: reached %.3f %.3f m/s %.3f rad/s, wheels",
                m.v_forward_m_s, m.v_left_m_s, m.omega_body_rad_s, mean.v_forward_m_s, mean.v_left_m_s,
                mean.omega_body_rad_s);
    const double size_m_s = std::hypot(m.v_forward_m_s, m.v_left_m_s, kRadius_m * m.omega_body_rad_s);
    EXPECT_NEAR(mean.v_forward_m_s, m.v_forward_m_s, 0.03 * size_m_s);
    EXPECT_NEAR(mean.v_left_m_s, m.v_left_m_s, 0.03 * size_m_s);
    EXPECT_NEAR(kRadius_m * mean.omega_body_rad_s, kRadius_m * m.omega_body_rad_s, 0.03 * size_m_s);
    for (std::size_t w = 0; w < kWheels; ++w) {
      const double angle_rad = kAngle_deg[w] * std::numbers::pi / 180;
      const double commanded_rad_s = (-m.v_forward_m_s * std::sin(angle_rad) +
                                      m.v_left_m_s * std::cos(angle_rad) + m.omega_body_rad_s * kRadius_m) /
                                     kWheelRadius_m;
      EXPECT_NEAR(wheel_rad_s[w], commanded_rad_s, 0.03 * std::abs(commanded_rad_s)) << w;
      std::printf(" %+.2f (%+.2f)", wheel_rad_s[w], commanded_rad_s);
    }
    std::printf(" rad/s\n");
  }
}

TEST_F(UlavalRobot, BrakesWhenTheRadioFallsSilent) {
  run(1.5, hermes_packet("SPEED_MOVE", {{"vx", 1.0}}));
  EXPECT_GT(session_->plant().truth(0).v_forward_m_s, 0.9);
  run(2.5);
  EXPECT_LT(std::abs(session_->plant().truth(0).v_forward_m_s), 0.02);
}

// The battery's voltage comes from the monitor on I2C and goes back to the host through the radio chip.
TEST_F(UlavalRobot, AnswersItsBatteryVoltageByRadio) {
  struct Replies final : SessionObserver {
    void dongle_bytes(std::int64_t, std::span<const std::uint8_t> b) override {
      bytes.insert(bytes.end(), b.begin(), b.end());
    }
    std::vector<std::uint8_t> bytes;
  } replies;
  session_->set_observer(&replies);
  session_->step(hermes_packet("GET_BATTERIE"), out_);
  run(0.1);
  const RadioFormat* format = find_radio_format("ulaval-hermes");
  ASSERT_FALSE(replies.bytes.empty());
  const DecodeResult reply = format->decode(replies.bytes);
  ASSERT_EQ(reply.error, PacketError::kNone);
  EXPECT_EQ(reply.values.message->name, "BATTERIE_RESPONSE");
  EXPECT_EQ(reply.values.number("decivolts"), 148);  // of 14.8 V
  session_->set_observer(nullptr);
}

// What a real board never shows: the time base's interrupt uses a timer handle before it is set up.
TEST_F(UlavalRobot, ReportsTheNullPointerOfItsFirstInterrupts) {
  std::string all;
  for (const std::string& line : session_->firmware(0).report()) all += line + "\n";
  EXPECT_NE(all.find("accesses through null pointers, first at"), std::string::npos) << all;
  EXPECT_NE(all.find("HAL_TIM_IRQHandler"), std::string::npos) << all;
  EXPECT_EQ(all.find("fault"), std::string::npos) << all;
  EXPECT_EQ(all.find("reset"), std::string::npos) << all;
}

}  // namespace
}  // namespace omnihil
