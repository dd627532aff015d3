// Register map and pointer of the AS5600 as its data sheet (v1-06, figures 19 to 22) has them.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {
namespace {

struct As5600Bench {
  explicit As5600Bench(std::map<std::string, double, std::less<>> settings = {}) {
    DeviceWorld world;
    world.now_ns = [] { return std::int64_t{0}; };
    world.angle_rad = [this](std::int64_t) { return angle_rad; };
    world.settings = std::move(settings);
    device = find_device("as5600")->make(world);
    device->reset();
  }
  void write(std::vector<std::uint8_t> bytes) {
    device->i2c()->start(false);
    for (const std::uint8_t byte : bytes) device->i2c()->write(byte);
  }
  unsigned word(std::uint8_t at) {
    write({at});
    device->i2c()->start(true);
    const unsigned high = device->i2c()->read();
    return high << 8 | device->i2c()->read();
  }
  double angle_rad = 0.0;
  std::unique_ptr<Device> device;
};

TEST(As5600, GivesTheAngleInTwelveBits) {
  As5600Bench b;
  EXPECT_EQ(b.device->i2c()->address(), 0x36);
  for (const double turn : {0.0, 0.25, 0.5, 0.999}) {
    b.angle_rad = 2.0 * std::numbers::pi * (turn + 3.0) + 1e-9;
    EXPECT_EQ(b.word(0x0C), static_cast<unsigned>(turn * 4096.0)) << turn;
    EXPECT_EQ(b.word(0x0E), b.word(0x0C));
  }
  b.angle_rad = -0.25 * 2.0 * std::numbers::pi + 1e-9;
  EXPECT_EQ(b.word(0x0C), 3072u);
}

TEST(As5600, TheStartPositionMovesAngleAndNotRawAngle) {
  As5600Bench b;
  b.angle_rad = std::numbers::pi + 1e-9;
  b.write({0x01, 0x04, 0x00});  // ZPOS = 1024
  EXPECT_EQ(b.word(0x01), 0x0400u);
  EXPECT_EQ(b.word(0x0C), 2048u);
  EXPECT_EQ(b.word(0x0E), 1024u);
}

TEST(As5600, ThePointerComesBackAndTheLowByteIsOfTheHighOnesInstant) {
  As5600Bench b;
  b.angle_rad = 2.0 * std::numbers::pi * 0x123 / 4096.0 + 1e-9;
  b.write({0x0C});
  b.device->i2c()->start(true);
  EXPECT_EQ(b.device->i2c()->read(), 0x01);
  b.angle_rad += 1.0;
  EXPECT_EQ(b.device->i2c()->read(), 0x23);
  b.angle_rad = 0.0;
  EXPECT_EQ(b.device->i2c()->read(), 0x00) << "the high byte again";
}

TEST(As5600, SaysThatAMagnetIsThere) {
  As5600Bench b;
  b.write({0x0B});
  b.device->i2c()->start(true);
  EXPECT_EQ(b.device->i2c()->read() & 0x38, 0x20);  // MD, not ML, not MH
}

TEST(As5600, TurnsRoundAndShiftsByItsSettings) {
  As5600Bench b({{"direction", -1.0}, {"offset_rad", std::numbers::pi}});
  b.angle_rad = 0.25 * 2.0 * std::numbers::pi - 1e-9;
  EXPECT_EQ(b.word(0x0C), 1024u);
}

}  // namespace
}  // namespace omnihil::mcu
