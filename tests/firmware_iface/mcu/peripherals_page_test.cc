// docs/mcu-peripherals.md says which blocks each chip has, as the chips' files do.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "firmware_iface/mcu/stm32/device.h"
#include "firmware_iface/mcu/stm32/stored_block.h"
#include "tests/firmware_iface/mcu/chip_bench.h"

namespace omnihil::mcu {
namespace {

std::string list_of(const ChipBench& b, bool kept_only) {
  std::string all;
  for (const Chip::Mapped& block : b.chip.blocks()) {
    const std::string& name = block.peripheral->name();
    if ((dynamic_cast<StoredBlock*>(block.peripheral) != nullptr) != kept_only) continue;
    all += (all.empty() ? "" : ", ") + name;
  }
  return all;
}

std::string expected_page_end() {
  std::string text;
  for (const ChipSpec* spec : all_chips()) {
    const ChipBench b(spec->name);
    text += "**" + std::string(spec->name) + "**";
    for (const std::string_view variant : spec->variants) text += ", " + std::string(variant);
    text += " (" + std::string(spec->core.name) + "). Modelled: " + list_of(b, false);
    text += ". Kept only: " + list_of(b, true) + ".\n\n";
  }
  text += "## Devices\n\n| kind | what | settings |\n|---|---|---|\n";
  for (const DeviceKind* kind : all_devices()) {
    text += "| " + std::string(kind->name) + " | " + std::string(kind->what) + " |";
    for (const std::string_view setting : kind->settings) text += " " + std::string(setting);
    text += " |\n";
  }
  return text;
}

TEST(PeripheralsPage, ListsChipsBlocksAndDevicesAsTheyAre) {
  std::ifstream file(OMNIHIL_SOURCE_DIR "/docs/mcu-peripherals.md");
  const std::string page((std::istreambuf_iterator<char>(file)), {});
  const std::string end = expected_page_end();
  EXPECT_TRUE(page.ends_with("## Chips\n\n" + end)) << "the page should end with:\n" << end;
}

}  // namespace
}  // namespace omnihil::mcu
