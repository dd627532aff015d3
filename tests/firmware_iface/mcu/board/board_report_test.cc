// What a board says at the end of a run.
#include <gtest/gtest.h>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

constexpr std::uint32_t kSpi1 = 0x40013000, kUsart1 = 0x40011000, kUsart2 = 0x40004400, kCan1 = 0x40006400,
                        kI2c1 = 0x40005400;

// A board whose image (four wheels) leaves these buses alone; the test writes their registers itself.
struct ReportBench {
  explicit ReportBench(const std::string& rest = "", const std::string& name = "wheels") {
    std::vector<BoardProblem> wrong;
    const auto spec = read_board(
        "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n"
        "[[motor]]\nwheel = 0\npwm = \"TIM1.1\"\ndirection = \"PE0\"\n" +
            rest,
        "b.toml", wrong);
    for (const BoardProblem& p : wrong) ADD_FAILURE() << p.text();
    std::vector<std::string> problems;
    EXPECT_TRUE(read_elf(image_bytes(name), image, problems));
    board = std::make_unique<McuBoard>(*spec, image);
    run_ms(1);
  }
  void run_ms(int ms) { board->run_until_ns(end_ns += ms * 1'000'000); }
  void set(std::uint32_t address, std::uint32_t value) { board->machine().bus_write(address, 4, value); }
  // The first line with these words; empty: none.
  std::string line(const std::string& words) const {
    for (const std::string& each : board_report(*board, image)) {
      if (each.find(words) != std::string::npos) return each;
    }
    return {};
  }
  void send_by_serial(std::uint32_t usart, unsigned bytes) {
    set(usart + 8, 84);
    set(usart + 0x0C, 1u << 13 | 1u << 3 | 1u << 2);
    for (unsigned i = 0; i < bytes; ++i) {
      set(usart + 4, i);
      run_ms(1);
    }
  }

  ElfImage image;
  std::unique_ptr<McuBoard> board;
  std::int64_t end_ns = 0;
};

TEST(BoardReport, BytesOfASpiWithNoDeviceSelectedAreCounted) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b;
  EXPECT_EQ(b.line("SPI1"), "");
  b.set(kSpi1, 1u << 6 | 1u << 2);
  for (int i = 0; i < 3; ++i) {
    b.set(kSpi1 + 0x0C, 0x55);
    b.run_ms(1);
  }
  EXPECT_NE(b.line("SPI1").find("3 bytes sent with no device selected, the first at 0.001"),
            std::string::npos)
      << b.line("SPI1");
}

TEST(BoardReport, ASelectedDeviceHearsThem) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b("[[device]]\nkind = \"icm20689\"\nbus = \"SPI1\"\nselect = \"PA4\"\n");
  b.set(0x40020000, 1u << 8);                // PA4 is an output
  b.set(0x40020000 + 0x18, 1u << (16 + 4));  // and low
  b.set(kSpi1, 1u << 6 | 1u << 2);
  b.set(kSpi1 + 0x0C, 0xF5);
  b.run_ms(1);
  EXPECT_EQ(b.line("SPI1"), "");
  b.set(0x40020000 + 0x18, 1u << 4);
  b.set(kSpi1 + 0x0C, 0xF5);
  b.run_ms(1);
  EXPECT_NE(b.line("SPI1").find("1 byte sent with no device selected"), std::string::npos) << b.line("SPI1");
}

TEST(BoardReport, BytesOfASerialPortThatLeadsNowhereAreCounted) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b("[radio]\nformat = \"ulaval-hermes\"\nvia = \"USART1\"\n");
  b.send_by_serial(kUsart2, 4);
  b.send_by_serial(kUsart1, 4);
  EXPECT_NE(b.line("USART2").find("4 bytes sent, the port leads nowhere"), std::string::npos)
      << b.line("USART2");
  EXPECT_EQ(b.line("USART1"), "");
}

