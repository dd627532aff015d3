// An ODrive 3.6, unmodified, told by lines of text over its serial port and by CAN: it measures the motor, finds where its
// encoder is and turns the motor.
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "hil/loop/model_store.h"
#include "tests/hil/firmware/motor_on_board.h"
#include "tests/hil/firmware/third_party.h"

namespace omnihil {
namespace {

constexpr double kIdle = 1, kMeasureMotor = 4, kFindEncoder = 7, kClosedLoop = 8;  // states of an axis
constexpr unsigned kCanEstimates = 9, kCanSpeed = 13;                              // of axis 0
constexpr double kTurn_rad = 2 * std::numbers::pi;

struct Odrive : ThirdPartyImage {
  Odrive() : ThirdPartyImage("odrive-36-f405.elf", "odrive_36_f405.toml") {}
  void SetUp() override {
    ThirdPartyImage::SetUp();
    if (IsSkipped()) return;
    const StoredModel df45 = load_model("nanotec_df45", {OMNIHIL_SOURCE_DIR "/models"});
    ASSERT_TRUE(df45.model);
    windings_ = phase_motor_of(df45.model->motor, Commutation::kBlock, {.shape = BackEmfShape::kSine});
    board_ = board();
    board_->chip().find<mcu::Usart>("UART4")->on_transmit(
        [this](std::uint8_t byte, mcu::Cycles) { line_ += static_cast<char>(byte); });
    can_ = board_->chip().find<mcu::CanPort>("CAN1");
    can_->on_transmit([this](const mcu::CanFrame& frame, mcu::Cycles) {
      if (frame.id == kCanEstimates) estimates_ = frame;
    });
    bench_ = std::make_unique<MotorsOnBoard>(*board_, kBus_V, kCounts);
    bench_->add({.wheel = 0,
                 .drive = make_switched_drive(windings_, kBridge, {.extra_inertia_kg_m2 = 1e-4}),
                 .load_Nm = 0.01});
    // Offsets of its current amplifiers are taken for 1.5 s before its axes answer.
    wait(1.7);
    ASSERT_TRUE(comes_to(kIdle, 2.0));
  }
  void wait(double duration_s) {
    const std::int64_t end_ns = board_->now_ns() + std::llround(duration_s * 1e9);
    while (board_->now_ns() < end_ns) bench_->period();
  }
  void say(const std::string& text) {
    const std::string line = text + "\n";
    auto* serial = board_->chip().find<mcu::Usart>("UART4");
    serial->feed(std::span(reinterpret_cast<const std::uint8_t*>(line.data()), line.size()),
                 board_->now_ns());
    wait(1e-4 * static_cast<double>(line.size()) + 2e-3);  // at 115,200 baud, and its task's turn
  }
  std::string ask(const std::string& text) {
    line_.clear();
    say(text);
    for (int i = 0; i < 50 && line_.find('\n') == std::string::npos; ++i) wait(1e-3);
    return line_.substr(0, line_.find('\r'));
  }
  void set(const std::string& name, double value) {
    char text[24];
    std::snprintf(text, sizeof text, "%.6f", value);
    say("w " + name + " " + text);
  }
  double get(const std::string& name) { return std::strtod(ask("r " + name).c_str(), nullptr); }
  bool comes_to(double state, double patience_s) {
    const std::int64_t end_ns = board_->now_ns() + std::llround(patience_s * 1e9);
    while (board_->now_ns() < end_ns && get("axis0.current_state") != state) wait(0.05);
    return get("axis0.current_state") == state;
  }
  std::string errors() {
    std::string all;
    for (const char* of : {"", "axis0.", "axis0.motor.", "axis0.encoder.", "axis0.controller.", "axis1."}) {
      const std::string said = ask(std::string("r ") + of + "error");
      if (said != "0") all += std::string(of) + "error " + said + "\n";
    }
    return all;
  }
  void say_speed_by_can(double turns_per_s) {
    mcu::CanFrame frame;
    frame.id = kCanSpeed;
    frame.bytes = 8;
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(turns_per_s));
    for (unsigned i = 0; i < 4; ++i) frame.data[i] = static_cast<std::uint8_t>(bits >> 8 * i);
    can_->receive(frame);
  }
  float said_by_can() const {  // turns a second
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; ++i) bits |= std::uint32_t{estimates_.data[4 + i]} << 8 * i;
    return std::bit_cast<float>(bits);
  }

  static constexpr double kBus_V = 24.0, kCounts = 4000, kCalibration_A = 5.0;
  static constexpr Inverter kBridge{.pwm_frequency_Hz = 24e3,
                                    .dead_time_s = 20 / 168e6,
                                    .switch_resistance_ohm = 0.002,
                                    .diode_forward_V = 0.8};
  PhaseMotor<double> windings_;
  std::unique_ptr<mcu::McuBoard> board_;
  mcu::CanPort* can_ = nullptr;
  std::unique_ptr<MotorsOnBoard> bench_;
  std::string line_;
  mcu::CanFrame estimates_;
};

