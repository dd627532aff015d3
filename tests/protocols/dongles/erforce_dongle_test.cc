// ER-Force: the serial line's greeting, trajectories as commands, acknowledged datagrams.
#include <cmath>
#include <string>

#include "tests/protocols/dongles/links_harness.h"
#include "tests/protocols/packet_util.h"

namespace omnihil {
namespace {

constexpr const char* kId = "erforce-proto2025";
constexpr double kStep_m_s = 12.0 / 4095.0;
constexpr double kStep_rad_s = 40.0 * M_PI / 1023.0;

Bytes letters(const std::string& text) { return Bytes(text.begin(), text.end()); }

TEST(ErForceDongle, TheGreetingIsAnsweredWithTheRobotsId) {
  Bench bench(kId, {.robot_ids = {7}});
  bench.write_byte_by_byte(letters("start-connection\r"));
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.to_host, letters("robot_id 7\n"));
  EXPECT_EQ(bench.good(), 1u);
}

TEST(ErForceDongle, ASplineIsItsVelocityAtTimeZero) {
  for (const char* id : {kId, "erforce-proto2025-bridge"}) {
    for (const char* packet : {"local_spline", "global_spline"}) {
      Bench bench(id, {.robot_ids = {7}});
      bench.write(bench.encode(packet, {{"trajectory.x_vel", 1.5},
                                        {"trajectory.y_vel", -0.5},
                                        {"trajectory.phi_vel", 4.0},
                                        {"dribbler", 0.5},
                                        {"shot_power", 255},
                                        {"chip", 1}}));
      bench.run_to(2 * kMs);
      ASSERT_EQ(bench.sink.heard.size(), 1u);
      const RobotCommand& command = bench.sink.heard[0].command;
      EXPECT_EQ(command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
      EXPECT_EQ(command.flags != 0, packet == std::string("global_spline"));
      EXPECT_NEAR(command.v_forward_m_s, 1.5, kStep_m_s);
      EXPECT_NEAR(command.v_left_m_s, -0.5, kStep_m_s);
      EXPECT_NEAR(command.omega_body_rad_s, 4.0, kStep_rad_s);
      EXPECT_NEAR(command.dribbler_ratio, 0.5, 2.0 / 255.0);
      EXPECT_EQ(command.kick, unsigned{OMNIHIL_KICK_CHIP});
      EXPECT_NEAR(command.v_kick_m_s, 6.5, 1e-12);
    }
  }
}

TEST(ErForceDongle, HaltStopsAndStandbyLetsTheWheelsRunFree) {
  Bench bench(kId, {.robot_ids = {7}});
  bench.write(bench.encode("halt", {}) + bench.encode("halt", {{"standby", 1}}));
  bench.run_to(2 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 2u);
  EXPECT_EQ(bench.sink.heard[0].command.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(bench.sink.heard[0].command.v_forward_m_s, 0.0);
  EXPECT_EQ(bench.sink.heard[1].command.mode, unsigned{OMNIHIL_MODE_COAST});
}

TEST(ErForceDongle, EveryPacketIsAnsweredWithItsCounterAndTheRobotsState) {
  Bench bench(kId, {.robot_ids = {7}});
  bench.robots[7].yaw_rad = M_PI / 2;
  bench.robots[7].v_forward_m_s = 1.0;
  bench.robots[7].battery_V = 12.6;
  bench.step();
  bench.write(bench.encode("halt", {{"counter", 42}}));
  bench.run_to(3 * kMs);
  const auto answers = bench.answers("response");
  ASSERT_EQ(answers.size(), 1u);
  const Values& state = answers[0].values;
  EXPECT_EQ(state.number("counter"), 42.0);
  EXPECT_NEAR(state.number("battery"), 0.5, 1.0 / 255.0);
  EXPECT_NEAR(state.number("measured_phi"), M_PI / 2, 2 * M_PI / 16383.0);
  EXPECT_NEAR(state.number("measured_vel_y"), 1.0, 12.0 / 32767.0) << "forward is along y";
}

TEST(ErForceDongle, AnEmptyFrameIsNothingAndADamagedOneIsCounted) {
  Bench bench(kId, {.robot_ids = {7}});
  Bytes damaged = bench.encode("halt", {{"counter", 5}});
  damaged[1] ^= 0x02;
  bench.write(Bytes{0, 0} + damaged + bench.encode("halt", {}));
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kChecksum), 1u);
  EXPECT_EQ(bench.good(), 1u);
  EXPECT_EQ(bench.link->from_host().refused(), 1u);
}

// Their own host and robot, with parts that were lost: what the robot's header says after each packet.
TEST(ErForceDongle, AcknowledgesDatagramsAsTheirRobotDoes) {
  if (shared_folder().empty()) GTEST_SKIP() << "OMNIHIL_SHARED does not name the folder of reference data";
  Bench bench(kId, {.robot_ids = {7}});
  bench.boot_robots();
  bench.step();
  int compared = 0;
  const nlohmann::json all = read_json(shared_folder() + "/vectors/erforce-proto2025.json");
  for (const nlohmann::json& step : all.at("session")) {
    if (!step.at("robot_rx_ok").get<bool>()) continue;  // lost on the air
    const Bytes sent = from_hex(step.at("host_tx"));
    Values values;
    const bool is_datagram = (sent[0] & 0x80) != 0;
    // Their other packets hold no command: a halt in place of it.
    values.message = bench.format.find(is_datagram ? "echo" : "halt");
    values.set("counter", sent[0] & 63);
    values.set("acknum", sent[0] >> 6 & 1);
    if (is_datagram) values.set("seqnum", sent[1] & 1);
    Bytes frame;
    ASSERT_EQ(bench.format.encode(values, frame).error, PacketError::kNone);
    bench.to_host.clear();
    bench.write(frame);
    bench.run_to(bench.now_ns + 3 * kMs);
    const auto answers = bench.answers("response");
    ASSERT_EQ(answers.size(), 1u);
    const Bytes back = from_hex(step.at("host_rx"));
    EXPECT_EQ(answers[0].values.number("counter"), back[0] & 63) << step;
    EXPECT_EQ(answers[0].values.number("acknum"), back[0] >> 6 & 1) << step;
    ++compared;
  }
  EXPECT_EQ(compared, 27);
}

}  // namespace
}  // namespace omnihil
