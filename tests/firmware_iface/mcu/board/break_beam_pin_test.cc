// A board's pin follows the break beam's receiver.
#include <gtest/gtest.h>

#include "tests/firmware_iface/mcu/board/boards_for_tests.h"

namespace omnihil::mcu {
namespace {

TEST(BreakBeamPin, HasItsLevelWhileTheBallIsInTheBeam) {
  OMNIHIL_NEED_IMAGES();
  for (const bool high : {false, true}) {
    const auto firmware = wheels_firmware(std::string("[[pin]]\npin = \"PC13\"\nbreak_beam = \"") +
                                          (high ? "high" : "low") + "\"\n");
    ASSERT_NE(firmware, nullptr);
    PinBank& port = *firmware->board().chip().port('C');
    EXPECT_EQ(port.level(13), !high);
    RobotSensors sensors{};
    for (const bool seen : {true, true, false, true, false}) {
      sensors.now_us += 500;
      sensors.ball_seen = seen ? 1 : 0;
      firmware->tick(sensors);
      EXPECT_EQ(port.level(13), seen == high) << sensors.now_us;
    }
  }
}

}  // namespace
}  // namespace omnihil::mcu
