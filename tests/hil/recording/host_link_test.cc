// Host classes that other teams wrote, at our bench: what they wrote to their dongles, fed in again at the same times. All of it
// is taken, every answer is one that they would understand, and the robots drive as they were told.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "firmware_iface/host_firmware.h"
#include "hil/recording/session_setup.h"
#include "hil/recording/stream_file.h"
#include "hil/recording/stream_frames.h"

namespace omnihil {
namespace {

using Bytes = std::vector<std::uint8_t>;

class HostLink : public ::testing::Test {
 protected:
  void at(const char* radio, const char* stream, std::vector<int> ids, Team team) {
    SessionSetup setup;
    setup.model = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
    setup.radio_format = radio;
    setup.robot_ids = std::move(ids);
    setup.team = team;
    setup.plant.physics = Physics::kPlanar;
    stream_ = load_stream(std::string(OMNIHIL_SOURCE_DIR "/tests/data/hosts/") + stream, "");
    session_ = std::make_unique<Session>(session_config(setup), make_reference_firmware);
  }
  void run_until(double time_s) {
    Bytes bytes;
    while (session_->now_ns() < static_cast<std::int64_t>(std::llround(1e9 * time_s))) {
      bytes.clear();
      for (; next_ < stream_.chunks.size() && stream_.chunks[next_].at_ns <= session_->now_ns(); ++next_)
        bytes.insert(bytes.end(), stream_.chunks[next_].bytes.begin(), stream_.chunks[next_].bytes.end());
      session_->step(bytes, answer_);
    }
  }
  double end_s() const { return 1e-9 * static_cast<double>(stream_.duration_ns()) + 0.1; }
  RobotTruth truth(int place) const { return session_->plant().truth(place); }

  HostStream stream_;
  std::size_t next_ = 0;
  std::unique_ptr<Session> session_;
  Bytes answer_;  // all that came back
};

// As Master::execute reads: AA 55, number, eleven bytes for each robot, FF. How often each robot answered that it is well.
std::vector<int> well(std::span<const std::uint8_t> bytes, int& lists) {
  constexpr std::size_t kRobot = 11;
  std::vector<int> count(8);
  std::size_t i = 0;
  for (lists = 0; i + 3 < bytes.size(); ++lists) {
    const std::size_t robots = bytes[i + 2], end = i + 3 + kRobot * robots;
    if (bytes[i] != 0xAA || bytes[i + 1] != 0x55 || robots > 8 || end >= bytes.size() || bytes[end] != 0xFF)
      break;
    for (std::size_t k = 0; k < robots; ++k)
      if ((bytes[i + 3 + kRobot * k + 2] & 1U) != 0) ++count[bytes[i + 3 + kRobot * k]];
    i = end + 1;
  }
  EXPECT_EQ(i, bytes.size()) << "what is left is no answer";
  return count;
}

TEST_F(HostLink, RhobansMasterDrivesSixRobotsAndHearsEachAfterEachList) {
  at("rhoban-master-serial", "rhoban-master.txt", {0, 1, 2, 3, 4, 5}, Team::kYellow);
  std::uint64_t written = 0;  // its first write is three lines for the board's shell
  for (const StreamChunk& chunk : stream_.chunks) written += chunk.bytes.front() == 0xAA ? 1 : 3;
  run_until(3.6);  // 1.3 s after they began to move
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(truth(k).v_forward_m_s, 0.6 * std::cos(k * std::numbers::pi / 3.0), 0.02) << k;
    EXPECT_NEAR(truth(k).v_left_m_s, 0.6 * std::sin(k * std::numbers::pi / 3.0), 0.02) << k;
  }
  run_until(5.1);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(truth(k).omega_body_rad_s, 1.0 + 0.2 * k, 0.05) << k;
  run_until(end_s());
  EXPECT_GT(written, 250u);
  EXPECT_EQ(session_->link().from_host().good, written);
  EXPECT_EQ(session_->link().from_host().refused(), 0u);
  int lists = 0;
  const std::vector<int> count = well(answer_, lists);
  EXPECT_EQ(static_cast<std::uint64_t>(lists), written - 3);
  for (int k = 0; k < 6; ++k) EXPECT_GE(count[static_cast<std::size_t>(k)], lists - 1) << k;
  EXPECT_EQ(count[6] + count[7], 0);
}

TEST_F(HostLink, AteamsHelperShakesHandsDrivesReadsAParameterAndSaysGoodbye) {
  at("ateam-rnp-stspin-2025", "ateam-rnp-helper.txt", {7}, Team::kYellow);
  run_until(1.9);
  EXPECT_NEAR(truth(0).v_forward_m_s, 0.8, 0.02);
  EXPECT_NEAR(truth(0).v_left_m_s, 0.0, 0.02);
  run_until(3.4);
  EXPECT_NEAR(truth(0).v_forward_m_s, 0.0, 0.02);
  EXPECT_NEAR(truth(0).v_left_m_s, 0.5, 0.02);
  run_until(4.4);
  EXPECT_NEAR(truth(0).omega_body_rad_s, 3.0, 0.05);
  run_until(end_s());
  EXPECT_EQ(session_->link().from_host().good, 303u) << "hello, 300 controls, a parameter, goodbye";
  EXPECT_EQ(session_->link().from_host().refused(), 0u);

  const RadioFormat& format = *find_radio_format("ateam-rnp-stspin-2025");
  FrameCutter cutter(format);
  cutter.push(answer_);
  cutter.finish();
  std::map<std::string, int> heard;
  double sequence = -1.0;
  while (const auto frame = cutter.next()) {
    ASSERT_TRUE(frame->understood);
    const DecodeResult result = format.decode(frame->bytes);
    ++heard[std::string(result.values.message->name)];
    if (result.values.message->name != "telemetry") continue;
    EXPECT_EQ(result.values.number("sequence"), sequence + 1.0) << "in order";
    sequence = result.values.number("sequence");
  }
  EXPECT_EQ(heard["telemetry"], 501) << "every 10 ms of 5 s, and the first at once";
  EXPECT_EQ(heard["robot_parameter_command"], 1);
  EXPECT_EQ(heard["hello_request"], 2) << "before the handshake, and again after the goodbye";
}

}  // namespace
}  // namespace omnihil
