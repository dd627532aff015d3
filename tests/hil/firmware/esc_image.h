// A motor controller that none of us wrote, on its board, with a Nanotec DF45 at its first bridge and nothing else.
//
//   struct Vesc : EscImage {
//     Vesc() : EscImage("vesc-410-f405.elf", "vesc_410_f405.toml", {.pwm_frequency_Hz = 25e3}, {}) {}
//   };
//   TEST_F(Vesc, …) { wait(0.5);  EXPECT_NEAR(motor().omega_rad_s(), …); }
#pragma once
#include <string>

#include "hil/loop/model_store.h"
#include "tests/hil/firmware/motor_on_board.h"
#include "tests/hil/firmware/third_party.h"

namespace omnihil {

inline PhaseMotor<double> df45_windings(BackEmfShape shape) {
  const StoredModel df45 = load_model("nanotec_df45", {OMNIHIL_SOURCE_DIR "/models"});
  EXPECT_TRUE(df45.model);
  return df45.model ? phase_motor_of(df45.model->motor, Commutation::kBlock, {.shape = shape})
                    : PhaseMotor<double>{};
}

class EscImage : public ThirdPartyImage {
 protected:
  EscImage(std::string image, const std::string& board, const Inverter& bridge,
           const SwitchedOptions& options)
      : ThirdPartyImage(std::move(image), board), bridge_(bridge), options_(options) {}

  // Where it is skipped or failed there is no bench_.
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    board_ = board();
    bench_ = std::make_unique<MotorsOnBoard>(*board_, kBus_V, kCounts);
    bench_->add(
        {.wheel = 0, .drive = make_switched_drive(windings_, bridge_, options_), .load_Nm = kFriction_Nm});
  }
  void wait(double duration_s) {
    const std::int64_t end_ns = board_->now_ns() + std::llround(duration_s * 1e9);
    while (board_->now_ns() < end_ns) bench_->period();
  }
  const MotorOnBoard& motor() const { return bench_->motors[0]; }
  double now_s() const { return 1e-9 * static_cast<double>(board_->now_ns()); }

  static constexpr double kBus_V = 24.0, kCounts = 4000, kFriction_Nm = 0.01;
  const PhaseMotor<double> windings_ = df45_windings(BackEmfShape::kSine);
  const Inverter bridge_;
  const SwitchedOptions options_;
  std::unique_ptr<mcu::McuBoard> board_;
  std::unique_ptr<MotorsOnBoard> bench_;
};

}  // namespace omnihil
