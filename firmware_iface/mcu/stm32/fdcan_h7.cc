#include "firmware_iface/mcu/stm32/fdcan_h7.h"

#include <algorithm>
#include <bit>

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kGfc = 0x80,
  kSidfc = 0x84,
  kXidfc = 0x88,
  kXidam = 0x90,
  kNdat1 = 0x98,
  kNdat2 = 0x9C,
  kRxf0c = 0xA0,
  kRxf0s = 0xA4,
  kRxf0a = 0xA8,
  kRxbc = 0xAC,
  kRxf1c = 0xB0,
  kRxf1s = 0xB4,
  kRxf1a = 0xB8,
  kRxesc = 0xBC,
  kTxesc = 0xC8,
  kTxbrp = 0xCC,
  kTxbar = 0xD0,
  kTxbcr = 0xD4,
  kTxbto = 0xD8,
  kTxbcf = 0xDC,
  kTxbtie = 0xE0,
  kTxbcie = 0xE4,
  kTxefc = 0xF0,
  kTxefs = 0xF4,
  kTxefa = 0xF8
};
constexpr RegisterInfo kOwn[] = {{0x54, "IE", 0, 0x3FFFFFFF},
                                 {0x58, "ILS", 0, 0x3FFFFFFF},
                                 {0x5C, "ILE", 0, 3},
                                 {kGfc, "GFC", 0, 0x3F},
                                 {kSidfc, "SIDFC", 0, 0x00FFFFFC},
                                 {kXidfc, "XIDFC", 0, 0x00FFFFFC},
                                 {kXidam, "XIDAM", 0x1FFFFFFF, 0x1FFFFFFF},
                                 {0x94, "HPMS", 0, 0},
                                 {kNdat1, "NDAT1", 0, 0},
                                 {kNdat2, "NDAT2", 0, 0},
                                 {kRxf0c, "RXF0C", 0, 0xFFFFFFFC},
                                 {kRxf0s, "RXF0S", 0, 0},
                                 {kRxf0a, "RXF0A", 0, 0x3F},
                                 {kRxbc, "RXBC", 0, 0xFFFC},
                                 {kRxf1c, "RXF1C", 0, 0xFFFFFFFC},
                                 {kRxf1s, "RXF1S", 0, 0},
                                 {kRxf1a, "RXF1A", 0, 0x3F},
                                 {kRxesc, "RXESC", 0, 0x777},
                                 {0xC0, "TXBC", 0, 0x7F3FFFFC},
                                 {0xC4, "TXFQS", 0, 0},
                                 {kTxesc, "TXESC", 0, 7},
                                 {kTxbrp, "TXBRP", 0, 0},
                                 {kTxbar, "TXBAR", 0, 0},
                                 {kTxbcr, "TXBCR", 0, 0},
                                 {kTxbto, "TXBTO", 0, 0},
                                 {kTxbcf, "TXBCF", 0, 0},
                                 {kTxbtie, "TXBTIE"},
                                 {kTxbcie, "TXBCIE"},
                                 {kTxefc, "TXEFC", 0, 0x3F3FFFFC},
                                 {kTxefs, "TXEFS", 0, 0},
                                 {kTxefa, "TXEFA", 0, 0x1F}};
constexpr auto kRegisters = joined(kFdcanControl, kOwn);
constexpr FdcanMap kMap{.filtering = kGfc,
                        .xidam = kXidam,
                        .to_buffers = true,
                        .txbrp = kTxbrp,
                        .txbto = kTxbto,
                        .txbcf = kTxbcf,
                        .txbtie = kTxbtie,
                        .txbcie = kTxbcie,
                        .sent = 1u << 9,
                        .cancelled = 1u << 10,
                        .empty = 1u << 11,
                        .fifo_new = 1,
                        .fifo_watermark = 2,
                        .fifo_full = 4,
                        .fifo_lost = 8,
                        .fifo_shift = 4,
                        .queue = 30};
constexpr std::uint32_t kTefn = 1u << 12, kTeff = 1u << 14, kTefl = 1u << 15, kDrx = 1u << 19;  // IR
constexpr unsigned kMostPlaces = 64, kMostBuffers = 32;

// RXESC, TXESC: bytes of data that an element has room for.
unsigned data_room(unsigned code) {
  constexpr unsigned kRoom[] = {8, 12, 16, 20, 24, 32, 48, 64};
  return kRoom[code & 7u];
}
}  // namespace

FdcanH7::FdcanH7(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context)
    : Fdcan(number, kRegisters, kMap, Bus::kFdcan, irqs, ram, context) {}

void FdcanH7::reset() {
  Fdcan::reset();
  events_ = {};
  last_queued_ = kMostBuffers;
}

