// Every bus: whatever comes over the wire, duties stay finite and within -1..1, and the robot goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

// Ids near those that the buses listen to, contents at random with runs of zeros and of NaN bytes.
BusFrame random_frame(std::mt19937& random, BusCarrier carrier) {
  static constexpr std::uint32_t kIds[] = {0x000, 0x010, 0x100, 0x110,  0x310,
                                           0x007, 0x00D, 0x027, 0x8001, 0x0001};
  static constexpr std::uint8_t kSizes[] = {0, 2, 4, 8, 12, 20, 52, 64};
  BusFrame f;
  f.id = carrier == BusCarrier::kUart ? random() % 5
                                      : kIds[random() % std::size(kIds)] + random() % 5 + 32 * (random() % 4);
  f.fd = carrier == BusCarrier::kCanFd || random() % 50 == 0;
  f.extended = f.id > 0x7FF;
  f.remote = carrier == BusCarrier::kCan && random() % 10 == 0;
  f.size = f.remote ? 0 : kSizes[random() % std::size(kSizes)];
  if (carrier == BusCarrier::kCan && !f.fd) f.size = std::min<std::uint8_t>(f.size, 8);
  const unsigned style = random() % 3;
  for (std::size_t i = 0; i < f.size; ++i) {
    f.data[i] = style == 0 ? static_cast<std::uint8_t>(random()) : static_cast<std::uint8_t>(random() % 34);
    if (style == 2 && i % 4 >= 2) f.data[i] = static_cast<std::uint8_t>(random() % 2 == 0 ? 0x7F : 0xC0);
  }
  return f;
}

// A bus with a checksum would take none of them: every second one is made whole.
void make_whole(BusFrame& f, std::mt19937& random) {
  static constexpr std::uint8_t kHead[] = {0xAA, 0xBB, 0xCC, 0};
  f.size = 10;
  std::copy(std::begin(kHead), std::end(kHead), f.data.begin());
  f.data[4] = static_cast<std::uint8_t>(random() % 10);
  unsigned crc = 0xFF;
  for (std::size_t i = 0; i < 9; ++i) {
    crc ^= f.data[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1 ^ ((crc & 0x80) != 0 ? 0x2F : 0)) & 0xFF;
  }
  f.data[9] = static_cast<std::uint8_t>(crc ^ 0xFF);
}

class EveryBusTest : public testing::TestWithParam<const MotorBusKind*> {};

TEST_P(EveryBusTest, random_frames_never_give_a_drive_that_no_bridge_takes) {
  std::mt19937 random(7);
  BusRig rig(GetParam()->id);
  std::uint64_t sent = 0;
  for (int ms = 0; ms < 3000; ++ms) {
    for (int i = 0; i < 10; ++i, ++sent) {
      BusFrame f = random_frame(random, GetParam()->carrier);
      if (GetParam()->id == "thunderbots-spi" && i % 2 == 0) make_whole(f, random);
      rig.send(f);
    }
    ASSERT_NO_THROW(rig.run_ms(1)) << ms;  // a state that is not finite throws
    rig.wire->from_motors.clear();
    for (const double duty : rig.firmware->feedback().duty_ratio) {
      ASSERT_TRUE(std::isfinite(duty) && std::abs(duty) <= 1.0) << ms;
    }
  }
  std::uint64_t counted = 0;
  for (const std::uint64_t n : rig.firmware->counts().received) counted += n;
  EXPECT_EQ(counted, sent);  // each under one cause
  EXPECT_GT(rig.count(BusVerdict::kOk), 0U);
}

TEST_P(EveryBusTest, says_what_it_is) {
  EXPECT_FALSE(GetParam()->title.empty());
  EXPECT_EQ(find_motor_bus(GetParam()->id), GetParam());
  EXPECT_GT(GetParam()->bit_rate, 0);
}

INSTANTIATE_TEST_SUITE_P(Buses, EveryBusTest, testing::ValuesIn(motor_buses().begin(), motor_buses().end()),
                         [](const auto& each) {
                           std::string name(each.param->id);
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace omnihil::test
