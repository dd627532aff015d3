#include "firmware_iface/mcu/stm32/clock/flash.h"

#include <algorithm>
#include <array>
#include <vector>

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kBase = 0x08000000;

constexpr RegisterInfo kF0F3[] = {
    {0x00, "ACR", 0x30, 0x1F},  {0x04, "KEYR", 0, 0}, {0x08, "OPTKEYR", 0, 0}, {0x0C, "SR", 0, 0},
    {0x10, "CR", 0x80, 0x3677}, {0x14, "AR"},         {0x1C, "OBR", 0x3FC, 0}, {0x20, "WRPR", 0xFFFFFFFF, 0}};
constexpr RegisterInfo kF4[] = {{0x00, "ACR", 0, 0x1F0F},
                                {0x04, "KEYR", 0, 0},
                                {0x08, "OPTKEYR", 0, 0},
                                {0x0C, "SR", 0, 0},
                                {0x10, "CR", 0x80000000, 0x8301837F},
                                {0x14, "OPTCR", 0x0FFFAAED, 0x0FFFFFFD, 0x2},
                                {0x18, "OPTCR1", 0x0FFF0000}};
// RM0410 3.7: as F4, but for the options
constexpr RegisterInfo kF7[] = {{0x00, "ACR", 0, 0xB0F},
                                {0x04, "KEYR", 0, 0},
                                {0x08, "OPTKEYR", 0, 0},
                                {0x0C, "SR", 0, 0},
                                {0x10, "CR", 0x80000000, 0x8301837F},
                                {0x14, "OPTCR", 0xFFFFAAFD, 0xFFFFFFFD, 0x2},
                                {0x18, "OPTCR1", 0x00400080},
                                {0x1C, "OPTCR2", 0x800000FF}};
constexpr RegisterInfo kG4[] = {{0x00, "ACR", 0x600, 0x47F0F},
                                {0x04, "PDKEYR", 0, 0},
                                {0x08, "KEYR", 0, 0},
                                {0x0C, "OPTKEYR", 0, 0},
                                {0x10, "SR", 0, 0},
                                {0x14, "CR", 0xC0000000, 0xCB07FFFF},
                                {0x18, "ECCR"},
                                {0x20, "OPTR", 0xFFEFF8AA},
                                {0x24, "PCROP1SR"},
                                {0x28, "PCROP1ER"},
                                {0x2C, "WRP1AR"},
                                {0x30, "WRP1BR"}};
// RM0444 3.7: as G4; the second bank is G0Bx's and G0Cx's
constexpr RegisterInfo kG0[] = {{0x00, "ACR", 0x40600, 0x40F07},
                                {0x08, "KEYR", 0, 0},
                                {0x0C, "OPTKEYR", 0, 0},
                                {0x10, "SR", 0, 0},
                                {0x14, "CR", 0xC0000000, 0xCF07BFFF},
                                {0x18, "ECCR"},
                                {0x1C, "ECC2R"},
                                {0x20, "OPTR", 0xFFFFFEAA},
                                {0x24, "PCROP1ASR"},
                                {0x28, "PCROP1AER"},
                                {0x2C, "WRP1AR"},
                                {0x30, "WRP1BR"},
                                {0x34, "PCROP1BSR"},
                                {0x38, "PCROP1BER"},
                                {0x44, "PCROP2ASR"},
                                {0x48, "PCROP2AER"},
                                {0x4C, "WRP2AR"},
                                {0x50, "WRP2BR"},
                                {0x54, "PCROP2BSR"},
                                {0x58, "PCROP2BER"},
                                {0x80, "SECR"}};
// RM0351 3.7: as G4, with the second bank's protections
constexpr RegisterInfo kL4[] = {{0x00, "ACR", 0x600, 0x7F07},
                                {0x04, "PDKEYR", 0, 0},
                                {0x08, "KEYR", 0, 0},
                                {0x0C, "OPTKEYR", 0, 0},
                                {0x10, "SR", 0, 0},
                                {0x14, "CR", 0xC0000000, 0xCF05FFFF},
                                {0x18, "ECCR"},
                                {0x20, "OPTR", 0xFFEFF8AA},
                                {0x24, "PCROP1SR"},
                                {0x28, "PCROP1ER"},
                                {0x2C, "WRP1AR"},
                                {0x30, "WRP1BR"},
                                {0x44, "PCROP2SR"},
                                {0x48, "PCROP2ER"},
                                {0x4C, "WRP2AR"},
                                {0x50, "WRP2BR"}};
// KEYR, SR, CR; bit of LOCK and STRT in CR; EOP in SR; EOPIE in CR
struct Layout {
  std::uint16_t key, sr, cr;
  unsigned lock, start, done, done_enable;
};
Layout layout(FlashFamily family) {
  if (family == FlashFamily::kF0F3) return {0x04, 0x0C, 0x10, 7, 6, 5, 12};
  if (family == FlashFamily::kG0 || family == FlashFamily::kG4 || family == FlashFamily::kL4)
    return {0x08, 0x10, 0x14, 31, 16, 0, 24};
  return {0x04, 0x0C, 0x10, 31, 16, 0, 24};
}
std::span<const RegisterInfo> table(FlashFamily family) {
  if (family == FlashFamily::kF0F3) return kF0F3;
  if (family == FlashFamily::kG0) return kG0;
  if (family == FlashFamily::kG4) return kG4;
  if (family == FlashFamily::kL4) return kL4;
  return family == FlashFamily::kF7 ? std::span<const RegisterInfo>(kF7) : kF4;
}
}  // namespace

