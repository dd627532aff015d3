#include "firmware_iface/mcu/stm32/clock/flash_h7.h"

#include <algorithm>

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kKeyr = 0x04, kCr = 0x0C, kSr = 0x10, kCcr = 0x14 };  // of a bank
constexpr std::uint32_t kBase = 0x08000000, kSectorBytes = 128 * 1024, kBank = 0x100;
constexpr std::uint32_t kLock = 1, kPg = 2, kSer = 4, kBer = 8, kStart = 1u << 7, kEop = 1u << 16;

// Options are kept; ECC, CRC and protection find nothing.
constexpr RegisterInfo kFirst[] = {{0x00, "ACR", 0x37, 0x3F},
                                   {0x04, "KEYR1", 0, 0},
                                   {0x08, "OPTKEYR", 0, 0},
                                   {0x0C, "CR1", 0x31, 0x0FFF87BE, 0x0FFE8000},
                                   {0x10, "SR1", 0, 0},
                                   {0x14, "CCR1", 0, 0},
                                   {0x18, "OPTCR", 1, 0xC0000010},
                                   {0x1C, "OPTSR_CUR", 0x1BC6AAF0, 0},
                                   {0x20, "OPTSR_PRG", 0x1BC6AAF0},
                                   {0x24, "OPTCCR", 0, 0},
                                   {0x28, "PRAR_CUR1", 0, 0},
                                   {0x2C, "PRAR_PRG1"},
                                   {0x30, "SCAR_CUR1", 0, 0},
                                   {0x34, "SCAR_PRG1"},
                                   {0x38, "WPSN_CUR1R", 0xFF, 0},
                                   {0x3C, "WPSN_PRG1R", 0xFF},
                                   {0x40, "BOOT_CURR", 0x1FF00800, 0},
                                   {0x44, "BOOT_PRGR", 0x1FF00800},
                                   {0x50, "CRCCR1", 0x001C0000, 0x0037FFFF, 0x0037FFFF},
                                   {0x54, "CRCSADD1R"},
                                   {0x58, "CRCEADD1R"},
                                   {0x5C, "CRCDATAR", 0, 0},
                                   {0x60, "ECC_FA1R", 0, 0}};
constexpr RegisterInfo kSecond[] = {{0x104, "KEYR2", 0, 0},
                                    {0x10C, "CR2", 0x31, 0x0FFF87BE, 0x0FFE8000},
                                    {0x110, "SR2", 0, 0},
                                    {0x114, "CCR2", 0, 0},
                                    {0x128, "PRAR_CUR2", 0, 0},
                                    {0x12C, "PRAR_PRG2"},
                                    {0x130, "SCAR_CUR2", 0, 0},
                                    {0x134, "SCAR_PRG2"},
                                    {0x138, "WPSN_CUR2R", 0xFF, 0},
                                    {0x13C, "WPSN_PRG2R", 0xFF},
                                    {0x150, "CRCCR2", 0x001C0000, 0x0037FFFF, 0x0037FFFF},
                                    {0x154, "CRCSADD2R"},
                                    {0x158, "CRCEADD2R"},
                                    {0x160, "ECC_FA2R", 0, 0}};
constexpr auto kBoth = joined(kFirst, kSecond);
}  // namespace

FlashH7::FlashH7(std::uint32_t bytes, unsigned banks, int irq, ChipContext& context)
    : Flash(banks == 2 ? std::span<const RegisterInfo>(kBoth) : kFirst, bytes, irq, context),
      bank_bytes_(bytes / banks) {}

void FlashH7::reset() {
  RegisterBlock::reset();
  keys_ = {};
  update();
}

void FlashH7::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const std::uint32_t bank = offset / kBank;
  switch (offset % kBank) {
    case kKeyr:
      if (opens(keys_[bank], written)) value(bank * kBank + kCr) &= ~kLock;
      return;
    case kCr:
      return control(bank, written, lanes);
    case kCcr:
      value(bank * kBank + kSr) &= ~written;
      return update();
    default:
      keep(offset, written, lanes);
  }
}

void FlashH7::control(std::uint32_t bank, std::uint32_t written, std::uint32_t lanes) {
  const std::uint32_t at = bank * kBank + kCr;
  if ((value(at) & kLock) != 0) return;
  keep(at, written, lanes);
  value(at) |= written & kLock;
  if ((written & kStart) == 0) return update();
  value(at) &= ~kStart;
  const std::uint32_t cr = value(at), from = bank * bank_bytes_;
  if ((cr & kBer) != 0) {
    erase(from, bank_bytes_);
  } else if ((cr & kSer) != 0) {
    const std::uint32_t sector = field(cr, 8, 3) * kSectorBytes;
    if (sector < bank_bytes_) {
      erase(from + sector, kSectorBytes);
    } else {
      system().report_unmodelled(name(), "erase beyond the end of the bank ignored");
    }
  }
  done(bank);
}

void FlashH7::flash_write(std::uint32_t address, unsigned bytes, std::uint32_t word) {
  const std::uint32_t from = address - kBase, bank = std::min(from / bank_bytes_, 1u);
  const std::uint32_t cr = from < this->bytes() ? value(bank * kBank + kCr) : kLock;
  if ((cr & kLock) != 0 || (cr & kPg) == 0) {
    system().report_unmodelled(name(), "store into flash that is not being programmed ignored");
    return;
  }
  program(address, bytes, word);
  done(bank);
}

void FlashH7::done(std::uint32_t bank) {
  value(bank * kBank + kSr) |= kEop;
  update();
}

void FlashH7::update() {  // EOPIE has EOP's place
  const std::uint32_t first = value(kSr) & value(kCr), second = value(kBank + kSr) & value(kBank + kCr);
  irq_.set(((first | second) & kEop) != 0);
}

}  // namespace omnihil::mcu
