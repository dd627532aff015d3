// A team's library in its own process: the same numbers as in this one; whatever it does wrong is contained
// and said in words.
#include "hil/firmware/guarded_firmware.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <future>
#include <stdexcept>
#include <thread>

#include "firmware_iface/host_firmware.h"
#include "hil/loop/reference_firmware.h"
#include "hil/loop/session_checks.h"
#include "sim/robot/electric_model.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

const std::string kLibraries = std::string(OMNIHIL_BUILD_DIR) + "/tests/firmware/lib";

RobotConfig config() { return robot_config(symmetric_robot(), 3); }

GuardedLibrary library(const std::string& name, double deadline_s = 10.0) {
  return {kLibraries + name + ".so", deadline_s};
}

RobotSensors sensors_at(int tick) {
  RobotSensors s{};
  s.now_us = static_cast<std::uint64_t>(tick) * 1000;
  s.bus_voltage_V = 24.0;
  for (int w = 0; w < kWheels; ++w) s.encoder_counts[w] = 7 * tick * (w + 1);
  return s;
}

RobotCommand forward_command() {
  RobotCommand c{};
  c.mode = OMNIHIL_MODE_BODY_VELOCITY;
  c.v_forward_m_s = 0.7;
  return c;
}

// Ticks until the firmware fails or `ticks` are over.
std::string failure_of(GuardedFirmware& firmware, int ticks = 300) {
  for (int n = 1; n <= ticks && firmware.failure().empty(); ++n) {
    firmware.command(forward_command(), n * 1'000'000);
    firmware.tick(sensors_at(n));
  }
  return std::string(firmware.failure());
}

std::string failure_of(const std::string& name, double deadline_s = 10.0) {
  GuardedFirmware firmware(library(name, deadline_s), config());
  return failure_of(firmware);
}

