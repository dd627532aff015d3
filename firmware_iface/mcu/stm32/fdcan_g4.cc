#include "firmware_iface/mcu/stm32/fdcan_g4.h"

#include <algorithm>

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kRxgfc = 0x80,
  kXidam = 0x84,
  kRxf0s = 0x90,
  kRxf0a = 0x94,
  kRxf1s = 0x98,
  kRxf1a = 0x9C,
  kTxbrp = 0xC8,
  kTxbar = 0xCC,
  kTxbcr = 0xD0,
  kTxbto = 0xD4,
  kTxbcf = 0xD8,
  kTxbtie = 0xDC,
  kTxbcie = 0xE0,
  kCkdiv = 0x100
};
constexpr RegisterInfo kOwn[] = {{0x54, "IE", 0, 0x00FFFFFF},
                                 {0x58, "ILS", 0, 0x7F},
                                 {0x5C, "ILE", 0, 3},
                                 {kRxgfc, "RXGFC", 0, 0x0F1F033F},
                                 {kXidam, "XIDAM", 0x1FFFFFFF, 0x1FFFFFFF},
                                 {0x88, "HPMS", 0, 0},
                                 {kRxf0s, "RXF0S", 0, 0},
                                 {kRxf0a, "RXF0A", 0, 7},
                                 {kRxf1s, "RXF1S", 0, 0},
                                 {kRxf1a, "RXF1A", 0, 7},
                                 {0xC0, "TXBC", 0, 0x01000000},
                                 {0xC4, "TXFQS", 3, 0},
                                 {kTxbrp, "TXBRP", 0, 0},
                                 {kTxbar, "TXBAR", 0, 0},
                                 {kTxbcr, "TXBCR", 0, 0},
                                 {kTxbto, "TXBTO", 0, 0},
                                 {kTxbcf, "TXBCF", 0, 0},
                                 {kTxbtie, "TXBTIE", 0, 7},
                                 {kTxbcie, "TXBCIE", 0, 7},
                                 {0xE4, "TXEFS", 0, 0},
                                 {0xE8, "TXEFA", 0, 3},
                                 {kCkdiv, "CKDIV", 0, 0xF}};
constexpr auto kRegisters = joined(kFdcanControl, kOwn);
constexpr FdcanMap kMap{.filtering = kRxgfc,
                        .xidam = kXidam,
                        .to_buffers = false,
                        .txbrp = kTxbrp,
                        .txbto = kTxbto,
                        .txbcf = kTxbcf,
                        .txbtie = kTxbtie,
                        .txbcie = kTxbcie,
                        .sent = 1u << 7,
                        .cancelled = 1u << 8,
                        .empty = 1u << 9,
                        .fifo_new = 1,
                        .fifo_watermark = 0,
                        .fifo_full = 2,
                        .fifo_lost = 4,
                        .fifo_shift = 3,
                        .queue = 24};
constexpr unsigned kPlaces = 3;
}  // namespace

FdcanG4::FdcanG4(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context)
    : Fdcan(number, kRegisters, kMap, Bus::kApb1, irqs, ram, context),
      base_(0x350u * static_cast<unsigned>(number - 1)) {}

double FdcanG4::divider() const {
  const std::uint32_t code = value(kCkdiv) & 15u;
  return code == 0 ? 1.0 : 2.0 * code;
}

FdcanG4::Filters FdcanG4::filters(bool extended) const {
  const std::uint32_t global = value(kRxgfc);
  return extended ? Filters{base_ + 0x70, std::min(field(global, 24, 4), 8u)}
                  : Filters{base_, std::min(field(global, 16, 5), 28u)};
}

FdcanG4::Place FdcanG4::fifo(unsigned which) const {
  return {.at = base_ + (which == 0 ? 0xB0u : 0x188u),
          .places = kPlaces,
          .overwrites = bit(value(kRxgfc), which == 0 ? 9 : 8)};
}

// ILS: groups of IR that go to line 1: FIFO 0, FIFO 1, messages, transmit FIFO, …
std::uint32_t FdcanG4::second_line() const {
  constexpr std::uint32_t kGroups[] = {0x7, 0x38, 0x1C0, 0x1E00, 0x6000, 0x18000, 0xFE0000};
  std::uint32_t second = 0;
  for (unsigned g = 0; g < 7; ++g) second |= bit(value(kIls), g) ? kGroups[g] : 0u;
  return second;
}

std::uint32_t FdcanG4::load(std::uint32_t offset) {
  if (offset == kRxf0s) return status(fifos_[0], kPlaces);
  if (offset == kRxf1s) return status(fifos_[1], kPlaces);
  if (offset == kTxfqs) {
    unsigned put = 0;
    while (put < kPlaces && bit(value(kTxbrp), put)) ++put;
    const auto used = static_cast<unsigned>(asked_.size());
    const unsigned get = asked_.empty() ? 0 : asked_.front();
    return (kPlaces - used) | get << 8 | put % kPlaces << 16 | (used == kPlaces ? 1u << 21 : 0u);
  }
  return value(offset);
}

void FdcanG4::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  switch (offset) {
    case kRxf0a:
    case kRxf1a:
      acknowledge(fifos_[offset == kRxf0a ? 0 : 1], written & 7u, kPlaces);
      break;
    case kTxbar:
      request(written, kPlaces);
      break;
    case kTxbcr:
      cancel(written);
      break;
    default:
      return Fdcan::store(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
