#include "firmware_iface/mcu/stm32/fdcan_h7.h"

#include <algorithm>
#include <cmath>

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kDbtp = 0x0C,
  kTest = 0x10,
  kCccr = 0x18,
  kNbtp = 0x1C,
  kIr = 0x50,
  kIe = 0x54,
  kIls = 0x58,
  kIle = 0x5C,
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
  kTxbc = 0xC0,
  kTxfqs = 0xC4,
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
constexpr RegisterInfo kRegisters[] = {{0x00, "CREL", 0x32141218, 0},
                                       {0x04, "ENDN", 0x87654321, 0},
                                       {kDbtp, "DBTP", 0x00000A33, 0x009F1FFF, 0x00800000},
                                       {kTest, "TEST", 0, 0x70, 0x60},
                                       {0x14, "RWD", 0, 0xFF, 0xFF},
                                       {kCccr, "CCCR", 1, 0xF3FF, 0xF064},
                                       {kNbtp, "NBTP", 0x06000A03, 0xFFFFFF7F},
                                       {0x20, "TSCC", 0, 0xF0003, 0x3},
                                       {0x24, "TSCV", 0, 0},
                                       {0x28, "TOCC", 0xFFFF0000, 0xFFFF0007, 1},
                                       {0x2C, "TOCV", 0xFFFF, 0},
                                       {0x40, "ECR", 0, 0},
                                       {0x44, "PSR", 0x707, 0},
                                       {0x48, "TDCR", 0, 0x7F7F},
                                       {kIr, "IR", 0, 0},
                                       {kIe, "IE", 0, 0x3FFFFFFF},
                                       {kIls, "ILS", 0, 0x3FFFFFFF},
                                       {kIle, "ILE", 0, 3},
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
                                       {kTxbc, "TXBC", 0, 0x7F3FFFFC},
                                       {kTxfqs, "TXFQS", 0, 0},
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
// IR: of each receive FIFO new, watermark, full, lost
constexpr std::uint32_t kNew = 1, kWatermark = 2, kFull = 4, kLost = 8;
constexpr std::uint32_t kTc = 1u << 9, kTcf = 1u << 10, kTfe = 1u << 11, kTefn = 1u << 12, kTeff = 1u << 14,
                        kTefl = 1u << 15, kDrx = 1u << 19;
constexpr unsigned kMostPlaces = 64, kMostBuffers = 32;

// RXESC, TXESC: bytes of data that an element has room for.
unsigned data_room(unsigned code) {
  constexpr unsigned kRoom[] = {8, 12, 16, 20, 24, 32, 48, 64};
  return kRoom[code & 7u];
}
}  // namespace

FdcanH7::FdcanH7(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context)
    : RegisterBlock("FDCAN" + std::to_string(number), context.system, kRegisters),
      context_(context),
      ram_(ram),
      irq0_(context.irqs, irqs.first),
      irq1_(context.irqs, irqs.second) {
  next_event_is(sent_at_);
}

void FdcanH7::reset() {
  RegisterBlock::reset();
  fifos_ = {};
  events_ = {};
  asked_.clear();
  last_queued_ = kMostBuffers;
  sent_at_ = kNever;
  update();
}

unsigned FdcanH7::fifo_places(unsigned fifo) const {
  return std::min(field(value(fifo == 0 ? kRxf0c : kRxf1c), 16, 7), kMostPlaces);
}
unsigned FdcanH7::buffers() const { return std::min(field(value(kTxbc), 16, 6), kMostBuffers); }
unsigned FdcanH7::queue_places() const {
  return std::min(field(value(kTxbc), 24, 6), kMostBuffers - buffers());
}

CanFrame FdcanH7::buffer(unsigned place) const {
  const unsigned room = data_room(value(kTxesc));
  const std::uint32_t at = part(kTxbc) + (8 + room) * place;
  const std::uint32_t t0 = ram_.word(at), t1 = ram_.word(at + 4);
  CanFrame frame;
  frame.extended = bit(t0, 30);
  frame.remote = bit(t0, 29);
  frame.id = frame.extended ? t0 & 0x1FFFFFFFu : field(t0, 18, 11);
  frame.fd = bit(t1, 21) && bit(value(kCccr), 8);
  frame.fast = frame.fd && bit(t1, 20) && bit(value(kCccr), 9);
  frame.bytes = static_cast<std::uint8_t>(can_bytes(field(t1, 16, 4), frame.fd));
  for (unsigned i = 0; i < frame.bytes; ++i)  // beyond the element's room: 0xCC (RM0433 56.3.5)
    frame.data[i] = i < room ? static_cast<std::uint8_t>(ram_.read(at + 8 + i, 1)) : 0xCC;
  return frame;
}