unsigned FdcanH7::fifo_places(unsigned fifo) const {
  return std::min(field(value(fifo == 0 ? kRxf0c : kRxf1c), 16, 7), kMostPlaces);
}
unsigned FdcanH7::dedicated() const { return std::min(field(value(kTxbc), 16, 6), kMostBuffers); }
unsigned FdcanH7::queue_places() const {
  return std::min(field(value(kTxbc), 24, 6), kMostBuffers - dedicated());
}

unsigned FdcanH7::transmit_room() const { return data_room(value(kTxesc)); }
std::uint32_t FdcanH7::transmit_element(unsigned place) const {
  return part(kTxbc) + (8 + transmit_room()) * place;
}

// An element of the event FIFO, where the frame asks for it.
void FdcanH7::transmitted(unsigned place) {
  const std::uint32_t at = transmit_element(place);
  const std::uint32_t t0 = ram_.word(at), t1 = ram_.word(at + 4);
  const unsigned places = std::min(field(value(kTxefc), 16, 6), kMostBuffers);
  if (!bit(t1, 23)) return;  // EFC
  if (events_.fill >= places) {
    events_.lost = true;
    value(kIr) |= kTefl;
    return;
  }
  const std::uint32_t to = part(kTxefc) + 8 * ((events_.get + events_.fill++) % places);
  ram_.write(to, 4, t0);
  ram_.write(to + 4, 4, (t1 & 0xFF3F0000u) | 1u << 22);  // transmitted
  value(kIr) |= kTefn | (events_.fill == places ? kTeff : 0u);
}

FdcanH7::Filters FdcanH7::filters(bool extended) const {
  const std::uint32_t list = value(extended ? kXidfc : kSidfc);
  return {list & 0xFFFCu, field(list, 16, extended ? 7 : 8)};
}

FdcanH7::Place FdcanH7::fifo(unsigned which) const {
  const std::uint32_t config = value(which == 0 ? kRxf0c : kRxf1c);
  return {.at = config & 0xFFFCu,
          .places = fifo_places(which),
          .room = data_room(field(value(kRxesc), 4 * which, 3)),
          .watermark = field(config, 24, 7),
          .overwrites = bit(config, 31)};
}

void FdcanH7::put_in_buffer(const CanFrame& frame, const Verdict& verdict) {
  const unsigned room = data_room(field(value(kRxesc), 8, 3)), place = static_cast<unsigned>(verdict.buffer);
  write_element(part(kRxbc) + (8 + room) * place, frame, verdict, room);
  value(place < 32 ? kNdat1 : kNdat2) |= 1u << place % 32;
  value(kIr) |= kDrx;
}

std::uint32_t FdcanH7::second_line() const { return value(kIls); }

unsigned FdcanH7::first_free() const {
  const unsigned end = dedicated() + queue_places();
  if (bit(value(kTxbc), 30)) {  // a queue has no order
    unsigned put = dedicated();
    while (put < end && bit(value(kTxbrp), put)) ++put;
    return put;
  }
  const unsigned before = last_queued_;  // a FIFO: behind the last one asked for
  const unsigned next = before + 1 < end ? std::max(before + 1, dedicated()) : dedicated();
  return bit(value(kTxbrp), next) ? end : next;
}

std::uint32_t FdcanH7::queue_status() const {
  const unsigned end = dedicated() + queue_places(), put = first_free();
  unsigned free = 0;
  for (unsigned b = dedicated(); b < end; ++b) free += bit(value(kTxbrp), b) ? 0 : 1;
  const auto first =
      std::find_if(asked_.begin(), asked_.end(), [this](unsigned b) { return b >= dedicated(); });
  const unsigned get = first == asked_.end() ? put % std::max(end, 1u) : *first;
  return (bit(value(kTxbc), 30) ? 0u : free | get << 8) | (put < end ? put : dedicated()) << 16 |
         (free == 0 ? 1u << 21 : 0u);
}

std::uint32_t FdcanH7::load(std::uint32_t offset) {
  switch (offset) {
    case kRxf0s:
    case kRxf1s: {
      const unsigned which = offset == kRxf0s ? 0 : 1;
      return status(fifos_[which], fifo_places(which));
    }
    case kTxfqs:
      return queue_status();
    case kTxefs:
      return status(events_, field(value(kTxefc), 16, 6));
    default:
      return value(offset);
  }
}

void FdcanH7::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  switch (offset) {
    case kNdat1:
    case kNdat2:
      value(offset) &= ~written;
      break;
    case kRxf0a:
    case kRxf1a:
      acknowledge(fifos_[offset == kRxf0a ? 0 : 1], written, fifo_places(offset == kRxf0a ? 0 : 1));
      break;
    case kTxefa:
      acknowledge(events_, written, field(value(kTxefc), 16, 6));
      break;
    case kTxbar: {
      const std::uint32_t asked = request(written, dedicated() + queue_places());
      const auto last = static_cast<unsigned>(std::bit_width(asked));  // and one
      if (last > dedicated()) last_queued_ = last - 1;
      break;
    }
    case kTxbcr:
      cancel(written);
      break;
    default:
      return Fdcan::store(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