std::string refusal_of(const std::string& name, double deadline_s = 10.0) {
  try {
    GuardedFirmware firmware(library(name, deadline_s), config());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(GuardedFirmware, AnswersBitForBitAsInThisProcess) {
  GuardedFirmware guarded(
      {std::string(OMNIHIL_BUILD_DIR) + "/firmware_iface/libomnihil_reference_firmware.so"}, config());
  const std::unique_ptr<HostFirmware> host = make_reference_firmware(config());
  EXPECT_EQ(guarded.name(), host->name());
  EXPECT_EQ(guarded.radio_format(), host->radio_format());
  EXPECT_EQ(guarded.control_period_ns(), host->control_period_ns());
  for (int n = 0; n < 500; ++n) {
    for (Firmware* f : {static_cast<Firmware*>(&guarded), static_cast<Firmware*>(host.get())}) {
      if (n % 10 == 0) f->command(forward_command(), n * 1'000'000);
    }
    const RobotDrive a = guarded.tick(sensors_at(n)), b = host->tick(sensors_at(n));
    ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << "tick " << n;
    const RobotFeedback fa = guarded.feedback(), fb = host->feedback();
    ASSERT_EQ(std::memcmp(&fa, &fb, sizeof fa), 0) << "tick " << n;
  }
  RobotGains gains = host->gains();
  gains.p[3] *= 2.0;
  EXPECT_EQ(guarded.set_gains(gains), host->set_gains(gains));
  EXPECT_EQ(guarded.gains().p[3], gains.p[3]);
}

TEST(GuardedFirmware, RadioFramesPassBothWays) {
  GuardedFirmware guarded(
      {std::string(OMNIHIL_BUILD_DIR) + "/firmware_iface/libomnihil_reference_firmware.so"}, config());
  const std::unique_ptr<HostFirmware> host = make_reference_firmware(config());
  // PING_REQUEST to robot 3: version 1, source FE, robot, type 0, sum of the others; COBS of it, then 00
  const std::uint8_t ping[] = {0x04, 0x01, 0xFE, 0x03, 0x02, 0x02, 0x00};
  std::array<std::uint8_t, 64> a{}, b{};
  guarded.radio_receive(ping, 0);
  host->radio_receive(ping, 0);
  guarded.tick(sensors_at(1));
  host->tick(sensors_at(1));
  const std::size_t n = host->radio_transmit(b);
  ASSERT_GT(n, 0u);
  EXPECT_EQ(guarded.radio_transmit(a), n);
  EXPECT_EQ(a, b);
  EXPECT_EQ(guarded.radio_transmit(a), 0u);
}

TEST(GuardedFirmware, MotorTicksPassAsInThisProcess) {
  RobotModel model = symmetric_robot();
  model.motor.pole_pairs = 8;
  ElectricModel electric;
  electric.kind = DriveKind::kDq;
  model.electric = std::make_shared<const ElectricModel>(electric);
  const MotorConfig motors = motor_config(model);
  GuardedFirmware guarded(library("foc"), config(), motors);
  const std::unique_ptr<HostFirmware> host = make_foc_firmware(config(), motors);
  ASSERT_TRUE(guarded.drives_phases());
  for (int n = 1; n < 200; ++n) {
    MotorSensors seen{};
    seen.now_ns = static_cast<std::uint64_t>(n) * 50'000;
    seen.bus_voltage_V = 24.0;
    for (int w = 0; w < kWheels; ++w) seen.theta_elec_rad[w] = 0.01 * n * (w + 1);
    if (n % 20 == 1) {
      for (Firmware* f : {static_cast<Firmware*>(&guarded), static_cast<Firmware*>(host.get())}) {
        f->command(forward_command(), n * 50'000);
        f->tick(sensors_at(n / 20));
      }
    }
    const MotorDrive a = guarded.motor_tick(seen), b = host->motor_tick(seen);
    ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << "motor tick " << n;
  }
}

TEST(GuardedFirmware, NullPointerIsNamedWithCallAndTick) {
  const std::string failure = failure_of("null_pointer");
  EXPECT_TRUE(has(failure, "null pointer")) << failure;
  EXPECT_TRUE(has(failure, "in tick(), tick 100 (0.100 s)")) << failure;
  EXPECT_EQ(failure, failure_of("null_pointer"));
}

TEST(GuardedFirmware, AfterItsEndTheWheelsCoast) {
  GuardedFirmware firmware(library("null_pointer"), config());
  failure_of(firmware);
  const RobotDrive drive = firmware.tick(sensors_at(400));
  for (int w = 0; w < kWheels; ++w) EXPECT_EQ(drive.mode[w], std::uint32_t{OMNIHIL_DRIVE_COAST});
  std::array<std::uint8_t, 64> frame{};
  EXPECT_EQ(firmware.radio_transmit(frame), 0u);
  EXPECT_FALSE(firmware.set_gains({}));
}

pid_t only_child() {
  std::ifstream children(fmt::format("/proc/self/task/{}/children", ::getpid()));
  pid_t child = 0;
  children >> child;
  return child;
}

TEST(GuardedFirmware, ADebuggerMayHoldItBeyondTheDeadline) {
  constexpr double kDeadline_s = 0.5;  // more than a loaded computer keeps a process from its core
  constexpr int kHeld_ms = 1500;       // it lets go just as a deadline ends
  GuardedFirmware firmware(
      {std::string(OMNIHIL_BUILD_DIR) + "/firmware_iface/libomnihil_reference_firmware.so", kDeadline_s},
      config());
  firmware.tick(sensors_at(1));
  const pid_t child = only_child();
  ASSERT_GT(child, 0);
  std::promise<bool> holds;
  std::thread debugger([&] {
    const bool attached = ::ptrace(PTRACE_ATTACH, child, nullptr, nullptr) == 0;
    if (attached) ::waitpid(child, nullptr, __WALL);
    holds.set_value(attached);
    ::poll(nullptr, 0, kHeld_ms);
    if (attached) ::ptrace(PTRACE_DETACH, child, nullptr, nullptr);
  });
  const bool attached = holds.get_future().get();
  if (attached) firmware.tick(sensors_at(2));
  debugger.join();
  if (!attached) GTEST_SKIP() << "this system allows no ptrace";
  EXPECT_EQ(firmware.failure(), "");
  EXPECT_EQ(failure_of(firmware), "");
}

TEST(GuardedFirmware, HangEndsAtTheDeadline) {
  const std::string failure = failure_of("hang", 0.3);
  EXPECT_TRUE(has(failure, "did not return within 0.3 s")) << failure;
  EXPECT_TRUE(has(failure, "in tick(), tick 100")) << failure;
}

TEST(GuardedFirmware, AbortAndExitAreNamed) {
  EXPECT_TRUE(has(failure_of("abort"), "SIGABRT, it called abort()) in tick(), tick 100"));
  EXPECT_TRUE(has(failure_of("exit"), "ended its process with exit code 3, in tick(), tick 100"));
}

TEST(GuardedFirmware, AccessBehindTheStateBlockIsNamedWithItsPlace) {
  const std::string near = failure_of("behind_state"), far = failure_of("far_behind");
  EXPECT_TRUE(has(near, "outside its state block")) << near;
  EXPECT_TRUE(has(near, "in tick(), tick 100")) << near;
  EXPECT_TRUE(has(far, "outside its state block")) << far;
}

TEST(GuardedFirmware, StackOverflowIsNamed) {
  const std::string failure = failure_of("deep_recursion");
  EXPECT_TRUE(has(failure, "stack overflow")) << failure;
}

TEST(GuardedFirmware, NumbersThatNoBridgeTakesCoastThatWheelAndCount) {
  GuardedFirmware firmware(library("not_a_number"), config());
  EXPECT_EQ(failure_of(firmware), "");
  EXPECT_EQ(firmware.faults().duty_not_finite, 201u);  // ticks 100 to 300
  const RobotDrive drive = firmware.tick(sensors_at(400));
  EXPECT_EQ(drive.mode[1], std::uint32_t{OMNIHIL_DRIVE_COAST});
  EXPECT_EQ(drive.mode[0], std::uint32_t{OMNIHIL_DRIVE_DUTY});
}

TEST(GuardedFirmware, FrameLongerThanItsBufferIsDroppedAndCounted) {
  GuardedFirmware firmware(library("long_frame"), config());
  EXPECT_EQ(failure_of(firmware, 5), "");
  EXPECT_EQ(firmware.faults().frame_too_long, 5u);
}

TEST(GuardedFirmware, FilesThatAreNoFirmwareAreRefusedWithTheReason) {
  EXPECT_TRUE(has(refusal_of("bad_table"), "tick is NULL")) << refusal_of("bad_table");
  EXPECT_TRUE(has(refusal_of("bad_table"), "control_period_us = 0")) << refusal_of("bad_table");
  EXPECT_TRUE(has(refusal_of("crash_at_load"), "not its own) in loading the library"))
      << refusal_of("crash_at_load");
  EXPECT_TRUE(has(refusal_of("hang_in_init", 0.3), "in init()")) << refusal_of("hang_in_init", 0.3);
  EXPECT_TRUE(has(refusal_of("refuses"), "refused the configuration of robot 3 with code 7"));
  EXPECT_TRUE(has(refusal_of("of_nothing"), "cannot be loaded")) << refusal_of("of_nothing");
}

}  // namespace
}  // namespace omnihil
