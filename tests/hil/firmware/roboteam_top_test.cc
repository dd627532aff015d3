// RoboTeam Twente's top board, unmodified: vendor library, SX1280, inertial unit, four gate drivers. It drives the
// simulated robot by the REM packets that its base station would send.
#include <array>
#include <cmath>
#include <cstdio>

#include "hil/firmware/image_firmware.h"
#include "hil/loop/effect_overrides.h"
#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"
#include "tests/hil/firmware/third_party.h"

namespace omnihil {
namespace {

constexpr int kRobot = 3;

struct RoboteamTop : ThirdPartyImage {
  RoboteamTop() : ThirdPartyImage("roboteam-top-f767.elf", "roboteam_top_f767.toml") {}
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (IsSkipped()) return;
    setup_.model = load_robot_model("roboteam_2024", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
    std::vector<std::string> faults;
    add_effects(setup_.model, with_, faults);
    ASSERT_TRUE(faults.empty()) << faults[0];
    setup_.radio_format = "roboteam-rem-v8";
    setup_.robot_ids = {kRobot};
    setup_.plant.physics = Physics::kPlanar;
    session_ = std::make_unique<Session>(session_config(setup_),
                                         image_firmware(third_party_image(image_file_), board_file_));
    session_->set_observer(&answers_);
    run(kBoots_s);
  }
  void TearDown() override {
    if (session_) session_->set_observer(nullptr);
  }
  // `again` every 16 ms.
  void run(double duration_s, const std::vector<std::uint8_t>& again = {}) {
    const std::int64_t end_ns = session_->now_ns() + std::llround(duration_s * 1e9);
    while (session_->now_ns() < end_ns) {
      session_->step(session_->now_ns() % 16'000'000 == 0 ? again : std::vector<std::uint8_t>{}, out_);
    }
  }
  std::string report() {
    std::string all;
    for (const std::string& line : session_->firmware(0).report()) all += line + "\n";
    return all;
  }
  // Those of one kind, out of what came back since answers_ was cleared.
  std::vector<Values> answers(std::string_view message) const {
    const RadioFormat* format = find_radio_format("roboteam-rem-v8");
    std::vector<Values> found;
    constexpr std::size_t kHeader = 11;  // its last byte is the packet's length
    for (std::span<const std::uint8_t> rest = answers_.bytes; rest.size() >= kHeader;) {
      const std::size_t n = rest[kHeader - 1];
      if (n < kHeader || n > rest.size()) break;
      const DecodeResult result = format->decode(rest.first(n));
      EXPECT_EQ(result.error, PacketError::kNone);
      if (result.error == PacketError::kNone && result.values.message->name == message)
        found.push_back(result.values);
      rest = rest.subspan(n);
    }
    return found;
  }
  struct Answers final : SessionObserver {
    void dongle_bytes(std::int64_t, std::span<const std::uint8_t> b) override {
      bytes.insert(bytes.end(), b.begin(), b.end());
    }
    std::vector<std::uint8_t> bytes;
  };

