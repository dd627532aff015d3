// A board's pin follows the break beam's receiver.
#include <gtest/gtest.h>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

TEST(BreakBeamPin, HasItsLevelWhileTheBallIsInTheBeam) {
  OMNIHIL_NEED_IMAGES();
  for (const bool high : {false, true}) {
    std::vector<BoardProblem> wrong;
    const auto spec =
        read_board(std::string("format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n"
                               "[[motor]]\nwheel = 0\npwm = \"TIM1.1\"\ndirection = \"PE0\"\n"
                               "[[pin]]\npin = \"PC13\"\nbreak_beam = \"") +
                       (high ? "high" : "low") + "\"\n",
                   "b.toml", wrong);
    for (const BoardProblem& p : wrong) ADD_FAILURE() << p.text();
    ASSERT_TRUE(spec.has_value());
    ElfImage image;
    std::vector<std::string> problems;
    ASSERT_TRUE(read_elf(image_bytes("wheels"), image, problems));
    RobotConfig config{};
    config.gear_ratio = 3.0;
    config.wheel_radius_m = 0.027;
    config.encoder_counts_per_rotor_turn = 4096.0;
    config.bus_voltage_nominal_V = 24.0;
    McuFirmware firmware(*spec, image, config);
    GpioPort& port = *firmware.board().chip().port('C');
    EXPECT_EQ(port.level(13), !high);
    RobotSensors sensors{};
    for (const bool seen : {true, true, false, true, false}) {
      sensors.now_us += 500;
      sensors.ball_seen = seen ? 1 : 0;
      firmware.tick(sensors);
      EXPECT_EQ(port.level(13), seen == high) << sensors.now_us;
    }
  }
}

}  // namespace
}  // namespace omnihil::mcu