double FdcanH7::core_cycles(double clocks) const {
  return clocks * system().core_hz() / context_.clocks.bus_hz(Bus::kFdcan);
}

double FdcanH7::bit_cycles() const {  // of the nominal rate
  const std::uint32_t n = value(kNbtp);
  return core_cycles((field(n, 16, 9) + 1.0) * (3.0 + field(n, 8, 8) + field(n, 0, 7)));
}

void FdcanH7::transmit_next() {
  if (sent_at_ != kNever || asked_.empty() || !running()) return;
  // Dedicated buffers and a queue by identifier; a FIFO's elements among themselves in order. The lowest goes first.
  const bool queue = bit(value(kTxbc), 30);
  const auto key = [this](unsigned b) {
    const CanFrame f = buffer(b);
    return f.extended ? std::uint64_t{f.id} << 1 | 1 : std::uint64_t{f.id} << 19;
  };
  auto best = asked_.end();
  bool fifo_seen = false;
  for (auto at = asked_.begin(); at != asked_.end(); ++at) {
    const bool in_fifo = !queue && *at >= buffers();
    if (in_fifo && fifo_seen) continue;
    fifo_seen = fifo_seen || in_fifo;
    if (best == asked_.end() || key(*at) < key(*best)) best = at;
  }
  std::rotate(asked_.begin(), best, best + 1);
  const CanFrame frame = buffer(asked_.front());
  const std::uint32_t d = value(kDbtp);
  const double fast = core_cycles((field(d, 16, 5) + 1.0) * (3.0 + field(d, 8, 5) + field(d, 4, 4)));
  const double cycles = can_frame_bits(frame) * bit_cycles() + can_fast_bits(frame) * fast;
  sent_at_ = now() + std::max<Cycles>(1, static_cast<Cycles>(std::llround(cycles)));
}