TEST_F(Odrive, SaysWhoItIsAndNamesWhatIsNotModelled) {
  EXPECT_EQ(ask("i"), "Hardware version: 3.6-56V");
  wait(0.05);  // the lines behind it
  EXPECT_NEAR(get("vbus_voltage"), kBus_V, 0.05);
  EXPECT_NEAR(get("axis0.motor.fet_thermistor.temperature"), 25.0, 0.5);
  EXPECT_EQ(errors(), "");
  EXPECT_TRUE(board_->device("driver0")->drives_bridge());
  EXPECT_TRUE(board_->device("driver1")->drives_bridge());
  std::string all;
  for (const std::string& line : report(*board_)) all += line + "\n";
  for (const char* bad : {"fault", "IWDG", "locked", "TIM1:", "TIM8:", "SPI3:", "DMA1:", "DMA2:"})
    EXPECT_EQ(all.find(bad), std::string::npos) << all;
  EXPECT_EQ(board_->machine().report().resets.size(), 2u) << "power-on and its own: " << all;
}

// It does not make up for the dead time: that takes t_dead f V_bus off each leg, 4/3 of it in the direction of a current
// that enters by one leg and leaves by two.
TEST_F(Odrive, SlowMeasuresTheMotorFindsItsEncoderAndTurnsAsItIsTold) {
  set("axis0.motor.config.pole_pairs", windings_.pole_pairs);
  set("axis0.motor.config.torque_constant", 1.5 * windings_.pole_pairs * windings_.flux_linkage_Wb);
  set("axis0.motor.config.calibration_current", kCalibration_A);
  set("axis0.motor.config.resistance_calib_max_voltage", 6.0);
  set("axis0.encoder.config.cpr", kCounts);
  set("axis0.encoder.config.calib_scan_distance", 4 * kTurn_rad);
  set("axis0.controller.config.vel_limit", 80.0);
  set("axis0.controller.config.vel_gain", 0.01);
  set("axis0.controller.config.vel_integrator_gain", 0.1);
  set("config.dc_max_negative_current", -20.0);

  set("axis0.requested_state", kMeasureMotor);
  ASSERT_TRUE(comes_to(kIdle, 6.0));
  EXPECT_EQ(get("axis0.motor.is_calibrated"), 1.0) << errors();
  const double measured_ohm = get("axis0.motor.config.phase_resistance");
  const double dead_V = kBridge.dead_time_s * kBridge.pwm_frequency_Hz * kBus_V;
  const double ohm =
      windings_.resistance_ohm + kBridge.switch_resistance_ohm + 4.0 / 3.0 * dead_V / kCalibration_A;
  std::printf("measured %.4f ohm (%.4f)\n", measured_ohm, ohm);
  EXPECT_NEAR(measured_ohm, ohm, 0.01 * ohm);
  // Alternating pulses, which this bridge does not follow: its own measurement of this one is not used.
  set("axis0.motor.config.phase_inductance", windings_.inductance_q_H);

  set("axis0.requested_state", kFindEncoder);
  wait(2.5);  // a second to settle, then it turns the field
  const auto& phase_A = bench_->motors[0].phase_A;
  const double amplitude_A =
      std::sqrt(2.0 / 3.0 * (phase_A[0] * phase_A[0] + phase_A[1] * phase_A[1] + phase_A[2] * phase_A[2]));
  EXPECT_NEAR(amplitude_A, kCalibration_A, 0.05 * kCalibration_A) << "its current loop holds what it reads";
  ASSERT_TRUE(comes_to(kIdle, 12.0));
  EXPECT_EQ(get("axis0.encoder.is_ready"), 1.0) << errors();

  set("axis0.requested_state", kClosedLoop);
  for (const double told : {10.0, -30.0, 20.0}) {
    const bool by_can = told == 20.0;
    if (by_can) {
      say_speed_by_can(told);
    } else {
      say("v 0 " + std::to_string(told));
    }
    wait(1.5);
    const double from_rad = bench_->motors[0].theta_rad(),
                 from_s = 1e-9 * static_cast<double>(board_->now_ns());
    wait(0.5);
    const double reached = (bench_->motors[0].theta_rad() - from_rad) / kTurn_rad /
                           (1e-9 * static_cast<double>(board_->now_ns()) - from_s);
    const std::string reply = ask("f 0");  // position and speed
    const double said = by_can ? said_by_can() : std::strtod(reply.c_str() + reply.find(' '), nullptr);
    std::printf("told %g turns/s by %s: reached %.3f, it says %.3f\n", told, by_can ? "CAN" : "text", reached,
                said);
    EXPECT_NEAR(reached, told, 0.005 * std::abs(told));
    EXPECT_NEAR(said, told, 0.02 * std::abs(told));
  }
  EXPECT_EQ(errors(), "");
  set("axis0.requested_state", kIdle);
  EXPECT_TRUE(comes_to(kIdle, 0.2));
}

}  // namespace
}  // namespace omnihil
