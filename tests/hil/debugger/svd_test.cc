// The file of a chip's registers, as a reader of XML that is not ours finds it.
#include "hil/debugger/svd.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

TEST(Svd, RegistersStandAtTheAddressesOfTheReferenceManual) {
  const mcu::ChipSpec* spec = mcu::find_chip("stm32f407");
  mcu::Machine machine(mcu::machine_config(*spec));
  const mcu::Chip chip(*spec, machine);
  const auto address = [&](const std::string& block, const std::string& name) -> std::uint32_t {
    for (const NamedRegister& r : named_registers(chip))
      if (r.block == block && r.name == name) return r.address;
    return 0;
  };
  // RM0090: table 1 and the register maps
  EXPECT_EQ(address("TIM1", "CCR1"), 0x40010034u);
  EXPECT_EQ(address("USART2", "BRR"), 0x40004408u);
  EXPECT_EQ(address("GPIOE", "IDR"), 0x40021010u);
  EXPECT_EQ(address("CAN1", "TSR"), 0x40006408u);
  EXPECT_EQ(address("SCB", "CFSR"), 0xE000ED28u);
}

TEST(Svd, EveryChipHasNoTwoRegistersOfOneNameInABlock) {
  for (const mcu::ChipSpec* spec : mcu::all_chips()) {
    mcu::Machine machine(mcu::machine_config(*spec));
    const mcu::Chip chip(*spec, machine);
    std::set<std::pair<std::string, std::string>> names;
    for (const NamedRegister& r : named_registers(chip))
      EXPECT_TRUE(names.emplace(r.block, r.name).second) << spec->name << " " << r.block << "." << r.name;
    EXPECT_GT(names.size(), 100u) << spec->name;
  }
}

struct SvdVerb : CliTest {};

TEST_F(SvdVerb, WritesWhatAnXmlReaderReads) {
  const std::string read =
      "import sys, xml.etree.ElementTree as e; d = e.parse(sys.stdin).getroot(); "
      "p = {b.find('name').text: b for b in d.iter('peripheral')}; "
      "t = p['TIM3']; print(hex(int(t.find('baseAddress').text, 16) + [int(r.find('addressOffset').text, 16) "
      "for r in t.iter('register') if r.find('name').text == 'CNT'][0]), d.find('name').text)";
  const Ran ran = run_omnihil("svd STM32F446 | /usr/bin/python3 -c \"" + read + "\"");
  EXPECT_EQ(ran.text, "0x40000424 stm32f446\n");
}

TEST_F(SvdVerb, NamesTheChipsThatThereAre) {
  const Ran ran = run_omnihil("svd stm32f999");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("stm32f999") && ran.says("stm32g474")) << ran.text;
}

}  // namespace
}  // namespace omnihil