TEST(BoardReport, BytesThatTheReceiverMissesAreCounted) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b("[radio]\nformat = \"ulaval-hermes\"\nvia = \"USART2\"\n");
  const std::uint8_t bytes[] = {1, 2, 3};
  b.board->radio_receive(bytes);
  b.run_ms(1000);
  EXPECT_NE(b.line("receiver").find("3 bytes came while the receiver was off"), std::string::npos)
      << b.line("USART2");
  b.set(kUsart2 + 8, 84);
  b.set(kUsart2 + 0x0C, 1u << 13 | 1u << 2);
  b.board->radio_receive(bytes);
  b.run_ms(1000);
  EXPECT_NE(b.line("overrun").find("2 bytes came before the one before them was read"), std::string::npos)
      << b.line("USART2: 2");
}

TEST(BoardReport, CanFramesThatNobodyTakesAreCounted) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b;
  CanPort& can = *b.board->chip().find<CanPort>("CAN1");
  CanFrame frame{.id = 0x123, .bytes = 2};
  can.receive(frame);
  EXPECT_NE(b.line("not on the bus").find("1 frame came"), std::string::npos) << b.line("CAN1");
  b.set(kCan1, 0);  // on the bus
  can.receive(frame);
  can.receive(frame);
  EXPECT_NE(b.line("no filter").find("2 frames came"), std::string::npos) << b.line("CAN1");
  b.set(kCan1 + 0x180, 0x123u << 21 | 1u);
  b.run_ms(10);
  EXPECT_NE(b.line("acknowledge").find("1 frame sent, nobody is there to acknowledge"), std::string::npos)
      << b.line("CAN1");
}

TEST(BoardReport, AddressesThatNoDeviceHasAreCounted) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b;
  b.set(kI2c1 + 4, 42);
  b.set(kI2c1 + 0x1C, 210);
  b.set(kI2c1, 1);
  b.set(kI2c1, 1 | 1u << 8);
  b.run_ms(1);
  b.board->machine().bus_read(kI2c1 + 0x14, 4);
  b.set(kI2c1 + 0x10, 0x40u << 1);
  b.run_ms(1);
  EXPECT_NE(b.line("I2C1").find("1 call to address 0x40, which no device has"), std::string::npos)
      << b.line("I2C1");
}

TEST(BoardReport, WhatIsNotModelledHasItsBlocksName) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b;
  b.board->machine().bus_read(0x50050034, 4);
  EXPECT_NE(b.line("DCMI").find("not modelled: DCMI: 0x50050034 (offset 0x34) read"), std::string::npos);
  b.set(0x4000C000, 1);
  EXPECT_NE(b.line("0x4000c000").find("not modelled: bus: 0x4000c000 written"), std::string::npos);
}

TEST(BoardReport, ABoardSaysItsOwnChip) {
  OMNIHIL_NEED_IMAGES();
  std::vector<BoardProblem> problems;
  const auto spec = read_board(
      "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"STM32F407\"\n[[motor]]\nwheel = 0\n"
      "pwm = \"TIM1.1\"\n",
      "b.toml", problems);
  ElfImage image;
  std::vector<std::string> wrong;
  read_elf(image_bytes("wheels"), image, wrong);
  EXPECT_EQ(McuFirmware(*spec, image, RobotConfig{}).name(), "image on n (stm32f407)");
}

TEST(BoardReport, AFaultIsNamedOnceWithItsFunctionAndHowOftenItCame) {
  OMNIHIL_NEED_IMAGES();
  ReportBench b("", "faults");
  b.run_ms(199);
  const std::string fault = b.line("HardFault");
  EXPECT_NE(fault.find("read_nowhere"), std::string::npos) << fault;
  EXPECT_NE(fault.find("address 0xc0000000"), std::string::npos) << fault;
  const std::uint64_t resets = b.board->machine().report().fault_count;
  ASSERT_GT(resets, 3u);
  EXPECT_NE(fault.find(std::to_string(resets) + " times, first at 0.0"), std::string::npos) << fault;
  const std::string reset = b.line("reset by");
  EXPECT_NE(reset.find("reset by software " + std::to_string(resets) + " times, first at 0.0"),
            std::string::npos)
      << reset;
  int lines = 0;
  for (const std::string& line : board_report(*b.board, b.image))
    lines += line.find("reset by") != std::string::npos || line.find("HardFault") != std::string::npos;
  EXPECT_EQ(lines, 2);
}

}  // namespace
}  // namespace omnihil::mcu
