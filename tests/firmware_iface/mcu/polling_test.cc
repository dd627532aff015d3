// An image that polls for its period: loops that wait are skipped, and nothing of what it does changes by that.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/stm32/usart.h"
#include "tests/firmware_iface/mcu/board/dialects_for_tests.h"
#include "tests/firmware_iface/mcu/image_bench.h"

namespace omnihil::mcu {
namespace {

constexpr std::int64_t kRun_ns = 60'000'000;

struct PollingWheel : testing::Test {
  void SetUp() override {
    OMNIHIL_NEED_IMAGES();
    const std::string file = OMNIHIL_SOURCE_DIR "/boards/ateam_wheel_f031.toml";
    const std::vector<std::uint8_t> text = file_bytes(file);
    std::vector<BoardProblem> wrong;
    spec_ = read_board(std::string(text.begin(), text.end()), file, wrong, with_dialects());
    ASSERT_TRUE(spec_);
    std::vector<std::string> problems;
    ASSERT_TRUE(read_elf(image_bytes("polling_wheel"), image_, problems));
  }

  // With a command on the way, and a shaft that turns.
  std::unique_ptr<McuBoard> run(bool fast_forward, std::int64_t step_ns,
                                MachineObserver* observer = nullptr) {
    auto board = std::make_unique<McuBoard>(*spec_, image_);
    board->machine().cpu().fast_forward = fast_forward;
    board->machine().observe(observer);
    WorldState world;
    world.bus_voltage_V = 24.0;
    world.encoder_counts_per_rotor_turn = 4000;
    world.omega_rotor_rad_s[0] = 30.0;
    board->set_world(world);
    std::vector<std::uint8_t> command(52);
    command[0] = 0x21;
    command[18] = 0xC8, command[19] = 0x42;  // 100.0f
    for (std::int64_t at_ns = 0; at_ns < kRun_ns; at_ns += step_ns) {
      if (at_ns % 10'000'000 == 0) board->chip().find<Usart>("USART1")->feed(command, board->now_ns());
      board->run_until_ns(at_ns + step_ns);
    }
    return board;
  }
  std::uint32_t word(McuBoard& board, std::string_view symbol) {
    std::uint8_t raw[4] = {};
    board.machine().memory().read(*image_.address_of(symbol), raw);
    return raw[0] | raw[1] << 8 | raw[2] << 16 | static_cast<std::uint32_t>(raw[3]) << 24;
  }

  std::optional<BoardSpec> spec_;
  ElfImage image_;
};

TEST_F(PollingWheel, RunsItsPeriodAndHearsItsCommand) {
  const auto board = run(true, 500'000);
  EXPECT_NEAR(word(*board, "turns"), kRun_ns / 1'000'000, 2);
  EXPECT_EQ(word(*board, "missed"), 0u);
  EXPECT_EQ(word(*board, "setpoint_rad_s"), 0x42C80000u);
  EXPECT_EQ(board->machine().report().resets.size(), 1u);
}

TEST_F(PollingWheel, SkippingItsWaitChangesNothing) {
  const auto skipped = run(true, 500'000), executed = run(false, 500'000), cut = run(true, 100'000);
  for (McuBoard* other : {executed.get(), cut.get()}) {
    EXPECT_EQ(skipped->machine().now(), other->machine().now());
    EXPECT_TRUE(skipped->machine().cpu().reg == other->machine().cpu().reg);
    EXPECT_EQ(skipped->machine().report().instructions, other->machine().report().instructions);
    std::vector<std::uint8_t> ram(4096), other_ram(4096);
    skipped->machine().memory().read(0x20000000, ram);
    other->machine().memory().read(0x20000000, other_ram);
    EXPECT_EQ(ram, other_ram);
    for (std::uint32_t at = 0x40012C00; at < 0x40012C50; at += 4) {
      std::uint8_t a[4], b[4];
      skipped->machine().peek(at, a);
      other->machine().peek(at, b);
      EXPECT_EQ(std::to_array(a), std::to_array(b)) << at;
    }
  }
  EXPECT_EQ(executed->machine().report().skipped_cycles, 0u);
}

struct Counter : MachineObserver {
  std::uint64_t count = 0;
  void instruction(std::uint32_t, const Op&, bool, std::int64_t) override { ++count; }
};

TEST_F(PollingWheel, WhoObservesSeesEveryTurnOfTheWait) {
  Counter seen;
  const auto observed = run(true, 500'000, &seen), alone = run(true, 500'000);
  EXPECT_EQ(seen.count, observed->machine().report().instructions);
  EXPECT_EQ(seen.count, alone->machine().report().instructions);
  EXPECT_EQ(observed->machine().now(), alone->machine().now());
  EXPECT_TRUE(observed->machine().cpu().reg == alone->machine().cpu().reg);
}

// Control takes a tenth of the period, the rest is waiting. What is left of it are the first turns between two events of
// the ADC and the timers.
TEST_F(PollingWheel, MostOfItsWaitIsSkipped) {
  const auto board = run(true, 500'000);
  const MachineReport report = board->machine().report();
  EXPECT_GT(static_cast<double>(report.skipped_cycles), 0.6 * static_cast<double>(board->machine().now()));
}

}  // namespace
}  // namespace omnihil::mcu