Flash::Flash(FlashFamily family, std::uint32_t bytes, std::uint32_t page_bytes, int irq, ChipContext& context)
    : RegisterBlock("FLASH", context.system, table(family)),
      irq_(context.irqs, irq),
      family_(family),
      bytes_(bytes),
      page_bytes_(page_bytes) {}

Flash::Flash(std::span<const RegisterInfo> registers, std::uint32_t bytes, int irq, ChipContext& context)
    : RegisterBlock("FLASH", context.system, registers),
      irq_(context.irqs, irq),
      family_(FlashFamily::kF4),
      bytes_(bytes),
      page_bytes_(bytes) {}

void Flash::reset() {
  RegisterBlock::reset();
  keys_ = 0;
  if (family_ == FlashFamily::kF7) value(0x18) = (value(0x18) & 0xFFFF0000u) | boot_option_;
  irq_.set(false);
}

void Flash::set_boot_address(std::uint32_t address) {
  boot_option_ = address / 16384;
  reset();
}

bool Flash::locked() const {
  const Layout at = layout(family_);
  return bit(value(at.cr), at.lock);
}

std::uint32_t Flash::load(std::uint32_t offset) {
  const std::uint32_t v = value(offset);
  if (family_ == FlashFamily::kF0F3 && offset == 0) return (v & ~0x20u) | (v & 0x10u) << 1;  // PRFTBS
  return v;
}

void Flash::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const Layout at = layout(family_);
  if (offset == at.key) {
    if (opens(keys_, written)) value(at.cr) &= ~(1u << at.lock);
  } else if (offset == at.sr) {
    value(offset) &= ~written;
    irq_.set(bit(value(at.sr), at.done) && bit(value(at.cr), at.done_enable));
  } else if (offset == at.cr) {
    control(written, lanes);
  } else {
    keep(offset, written, lanes);
  }
}

bool Flash::opens(unsigned& keys, std::uint32_t written) {
  constexpr std::uint32_t kKeys[] = {0x45670123u, 0xCDEF89ABu};
  if (keys >= 2 || written != kKeys[keys]) {
    keys = 2;  // a wrong key keeps it locked until reset
    return false;
  }
  keys = (keys + 1) % 2;
  return keys == 0;
}

void Flash::control(std::uint32_t written, std::uint32_t lanes) {
  const Layout at = layout(family_);
  if (locked()) return;
  keep(at.cr, written, lanes);
  value(at.cr) |= written & 1u << at.lock;
  if (!bit(written, at.start)) return;
  value(at.cr) &= ~(1u << at.start);
  const std::uint32_t cr = value(at.cr);
  const bool banks = family_ == FlashFamily::kL4 || family_ == FlashFamily::kG0;
  if (banks && (bit(cr, 2) || bit(cr, 15))) {  // MER1, MER2
    const std::uint32_t first = one_bank() ? bytes_ : bytes_ / 2;
    if (bit(cr, 2)) erase(0, first);
    if (bit(cr, 15)) erase(first, bytes_ - first);
  } else if (bit(cr, 2)) {
    erase(0, bytes_);  // MER
  } else if (bit(cr, 1)) {
    if (family_ == FlashFamily::kF0F3) {
      erase((value(0x14) - kBase) / page_bytes_ * page_bytes_, page_bytes_);
    } else if (family_ == FlashFamily::kG4) {
      erase((field(cr, 3, 7) + (bit(cr, 11) ? 128u : 0u)) * page_bytes_, page_bytes_);
    } else if (family_ == FlashFamily::kG0) {
      erase(field(cr, 3, 10) * page_bytes_ + (bit(cr, 13) ? bytes_ / 2 : 0u), page_bytes_);
    } else if (family_ == FlashFamily::kL4) {  // pages of a bank, which is half of it
      erase(field(cr, 3, 8) * page_bytes_ + (bit(cr, 11) ? bytes_ / 2 : 0u), page_bytes_);
    } else {
      erase_sector(field(cr, 3, 4));
    }
  }
  value(at.sr) |= 1u << at.done;
  irq_.set(bit(cr, at.done_enable));
}

// F4: 4 x 16 KiB, 64 KiB, then 128 KiB; F7 (single bank): twice that.
void Flash::erase_sector(std::uint32_t sector) {
  const std::uint32_t unit = family_ == FlashFamily::kF7 ? 32768 : 16384;
  if (sector < 4) return erase(sector * unit, unit);
  if (sector == 4) return erase(4 * unit, 4 * unit);
  erase((sector - 4) * 8 * unit, 8 * unit);
}

void Flash::erase(std::uint32_t from, std::uint32_t count) {
  if (from >= bytes_) {
    system().report_unmodelled(name(), "erase beyond the end of flash ignored");
    return;
  }
  const std::vector<std::uint8_t> blank(std::min(count, bytes_ - from), 0xFF);
  system().program_flash(kBase + from, blank);
}

void Flash::flash_write(std::uint32_t address, unsigned bytes, std::uint32_t word) {
  const Layout at = layout(family_);
  if (locked() || !bit(value(at.cr), 0) || address < kBase || address - kBase + bytes > bytes_) {
    system().report_unmodelled(name(), "store into flash that is not being programmed ignored");
    return;
  }
  program(address, bytes, word);
  value(at.sr) |= 1u << at.done;
  irq_.set(bit(value(at.cr), at.done_enable));
}

void Flash::program(std::uint32_t address, unsigned bytes, std::uint32_t word) {
  std::array<std::uint8_t, 4> cells{};
  for (unsigned i = 0; i < bytes; ++i) {  // programming clears bits
    cells[i] = static_cast<std::uint8_t>(system().bus_read(address + i, 1) & word >> (8 * i));
  }
  system().program_flash(address, std::span(cells).first(bytes));
}

}  // namespace omnihil::mcu
