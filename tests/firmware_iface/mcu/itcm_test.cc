// RAM at address 0 (RM0410 2.3.1, 2.5: STM32F76x): ITCM at 0, flash at 0x00200000 and at 0x08000000; the core
// starts where BOOT_ADD0 says, which is 0x00200000 as the chips are delivered.
#include <gtest/gtest.h>

#include "firmware_iface/mcu/board/board.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

struct ItcmRun {
  explicit ItcmRun(BoardSpec spec) {
    std::vector<std::string> problems;
    EXPECT_TRUE(read_elf(image_bytes("itcm"), image, problems));
    board = std::make_unique<McuBoard>(spec, image);
    board->run_until_ns(1'000'000);
  }
  std::uint32_t word(std::string_view symbol) {
    return board->machine().bus_read(*image.address_of(symbol), 4);
  }
  ElfImage image;
  std::unique_ptr<McuBoard> board;
};
BoardSpec f767() {
  BoardSpec spec;
  spec.name = "f767";
  spec.chip = find_chip("stm32f767");
  return spec;
}

TEST(Itcm, CodeAndDataAtAddressZeroStayThere) {
  OMNIHIL_NEED_IMAGES();
  ItcmRun run(f767());
  EXPECT_EQ(run.word("done"), 1u);
  EXPECT_EQ(run.word("result"), 5u * 2 + 1000 + 5 * 3 + 1000);
  EXPECT_EQ(run.word("table_at"), 0u);
  EXPECT_EQ(run.board->machine().bus_read(0, 4), 3u);
}

TEST(Itcm, WhatAnImageHasPutAtZeroIsNoNullPointer) {
  OMNIHIL_NEED_IMAGES();
  ItcmRun run(f767());
  const MachineReport report = run.board->machine().report();
  EXPECT_EQ(report.null_access_count, 0u);
  EXPECT_EQ(report.fault_count, 0u);
}

TEST(Itcm, AResetLeavesTheRamWhereItIs) {
  OMNIHIL_NEED_IMAGES();
  ItcmRun run(f767());
  run.board->machine().reset("watchdog");
  EXPECT_EQ(run.board->machine().bus_read(0, 4), 3u) << "a reset does not clear RAM";
  run.board->run_until_ns(2'000'000);
  EXPECT_EQ(run.word("result"), 5u * 2 + 1000 + 5 * 3 + 1000) << "the start-up fills it again";
}

TEST(Itcm, MemoryRemappingBitsOfOtherFamiliesDoNothingOnF7) {
  OMNIHIL_NEED_IMAGES();
  ItcmRun run(f767());
  run.board->machine().bus_write(0x40013800, 4, 3);  // SYSCFG_MEMRMP: SRAM at 0 on an F4
  run.board->run_until_ns(1'100'000);
  EXPECT_EQ(run.board->machine().bus_read(0, 4), 3u);
}

TEST(Itcm, TheCoreStartsAtTheBootAddress) {
  OMNIHIL_NEED_IMAGES();
  ItcmRun delivered(f767());
  EXPECT_EQ(delivered.word("boot_address"), 0x00200000u);
  EXPECT_EQ(delivered.word("boot_option"), 0x00400080u);
  EXPECT_EQ(delivered.word("first_flash_word"), *delivered.image.address_of("stack_top"));
  BoardSpec spec = f767();
  spec.boot_address = 0x08000000;
  ItcmRun axim(spec);
  EXPECT_EQ(axim.word("boot_address"), 0x08000000u);
  EXPECT_EQ(axim.word("boot_option"), 0x00402000u);
  EXPECT_EQ(axim.word("result"), delivered.word("result"));
}

TEST(Itcm, ABoardNamesItsBootAddress) {
  const std::string head = "format = \"omnihil-board/1\"\nname = \"n\"\n",
                    motor = "[[motor]]\nwheel = 0\npwm = \"TIM1.1\"\n";
  const auto told = [&](const std::string& rest) {
    std::vector<BoardProblem> problems;
    const auto spec = read_board(head + rest + motor, "b.toml", problems);
    return problems.empty() ? std::to_string(spec->boot_address.value_or(1)) : problems.front().text();
  };
  EXPECT_EQ(told("chip = \"stm32f767\"\nboot_address = 0x08040000\n"), std::to_string(0x08040000));
  EXPECT_NE(told("chip = \"stm32f767\"\nboot_address = 0x08041000\n").find("16 KiB"), std::string::npos);
  EXPECT_NE(told("chip = \"stm32f767\"\nboot_address = 0x20000000\n").find("in flash"), std::string::npos);
  EXPECT_NE(told("chip = \"stm32f405\"\nboot_address = 0x08000000\n").find("no boot address"),
            std::string::npos);
}

}  // namespace
}  // namespace omnihil::mcu
