// An ODrive 3.6, unmodified, told by lines of text over its serial port and by CAN: it measures the motor, finds where its
// encoder is and turns the motor.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/hil/firmware/esc_image.h"

namespace omnihil {
namespace {

constexpr double kIdle = 1, kMeasureMotor = 4, kFindEncoder = 7, kClosedLoop = 8;  // states of an axis
constexpr unsigned kCanEstimates = 9, kCanSpeed = 13;                              // of axis 0
constexpr double kTurn_rad = 2 * std::numbers::pi;

struct Odrive : EscImage {
  Odrive()
      : EscImage("odrive-36-f405.elf", "odrive_36_f405.toml",
                 {.pwm_frequency_Hz = 24e3,
                  .dead_time_s = 20 / 168e6,
                  .switch_resistance_ohm = 0.002,
                  .diode_forward_V = 0.8},
                 {.extra_inertia_kg_m2 = 1e-4}) {}
  void SetUp() override {
    EscImage::SetUp();
    if (!bench_) return;
    board_->chip().find<mcu::Usart>("UART4")->on_transmit(
        [this](std::uint8_t byte, mcu::Cycles) { line_ += static_cast<char>(byte); });
    can_ = board_->chip().find<mcu::CanPort>("CAN1");
    can_->on_transmit([this](const mcu::CanFrame& frame, mcu::Cycles) {
      if (frame.id == kCanEstimates) estimates_ = frame;
    });
    // Offsets of its current amplifiers are taken for 1.5 s before its axes answer.
    wait(1.7);
    ASSERT_TRUE(comes_to(kIdle, 2.0));
    bench_->align("TIM1");
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
    put_bytes(frame.data, 0, static_cast<float>(turns_per_s));
    can_->receive(frame);
  }
  float said_by_can() const { return from_bytes<float>(estimates_.data, 4); }  // turns a second

  static constexpr double kCalibration_A = 5.0;
  mcu::CanPort* can_ = nullptr;
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
  const double dead_V = bridge_.dead_time_s * bridge_.pwm_frequency_Hz * kBus_V;
  const double ohm =
      windings_.resistance_ohm + bridge_.switch_resistance_ohm + 4.0 / 3.0 * dead_V / kCalibration_A;
  std::printf("measured %.4f ohm (%.4f)\n", measured_ohm, ohm);
  EXPECT_NEAR(measured_ohm, ohm, 0.01 * ohm);
  // Of pulses that alternate every T = 125 us it takes V T / (change of the current); with the winding's own decay that
  // change is 2 V / R tanh(R T / 2 L).
  const double measured_H = get("axis0.motor.config.phase_inductance"), L = windings_.inductance_q_H;
  const double half_decay = 125e-6 * (windings_.resistance_ohm + bridge_.switch_resistance_ohm) / (2 * L);
  const double henry = L * half_decay / std::tanh(half_decay);
  std::printf("measured %.1f uH (%.1f)\n", 1e6 * measured_H, 1e6 * henry);
  EXPECT_NEAR(measured_H, henry, 0.03 * henry);

  set("axis0.requested_state", kFindEncoder);
  wait(2.5);  // a second to settle, then it turns the field
  const auto& phase_A = motor().phase_A;
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
    const double from_rad = motor().theta_rad(), from_s = now_s();
    wait(0.5);
    const double reached = (motor().theta_rad() - from_rad) / kTurn_rad / (now_s() - from_s);
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
