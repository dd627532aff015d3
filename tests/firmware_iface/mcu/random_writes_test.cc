// No sequence of register accesses, whatever it is, brings a chip down, or makes it go on for ever within an
// instant.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "firmware_iface/mcu/stm32/serial_port.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {
constexpr int kAccesses = 10'000;

class EveryChip : public testing::TestWithParam<std::string> {};

std::vector<std::string> chip_names() {
  std::vector<std::string> names;
  for (const ChipSpec* chip : all_chips()) names.emplace_back(chip->name);
  return names;
}

TEST_P(EveryChip, SurvivesRandomAccessesToAllItsBlocks) {
  ChipBench b(GetParam());
  std::mt19937 random(1234);
  for (const std::string& name : b.chip.names<Timer>()) {
    b.chip.find<Timer>(name)->set_shaft([](std::int64_t at_ns) { return at_ns / 700; });
    b.chip.find<Timer>(name)->on_output([](std::int64_t) {});
  }
  for (int i = 0; i < kAccesses; ++i) {
    const auto& block = b.chip.blocks()[random() % b.chip.blocks().size()];
    const std::uint32_t offset = random() % std::min(block.bytes, 0x400u);
    const unsigned bytes = 1u << random() % 3;
    const std::uint32_t address = block.base + (offset & ~(bytes - 1));
    // Bits one by one more often than all at once, so that blocks are enabled in odd ways.
    const std::uint32_t value = random() % 2 == 0 ? random() : 1u << random() % 32 | 1u;
    if (random() % 3 == 0) {
      b.system.bus_read(address, bytes);
    } else {
      b.system.bus_write(address, bytes, value);
    }
    if (i % 64 == 0) {
      const std::uint8_t byte = static_cast<std::uint8_t>(i);
      if (auto* port = b.chip.find<SerialPort>(b.chip.names<SerialPort>().front()))
        port->feed({&byte, 1}, b.system.to_ns(b.system.now()));
    }
    const std::uint64_t before = b.system.events;
    b.system.run_for(random() % 200);
    ASSERT_LT(b.system.events - before, 5000u);
  }
  b.chip.reset();
  for (const auto& [irq, high] : b.system.irq_high) EXPECT_FALSE(high) << irq;
}

TEST_P(EveryChip, AnswersEveryRegisterOfItsTablesWithItsResetValue) {
  ChipBench b(GetParam());
  for (const Chip::Mapped& block : b.chip.blocks()) {
    const auto* registers = dynamic_cast<const RegisterBlock*>(block.peripheral);
    if (registers == nullptr || registers->name() == "RCC" || registers->name().starts_with("GPIO")) continue;
    for (const RegisterInfo& r : registers->registers()) {
      EXPECT_LT(r.offset, block.bytes) << registers->name() << " " << r.name;
      if (r.writable != 0xFFFFFFFFu || r.reset == 0) continue;
      EXPECT_EQ(b.system.read(block.base + r.offset) & 0xFFFF, r.reset & 0xFFFF)
          << registers->name() << " " << r.name;
    }
  }
}

TEST_P(EveryChip, HasNoTwoBlocksAtOneAddress) {
  ChipBench b(GetParam());
  for (const Chip::Mapped& a : b.chip.blocks()) {
    for (const Chip::Mapped& c : b.chip.blocks()) {
      if (&a == &c) continue;
      EXPECT_TRUE(a.base + a.bytes <= c.base || c.base + c.bytes <= a.base)
          << a.peripheral->name() << " and " << c.peripheral->name();
      EXPECT_NE(a.peripheral->name(), c.peripheral->name());
    }
  }
}

TEST_P(EveryChip, ReportsARegisterThatIsNotModelled) {
  ChipBench b(GetParam());
  const std::string serial = b.chip.names<SerialPort>().front();
  b.get(serial, 0xF0);
  const auto told =
      std::find_if(b.system.unmodelled.begin(), b.system.unmodelled.end(), [&](const auto& each) {
        return each.first.find(serial) != std::string::npos && each.first.find("0x0F0") != std::string::npos;
      });
  EXPECT_NE(told, b.system.unmodelled.end());
}

INSTANTIATE_TEST_SUITE_P(All, EveryChip, testing::ValuesIn(chip_names()),
                         [](const auto& row) { return row.param; });

}  // namespace
}  // namespace omnihil::mcu
