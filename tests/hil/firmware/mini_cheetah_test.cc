// The mini cheetah's motor controller, unmodified: current loop at 40 kHz from two shunts and an angle sensor, told by CAN.
#include <cmath>
#include <cstdio>

#include "firmware_iface/mcu/stm32/can.h"
#include "tests/hil/firmware/esc_image.h"

namespace omnihil {
namespace {

// Its scales: position, speed, both gains, torque. Torque by its settings: 40 A at 0.0363 N m/A.
constexpr double kPosition_rad = 12.5, kSpeed_rad_s = 65.0, kStiffness = 500.0, kDamping = 5.0,
                 kTorque_Nm = 1.452;

unsigned scaled(double value, double low, double high, unsigned bits) {
  return static_cast<unsigned>((value - low) / (high - low) * ((1u << bits) - 1u));
}

mcu::CanFrame command(double speed_rad_s, double damping, double torque_Nm = 0.0) {
  const unsigned p = scaled(0.0, -kPosition_rad, kPosition_rad, 16),
                 v = scaled(speed_rad_s, -kSpeed_rad_s, kSpeed_rad_s, 12),
                 kp = scaled(0.0, 0.0, kStiffness, 12), kd = scaled(damping, 0.0, kDamping, 12),
                 t = scaled(torque_Nm, -kTorque_Nm, kTorque_Nm, 12);
  mcu::CanFrame frame;
  frame.id = 1;
  frame.bytes = 8;
  const unsigned bytes[] = {p >> 8, p, v >> 4, v << 4 | kp >> 8, kp, kd >> 4, kd << 4 | t >> 8, t};
  for (std::size_t i = 0; i < 8; ++i) frame.data[i] = static_cast<std::uint8_t>(bytes[i]);
  return frame;
}

mcu::CanFrame mode(std::uint8_t last) {
  mcu::CanFrame frame;
  frame.id = 1;
  frame.bytes = 8;
  for (std::size_t i = 0; i < 8; ++i) frame.data[i] = i == 7 ? last : std::uint8_t{0xFF};
  return frame;
}

struct MiniCheetah : EscImage {
  MiniCheetah()
      : EscImage("mini-cheetah-f446.elf", "mini_cheetah_f446.toml",
                 {.pwm_frequency_Hz = 180e6 / (2 * 2250),
                  .dead_time_s = 50e-9,
                  .switch_resistance_ohm = 0.002,
                  .diode_forward_V = 0.8},
                 {}) {}
  void SetUp() override {
    EscImage::SetUp();
    if (!bench_) return;
    can_ = board_->chip().find<mcu::CanPort>("CAN1");
    can_->on_transmit([this](const mcu::CanFrame& frame, mcu::Cycles) { replies_.push_back(frame); });
  }
  // The command every 5 ms; the mean speed of the last half.
  double run(double duration_s, const mcu::CanFrame& frame) {
    const std::int64_t from_ns = board_->now_ns(), end_ns = from_ns + std::llround(duration_s * 1e9);
    double half_rad = 0.0, half_s = 0.0;
    while (board_->now_ns() < end_ns) {
      if (board_->now_ns() >= next_ns_) {
        can_->receive(frame);
        next_ns_ = board_->now_ns() + 5'000'000;
      }
      bench_->period();
      if (half_s == 0.0 && board_->now_ns() - from_ns > (end_ns - from_ns) / 2) {
        half_s = now_s();
        half_rad = motor().theta_rad();
      }
    }
    return (motor().theta_rad() - half_rad) / (now_s() - half_s);
  }

  mcu::CanPort* can_ = nullptr;
  std::vector<mcu::CanFrame> replies_;
  std::int64_t next_ns_ = 0;
};

TEST_F(MiniCheetah, BootsWithoutAFaultAndNamesWhatIsNotModelled) {
  wait(0.5);
  std::string all;
  for (const std::string& line : report(*board_)) all += line + "\n";
  for (const char* bad : {"fault", "reset by", "null pointer", "not modelled"}) {
    EXPECT_EQ(all.find(bad), std::string::npos) << all;
  }
  EXPECT_FALSE(board_->device("driver")->drives_bridge()) << "its coast bit is set until it is told to run";
}

// Its law: torque = damping * (asked - measured speed), so that friction over damping is missing. Of the numbers as its
// packet can say them.
TEST_F(MiniCheetah, SpinsTheMotorAsCanSaysButForItsFriction) {
  wait(0.3);
  can_->receive(mode(0xFC));
  wait(0.01);
  EXPECT_TRUE(board_->device("driver")->drives_bridge());
  constexpr double kAskedDamping = 0.02;
  const double damping = scaled(kAskedDamping, 0.0, kDamping, 12) * kDamping / 4095.0;
  for (const double asked_rad_s : {20.0, -30.0, 10.0}) {
    const double reached_rad_s = run(0.6, command(asked_rad_s, kAskedDamping));
    const double said_rad_s =
        scaled(asked_rad_s, -kSpeed_rad_s, kSpeed_rad_s, 12) * 2 * kSpeed_rad_s / 4095.0 - kSpeed_rad_s;
    const double expected_rad_s = said_rad_s - std::copysign(kFriction_Nm, asked_rad_s) / damping;
    ASSERT_FALSE(replies_.empty());
    const mcu::CanFrame& reply = replies_.back();
    const unsigned word = reply.data[3] << 4u | reply.data[4] >> 4u;
    const double replied_rad_s = word * 2 * kSpeed_rad_s / 4095.0 - kSpeed_rad_s;
    std::printf("commanded %g rad/s: reached %.2f (%.2f by its law), replied %.2f\n", asked_rad_s,
                reached_rad_s, expected_rad_s, replied_rad_s);
    EXPECT_NEAR(reached_rad_s, expected_rad_s, 0.1);  // three steps of its packet's speed
    EXPECT_NEAR(replied_rad_s, reached_rad_s,
                1.0);  // of one instant; its torque ripples by the winding's harmonics
    EXPECT_EQ(reply.data[0], 1);
  }
}

// Without a command for 1000 periods it forgets what it was told; the last byte FD lets the bridge go.
TEST_F(MiniCheetah, ForgetsItsCommandAndLeavesItsModeWhenTold) {
  wait(0.3);
  can_->receive(mode(0xFC));
  run(0.4, command(20.0, 0.02));
  wait(0.3);
  EXPECT_LT(std::abs(motor().omega_rad_s()), 5.0) << "friction brakes it";
  EXPECT_TRUE(board_->device("driver")->drives_bridge());
  can_->receive(mode(0xFD));
  wait(0.01);
  EXPECT_FALSE(board_->device("driver")->drives_bridge());
}

}  // namespace
}  // namespace omnihil
