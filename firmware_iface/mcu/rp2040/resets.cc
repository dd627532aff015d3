#include "firmware_iface/mcu/rp2040/resets.h"

namespace omnihil::mcu::rp2040 {
namespace {
constexpr std::uint32_t kAll = 0x01FFFFFF, kStages = 0x0001FFFF;
constexpr RegisterInfo kResets[] = {
    {0x00, "RESET", kAll, kAll}, {0x04, "WDSEL", 0, kAll}, {0x08, "RESET_DONE", 0, 0}};
constexpr RegisterInfo kPsm[] = {{0x00, "FRCE_ON", 0, kStages},
                                 {0x04, "FRCE_OFF", 0, kStages},
                                 {0x08, "WDSEL", 0, kStages},
                                 {0x0C, "DONE", 0, 0}};
}  // namespace

Resets::Resets(ChipContext& context) : Rp2040Block("RESETS", context.system, kResets) {
  next_event_is(kNever);
}

void Resets::reset() {
  Rp2040Block::reset();
  apply();
}

void Resets::apply() {
  for (const auto& [at, block] : held_) block->hold(bit(value(0x00), at));
}

std::uint32_t Resets::load(std::uint32_t offset) {
  return offset == 0x08 ? ~value(0x00) & kAll : value(offset);
}

void Resets::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset == 0x00) apply();
}

Psm::Psm(ChipContext& context) : Rp2040Block("PSM", context.system, kPsm) { next_event_is(kNever); }

std::uint32_t Psm::load(std::uint32_t offset) {
  return offset == 0x0C ? kStages & ~value(0x04) : value(offset);
}

}  // namespace omnihil::mcu::rp2040