  static constexpr double kBoots_s = 9.0;  // its waits for boards that are not there included
  std::vector<std::string> with_;
  SessionSetup setup_;
  Answers answers_;
  std::unique_ptr<Session> session_;
  std::vector<std::uint8_t> out_;
};

TEST_F(RoboteamTop, BootsWithoutAFaultAndNamesWhatIsNotModelled) {
  std::printf("%s", report().c_str());
  EXPECT_EQ(report().find("fault"), std::string::npos);
  EXPECT_EQ(report().find("reset by"), std::string::npos);
  EXPECT_EQ(report().find("0x4"), std::string::npos) << "an access without a name";
}

struct Move {
  double v_forward_m_s, v_left_m_s, omega_body_rad_s;
};

// What it says of its wheels, its gyro and its body is what they do.
TEST_F(RoboteamTop, AnswersEachCommandWithItsSensorsAsTheyAre) {
  std::size_t commands = 0;
  for (const Move& m : {Move{1.0, 0, 0}, Move{0, 0, 5.0}}) {
    const auto command = rem_command(kRobot, m.v_forward_m_s, m.v_left_m_s, m.omega_body_rad_s, true);
    run(1.0, command);
    answers_.bytes.clear();
    std::array<double, kWheels> wheel_rad_s{};
    double yaw_rate_rad_s = 0.0;
    constexpr int kSamples = 30;
    for (int i = 0; i < kSamples; ++i) {
      run(0.016, command);
      const RobotTruth t = session_->plant().truth(0);
      for (std::size_t w = 0; w < kWheels; ++w) wheel_rad_s[w] += t.omega_wheel_rad_s[w] / kSamples;
      yaw_rate_rad_s += t.omega_body_rad_s / kSamples;
    }
    commands = kSamples;
    const auto states = answers("REM_RobotStateInfo"), feedback = answers("REM_RobotFeedback");
    EXPECT_NEAR(static_cast<double>(states.size()), static_cast<double>(commands), 2.0);
    EXPECT_EQ(feedback.size(), states.size()) << "both in one frame of 127 bytes";
    ASSERT_FALSE(states.empty());
    const auto mean = [&states](const std::string& field) {
      double sum = 0.0;
      for (const Values& v : states) sum += v.number(field) / static_cast<double>(states.size());
      return sum;
    };
    // 8192 counts a turn in 10 ms: 0.077 rad/s a count; the field's step is 0.03.
    for (std::size_t w = 0; w < kWheels; ++w) {
      const double said = mean("wheelSpeed" + std::to_string(w + 1));
      EXPECT_NEAR(said, wheel_rad_s[w], 0.02 * std::abs(wheel_rad_s[w]) + 0.15) << w;
    }
    EXPECT_NEAR(mean("rateOfTurn"), yaw_rate_rad_s, 0.03 * std::abs(yaw_rate_rad_s) + 0.02);
    EXPECT_EQ(feedback.back().number("XsensCalibrated"), 1.0);
  }
}

// Wherever it looks: its yaw is the gyro's sum, and it turns what it is told into its own frame.
TEST_F(RoboteamTop, DrivesInTheDirectionThatTheHostSays) {
  for (const Move& m : {Move{1.0, 0, 0}, Move{0, 1.0, 0}, Move{-0.8, -0.6, 0}}) {
    run(0.5, rem_command(kRobot, 0, 0, 3.0));
    run(3.0);  // silence: it brakes
    const PlanarState from = session_->plant().planar_state(0);
    run(0.8, rem_command(kRobot, m.v_forward_m_s, m.v_left_m_s, m.omega_body_rad_s));
    const PlanarState to = session_->plant().planar_state(0);
    const double way_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    const double along_m = (to.x_m - from.x_m) * m.v_forward_m_s + (to.y_m - from.y_m) * m.v_left_m_s;
    std::printf("commanded %.1f %.1f m/s for 0.8 s from yaw %.2f: %.3f m, %.3f of it that way\n",
                m.v_forward_m_s, m.v_left_m_s, from.yaw_rad, way_m, along_m);
    EXPECT_GT(way_m, 0.3);
    EXPECT_GT(along_m, 0.98 * way_m);  // 11 degrees: it turns on while it brakes from 3 rad/s
  }
}

// Its controller is nearly feed-forward: each wheel gets the voltage that its own robot's friction was measured to need,
// 1.23 V and 0.0375 V s/rad. On 1.07 ohm and 0.0328 N m/A the first is 0.0377 N m.
struct RoboteamTopWithItsFriction : RoboteamTop {
  RoboteamTopWithItsFriction() { with_ = {"coulomb_friction.torque_Nm=0.0377"}; }
};

TEST_F(RoboteamTopWithItsFriction, ReachesTheSpeedThatTheHostSays) {
  for (const Move& m : {Move{1.0, 0, 0}, Move{0, 0.8, 0}, Move{0, 0, 5.0}}) {
    const auto command = rem_command(kRobot, m.v_forward_m_s, m.v_left_m_s, m.omega_body_rad_s);
    run(2.0);
    run(1.0, command);
    Move mean{0, 0, 0};
    constexpr int kSamples = 50;
    for (int i = 0; i < kSamples; ++i) {
      run(0.016, command);
      const RobotTruth t = session_->plant().truth(0);
      mean.v_forward_m_s += t.v_forward_m_s / kSamples;
      mean.v_left_m_s += t.v_left_m_s / kSamples;
      mean.omega_body_rad_s += t.omega_body_rad_s / kSamples;
    }
    // It takes the supply for 24 V without a power board that says otherwise; the model's is 22.2 V.
    if (m.v_forward_m_s > 0.0) {
      EXPECT_NEAR(mean.v_forward_m_s, m.v_forward_m_s, 0.1);
    }
    std::printf("commanded %.1f %.1f m/s %.1f rad/s: reached %.3f %.3f m/s %.3f rad/s\n", m.v_forward_m_s,
                m.v_left_m_s, m.omega_body_rad_s, mean.v_forward_m_s, mean.v_left_m_s, mean.omega_body_rad_s);
  }
}

}  // namespace
}  // namespace omnihil
