// The loop allocates nothing once it is warm (the multibody library aside).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/loop/session.h"
#include "hil/recording/session_setup.h"
#include "protocols/radio_format.h"
#include "tests/count_allocations.h"

namespace omnihil {
namespace {

struct Case {
  const char *robot, *radio, *message;
  std::vector<std::pair<std::string, double>> fields;
};

std::uint64_t allocations_of_a_second(const Case& c) {
  SessionSetup setup;
  setup.model = load_robot_model(c.robot, {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = c.radio;
  setup.robot_ids = {0, 1, 2, 3, 4, 5};
  setup.plant.physics = Physics::kPlanar;
  Session session(session_config(setup), make_reference_firmware);
  const RadioFormat* radio = find_radio_format(c.radio);
  std::vector<std::uint8_t> command, answer;
  for (int robot = 0; robot < 6; ++robot) {
    Values values;
    values.message = radio->find(c.message);
    values.set(c.fields[0].first, robot);
    for (std::size_t i = 1; i < c.fields.size(); ++i) values.set(c.fields[i].first, c.fields[i].second);
    EXPECT_EQ(radio->encode(values, command).error, PacketError::kNone);
  }
  const std::vector<std::uint8_t> garbage(40, 0x5a);
  answer.reserve(1 << 20);
  const auto second = [&] {
    for (int k = 0; k < 1000; ++k) {
      if (k % 33 == 0) {
        session.step(command, answer);
      } else if (k % 100 == 50) {
        session.step(garbage, answer);
      } else {
        session.step({}, answer);
      }
      answer.clear();
    }
    session.host_closed();
  };
  second();
  const std::uint64_t before = allocations;
  second();
  const std::uint64_t counted = allocations - before;
  EXPECT_GT(session.link().from_host().good, 300u);
  return counted;
}

TEST(SessionAllocationTest, TheCounterCounts) {
  const std::uint64_t before = allocations;
  const std::vector<int> some(100);
  EXPECT_EQ(allocations - before, some.size() / 100);
}

TEST(SessionAllocationTest, AWarmLoopAllocatesNothingWithHermes) {
  EXPECT_EQ(
      allocations_of_a_second({"omni_default", "ulaval-hermes", "SPEED_MOVE", {{"robot", 0}, {"vx", 0.5}}}),
      0u);
}

TEST(SessionAllocationTest, AWarmLoopAllocatesNothingWithRem) {
  EXPECT_EQ(allocations_of_a_second(
                {"roboteam_2024",
                 "roboteam-rem-v8",
                 "REM_RobotCommand",
                 {{"toRobotId", 0}, {"toColor", 1}, {"fromPC", 1}, {"rho", 0.5}, {"sendStateInfo", 1}}}),
            0u);
}

}  // namespace
}  // namespace omnihil
