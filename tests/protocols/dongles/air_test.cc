// Every dongle asks the air: where it takes everything nothing reaches a robot and no robot answers, where it takes
// nothing all is as without one.
#include <gtest/gtest.h>

#include "protocols/radio_format.h"

namespace omnihil {
namespace {

struct FixedAir : RadioAir {
  explicit FixedAir(bool takes_all) : takes(takes_all) {}
  bool lost(int, AirWay way) override {
    (way == AirWay::kToRobot ? to_robot : to_host) += 1;
    return takes;
  }
  bool takes;
  int to_robot = 0, to_host = 0;
};

struct Count : RadioSink {
  void deliver(const Delivery& delivery, std::int64_t) override {
    drives += delivery.command.v_forward_m_s != 0.0;
  }
  int drives = 0;
};

struct Passed {
  int drives = 0;                 // commands that drive and reached a robot
  std::uint64_t from_robots = 0;  // packets of robots, as the dongle saw them
};

Passed drive(const RadioFormat& format, RadioAir* air) {
  RadioLinkConfig config;
  config.robot_ids = {1};
  config.air = air;
  config.wheel_radius_m = 0.027;
  const auto link = format.make_link(config);
  Count sink;
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 0.5;
  std::vector<std::uint8_t> packet, out;
  for (std::int64_t n = 0; n < 2'000; ++n) {
    const std::int64_t now_ns = n * 1'000'000;
    packet.clear();
    if (n % 20 == 0)
      format.encode_command(command, {.robot_id = 1, .team = config.team, .set_up = n == 0}, packet);
    if (!packet.empty()) link->host_bytes(packet, now_ns);
    link->poll(now_ns, sink);
    link->robot_feedback(1, RobotFeedback{}, RobotGains{}, now_ns);
    link->take_host_bytes(now_ns, out);
  }
  return {sink.drives, link->from_robots().good};
}

class EveryDongle : public testing::TestWithParam<const RadioFormat*> {};

TEST_P(EveryDongle, AsksTheAirForWhatPasses) {
  const RadioFormat& format = *GetParam();
  if (format.encode_command == nullptr || (format.command_drives & drives(OMNIHIL_MODE_BODY_VELOCITY)) == 0)
    GTEST_SKIP() << "has no packet for a body velocity";
  const Passed without = drive(format, nullptr);
  FixedAir clear(false), dead(true);
  const Passed passed = drive(format, &clear), none = drive(format, &dead);
  EXPECT_EQ(passed.drives, without.drives);
  EXPECT_EQ(passed.from_robots, without.from_robots);
  EXPECT_EQ(none.drives, 0);
  // A dongle that collects its robots' answers in a list gives the list all the same, with nothing in it.
  if (format.list == nullptr) {
    EXPECT_EQ(none.from_robots, 0U);
  }
  EXPECT_GE(clear.to_robot, without.drives);
  EXPECT_GE(static_cast<std::uint64_t>(clear.to_host), without.from_robots);
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryDongle,
                         testing::ValuesIn(radio_formats().begin(), radio_formats().end()),
                         [](const auto& param) {
                           std::string name(param.param->id);
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace omnihil
