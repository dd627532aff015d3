// A motor controller that none of us wrote at one wheel of a robot, which drags the others over the floor.
#include <cmath>
#include <cstdio>

#include "hil/firmware/image_firmware.h"
#include "hil/recording/session_setup.h"
#include "sim/robot/electric_model.h"
#include "tests/hil/firmware/third_party.h"
#include "tests/hil/firmware/vesc_line.h"
#include "tests/hil/one_robot.h"

namespace omnihil {
namespace {

struct EscOnRobot : ThirdPartyImage {
  EscOnRobot() : ThirdPartyImage("vesc-410-f405.elf", "vesc_410_f405.toml") {}
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    SessionSetup setup = test::one_robot("omni_foc");
    const SessionConfig config = session_config(setup);
    motor_ = phase_motor(config.robots[0]);
    session_ = std::make_unique<Session>(
        config,
        image_firmware(third_party_image(image_file_), board_file_, {},
                       {.on_board = [this](const MadeBoard& made) { board_ = &made.mcu; }, .ports = false}));
    ASSERT_NE(board_, nullptr);
  }
  void step() {
    std::vector<std::uint8_t> out;
    session_->step({}, out);
  }
  double omega_rad_s() const { return session_->plant().truth(0).omega_rotor_rad_s[0]; }
  double erpm() const { return omega_rad_s() * motor_.pole_pairs * 60.0 / (2 * std::numbers::pi); }

  PhaseMotor<double> motor_;
  std::unique_ptr<Session> session_;
  mcu::McuBoard* board_ = nullptr;
};

// Its bridge is open then: all that it knows of the speed is the phases' voltages. It reports the speed of its angle's PLL,
// whose gains of 2000 and 30000, as delivered, are a filter with poles at 15.1 and 1985 rad/s.
TEST_F(EscOnRobot, SlowAVescTurnsTheWheelAndFollowsItWhileItRollsOut) {
  using namespace vesc;
  constexpr double kPole_rad_s = 15.1;
  double followed_erpm = 0.0;
  const auto run = [&] {
    step();
    followed_erpm += (erpm() - followed_erpm) * -std::expm1(-1e-3 * kPole_rad_s);
  };
  VescLine line(*board_, run);
  line.set_motor(motor_.resistance_ohm, motor_.inductance_q_H, motor_.flux_linkage_Wb, 15.0F);
  const std::int32_t told = 12'000;
  Bytes speed{kSpeed}, release{kCurrent};
  put_big(speed, told);
  put_big(release, 0);
  for (int n = 0; n < 3000; ++n) {
    if (n % 100 == 0) line.say(speed);
    run();
  }
  std::printf("told %d ERPM: reached %.0f\n", told, erpm());
  EXPECT_NEAR(erpm(), told, 0.05 * told);
  line.say(release);
  for (int n = 0; n < 200; ++n) run();
  const double from_erpm = erpm();
  for (int n = 0; n < 10; ++n) {
    for (int i = 0; i < 50; ++i) run();
    const double said_erpm = get_big(line.ask({kValues}), 23);
    std::printf("rolls at %.0f ERPM, behind its PLL %.0f: it says %.0f\n", erpm(), followed_erpm, said_erpm);
    EXPECT_NEAR(said_erpm, followed_erpm, 0.02 * from_erpm);
  }
  EXPECT_GT(from_erpm, 0.5 * told);
  EXPECT_LT(erpm(), 0.7 * from_erpm);
}

}  // namespace
}  // namespace omnihil
