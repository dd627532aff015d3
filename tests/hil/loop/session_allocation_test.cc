// The loop allocates nothing once it is warm (the multibody library aside).
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/loop/session.h"
#include "hil/recording/session_setup.h"
#include "protocols/radio_format.h"

namespace {
// Counts while switched on, in this thread alone.
thread_local bool counting = false;
thread_local std::size_t allocations = 0;

void* counted(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace omnihil {
namespace {

struct Case {
  const char *robot, *radio, *message;
  std::vector<std::pair<std::string, double>> fields;
};

std::size_t allocations_of_a_second(const Case& c) {
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
  allocations = 0;
  counting = true;
  second();
  counting = false;
  EXPECT_GT(session.link().from_host().good, 300u);
  return allocations;
}

TEST(SessionAllocationTest, TheCounterCounts) {
  allocations = 0;
  counting = true;
  const std::vector<int> some(100);
  counting = false;
  EXPECT_EQ(allocations, some.size() / 100);
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