// An element of the event FIFO, where the frame asks for it.
void FdcanH7::log_transmitted(unsigned place) {
  const std::uint32_t at = part(kTxbc) + (8 + data_room(value(kTxesc))) * place;
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

void FdcanH7::run_events() {
  if (sent_at_ > now() || asked_.empty()) return;
  const unsigned place = asked_.front();
  const Cycles end = sent_at_;
  const CanFrame frame = buffer(place);
  asked_.erase(asked_.begin());
  sent_at_ = kNever;
  value(kTxbrp) &= ~(1u << place);
  value(kTxbto) |= 1u << place;
  if (bit(value(kTxbtie), place)) value(kIr) |= kTc;
  const bool queued =
      std::any_of(asked_.begin(), asked_.end(), [this](unsigned b) { return b >= buffers(); });
  if (place >= buffers() && !queued) value(kIr) |= kTfe;
  log_transmitted(place);
  transmit_next();
  const bool loop = bit(value(kCccr), 7) && bit(value(kTest), 4), silent = loop && bit(value(kCccr), 5);
  if (loop) take(frame);
  if (!silent) sent(frame, end);
  update();
}

FdcanH7::Verdict FdcanH7::judge(const CanFrame& frame) const {
  const std::uint32_t global = value(kGfc);
  Verdict verdict;
  if (frame.remote && bit(global, frame.extended ? 0 : 1)) return verdict;
  const std::uint32_t list = value(frame.extended ? kXidfc : kSidfc);
  const unsigned count = frame.extended ? field(list, 16, 7) : field(list, 16, 8);
  const std::uint32_t from = list & 0xFFFCu, id = frame.extended ? frame.id & value(kXidam) : frame.id;
  for (unsigned i = 0; i < count; ++i) {
    std::uint32_t id1, id2, action, kind;
    if (frame.extended) {
      const std::uint32_t f0 = ram_.word(from + 8 * i), f1 = ram_.word(from + 8 * i + 4);
      id1 = f0 & 0x1FFFFFFFu, action = f0 >> 29, id2 = f1 & 0x1FFFFFFFu, kind = f1 >> 30;
    } else {
      const std::uint32_t f = ram_.word(from + 4 * i);
      id1 = field(f, 16, 11), id2 = field(f, 0, 11), action = field(f, 27, 3), kind = f >> 30;
      if (kind == 3) continue;  // switched off
    }
    const std::uint32_t seen = kind == 3 ? frame.id : id;  // a range without the extended mask
    bool hit = kind == 0 || kind == 3 ? seen >= id1 && seen <= id2
               : kind == 1            ? seen == id1 || seen == id2
                                      : ((seen ^ id1) & id2) == 0;
    if (action == 7) hit = seen == id1;  // into a buffer: no other kind there
    if (!hit || action == 0) continue;
    verdict.index = i;
    verdict.matched = true;
    if (action == 7) verdict = {To::kBuffer, i, id2 & 63u, true};
    if (action == 1 || action == 5) verdict.to = To::kFifo0;
    if (action == 2 || action == 6) verdict.to = To::kFifo1;
    return verdict;
  }
  const unsigned rest = field(global, frame.extended ? 2 : 4, 2);
  if (rest < 2) verdict.to = rest == 0 ? To::kFifo0 : To::kFifo1;
  return verdict;
}

void FdcanH7::keep_frame(std::uint32_t at, const CanFrame& frame, const Verdict& verdict) {
  const bool first = verdict.to == To::kFifo0;
  const unsigned room = data_room(field(value(kRxesc), verdict.to == To::kBuffer ? 8 : first ? 0 : 4, 3));
  ram_.write(at, 4, (frame.extended ? 1u << 30 | frame.id : frame.id << 18) | (frame.remote ? 1u << 29 : 0u));
  ram_.write(at + 4, 4,
             (verdict.matched ? 0u : 1u << 31) | verdict.index << 24 | (frame.fd ? 1u << 21 : 0u) |
                 (frame.fast ? 1u << 20 : 0u) | can_dlc(frame.bytes) << 16);
  for (unsigned i = 0; i < frame.bytes && i < room; ++i) ram_.write(at + 8 + i, 1, frame.data[i]);
}

void FdcanH7::take(const CanFrame& frame) {
  if (!running() || (frame.fd && !bit(value(kCccr), 8))) return off_bus(now());
  const Verdict verdict = judge(frame);
  if (verdict.to == To::kNobody) return unwanted(now());
  if (verdict.to == To::kBuffer) {
    const unsigned room = data_room(field(value(kRxesc), 8, 3));
    keep_frame(part(kRxbc) + (8 + room) * verdict.buffer, frame, verdict);
    value(verdict.buffer < 32 ? kNdat1 : kNdat2) |= 1u << verdict.buffer % 32;
    value(kIr) |= kDrx;
    update();
    return system().reschedule();
  }
  const unsigned which = verdict.to == To::kFifo0 ? 0 : 1, shift = 4 * which, places = fifo_places(which);
  if (places == 0) return unwanted(now());
  Fifo& fifo = fifos_[which];
  const std::uint32_t config = value(which == 0 ? kRxf0c : kRxf1c);
  if (fifo.fill >= places) {
    fifo.lost = true;
    overflow(now());
    value(kIr) |= kLost << shift;
    if (!bit(config, 31)) return update();  // blocking; else the oldest goes
    fifo.get = (fifo.get + 1) % places;
    --fifo.fill;
  }
  const unsigned room = data_room(field(value(kRxesc), 4 * which, 3));
  keep_frame((config & 0xFFFCu) + (8 + room) * ((fifo.get + fifo.fill) % places), frame, verdict);
  ++fifo.fill;
  const unsigned mark = field(config, 24, 7);
  value(kIr) |=
      (kNew | (mark != 0 && fifo.fill == mark ? kWatermark : 0u) | (fifo.fill == places ? kFull : 0u))
      << shift;
  update();
  system().reschedule();
}

void FdcanH7::update() {
  const std::uint32_t active = value(kIr) & value(kIe), second = value(kIls);
  irq0_.set(bit(value(kIle), 0) && (active & ~second) != 0);
  irq1_.set(bit(value(kIle), 1) && (active & second) != 0);
}

unsigned FdcanH7::first_free() const {
  const unsigned end = buffers() + queue_places();
  if (bit(value(kTxbc), 30)) {  // a queue has no order
    unsigned put = buffers();
    while (put < end && bit(value(kTxbrp), put)) ++put;
    return put;
  }
  const unsigned before = last_queued_;  // a FIFO: behind the last one asked for
  const unsigned next = before + 1 < end ? std::max(before + 1, buffers()) : buffers();
  return bit(value(kTxbrp), next) ? end : next;
}

std::uint32_t FdcanH7::load(std::uint32_t offset) {
  if (offset == kRxf0s || offset == kRxf1s) {
    const unsigned which = offset == kRxf0s ? 0 : 1, places = fifo_places(which);
    const Fifo& f = fifos_[which];
    const unsigned put = places == 0 ? 0 : (f.get + f.fill) % places;
    return f.fill | f.get << 8 | put << 16 | (places != 0 && f.fill == places ? 1u << 24 : 0u) |
           (f.lost ? 1u << 25 : 0u);
  }
  if (offset == kTxfqs) {
    const unsigned end = buffers() + queue_places(), put = first_free();
    unsigned free = 0;
    for (unsigned b = buffers(); b < end; ++b) free += bit(value(kTxbrp), b) ? 0 : 1;
    const auto first =
        std::find_if(asked_.begin(), asked_.end(), [this](unsigned b) { return b >= buffers(); });
    const unsigned get = first == asked_.end() ? put % std::max(end, 1u) : *first;
    return (bit(value(kTxbc), 30) ? 0u : free | get << 8) | (put < end ? put : buffers()) << 16 |
           (free == 0 ? 1u << 21 : 0u);
  }
  if (offset == kTxefs) {
    const unsigned places = field(value(kTxefc), 16, 6);
    const unsigned put = places == 0 ? 0 : (events_.get + events_.fill) % places;
    return events_.fill | events_.get << 8 | put << 16 |
           (places != 0 && events_.fill == places ? 1u << 24 : 0u) | (events_.lost ? 1u << 25 : 0u);
  }
  return value(offset);
}

void FdcanH7::request(std::uint32_t places) {
  if (!running()) return;
  for (unsigned b = 0; b < buffers() + queue_places(); ++b) {
    if (!bit(places, b) || bit(value(kTxbrp), b)) continue;
    value(kTxbrp) |= 1u << b;
    value(kTxbto) &= ~(1u << b);
    value(kTxbcf) &= ~(1u << b);
    asked_.push_back(b);
    if (b >= buffers()) last_queued_ = b;
  }
  transmit_next();
}

void FdcanH7::cancel(std::uint32_t places) {
  for (unsigned b = 0; b < kMostBuffers; ++b) {
    const auto at = std::find(asked_.begin(), asked_.end(), b);
    if (!bit(places, b) || at == asked_.end() || (at == asked_.begin() && sent_at_ != kNever)) continue;
    asked_.erase(at);
    value(kTxbrp) &= ~(1u << b);
    value(kTxbcf) |= 1u << b;
    if (bit(value(kTxbcie), b)) value(kIr) |= kTcf;
  }
}

void FdcanH7::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  // Elements up to the one that is named have been read.
  const auto acknowledge = [written](Fifo& fifo, unsigned places) {
    if (places == 0) return;
    const unsigned upto = (written % places + 1 + places - fifo.get) % places;
    const unsigned taken = std::min(fifo.fill, upto == 0 ? places : upto);
    fifo.get = (fifo.get + taken) % places;
    fifo.fill -= taken;
    fifo.lost = false;
  };
  switch (offset) {
    case kCccr: {
      keep(offset, written, lanes);
      std::uint32_t& cccr = value(kCccr);
      if ((cccr & 1u) == 0) {
        cccr &= ~2u;  // CCE only with INIT
        context_.clocks.need(Bus::kFdcan, name());
      }
      cccr = (cccr & ~8u) | (cccr & 0x10u) >> 1;  // CSA follows CSR
      transmit_next();
      break;
    }
    case kIr:
      value(kIr) &= ~written;
      break;
    case kNdat1:
    case kNdat2:
      value(offset) &= ~written;
      break;
    case kRxf0a:
    case kRxf1a:
      acknowledge(fifos_[offset == kRxf0a ? 0 : 1], fifo_places(offset == kRxf0a ? 0 : 1));
      break;
    case kTxefa:
      acknowledge(events_, field(value(kTxefc), 16, 6));
      break;
    case kTxbar:
      request(written);
      break;
    case kTxbcr:
      cancel(written);
      break;
    default:
      keep(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
