#include "firmware_iface/mcu/stm32/fdcan.h"

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
  kRxgfc = 0x80,
  kRxf0s = 0x90,
  kRxf0a = 0x94,
  kRxf1s = 0x98,
  kRxf1a = 0x9C,
  kTxbc = 0xC0,
  kTxfqs = 0xC4,
  kTxbrp = 0xC8,
  kTxbar = 0xCC,
  kTxbcr = 0xD0,
  kTxbto = 0xD4,
  kTxbcf = 0xD8,
  kTxbtie = 0xDC,
  kTxbcie = 0xE0
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
                                       {kIe, "IE", 0, 0x00FFFFFF},
                                       {kIls, "ILS", 0, 0x7F},
                                       {kIle, "ILE", 0, 3},
                                       {kRxgfc, "RXGFC", 0, 0x0F1F033F},
                                       {0x84, "XIDAM", 0x1FFFFFFF, 0x1FFFFFFF},
                                       {0x88, "HPMS", 0, 0},
                                       {kRxf0s, "RXF0S", 0, 0},
                                       {kRxf0a, "RXF0A", 0, 7},
                                       {kRxf1s, "RXF1S", 0, 0},
                                       {kRxf1a, "RXF1A", 0, 7},
                                       {kTxbc, "TXBC", 0, 0x01000000},
                                       {kTxfqs, "TXFQS", 3, 0},
                                       {kTxbrp, "TXBRP", 0, 0},
                                       {kTxbar, "TXBAR", 0, 0},
                                       {kTxbcr, "TXBCR", 0, 0},
                                       {kTxbto, "TXBTO", 0, 0},
                                       {kTxbcf, "TXBCF", 0, 0},
                                       {kTxbtie, "TXBTIE", 0, 7},
                                       {kTxbcie, "TXBCIE", 0, 7},
                                       {0xE4, "TXEFS", 0, 0},
                                       {0xE8, "TXEFA", 0, 3},
                                       {0x100, "CKDIV", 0, 0xF}};
constexpr unsigned kPlaces = 3;
// IR: new message, full, lost per FIFO; transmission completed, cancelled; transmit FIFO empty
constexpr std::uint32_t kTc = 1u << 7, kTcf = 1u << 8, kTfe = 1u << 9;

// Of the kernel clock, by CKDIV.PDIV.
double divider(std::uint32_t ckdiv) {
  constexpr unsigned kDividers[] = {1, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30};
  return kDividers[ckdiv & 15u];
}
}  // namespace

std::uint32_t FdcanRam::read(std::uint32_t offset, unsigned bytes) {
  std::uint32_t v = 0;
  for (unsigned i = 0; i < bytes && offset + i < bytes_.size(); ++i)
    v |= std::uint32_t{bytes_[offset + i]} << (8 * i);
  return v;
}

void FdcanRam::write(std::uint32_t offset, unsigned bytes, std::uint32_t value) {
  for (unsigned i = 0; i < bytes && offset + i < bytes_.size(); ++i)
    bytes_[offset + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

Fdcan::Fdcan(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context)
    : RegisterBlock("FDCAN" + std::to_string(number), context.system, kRegisters),
      context_(context),
      ram_(ram),
      base_(0x350u * static_cast<unsigned>(number - 1)),
      irq0_(context.irqs, irqs.first),
      irq1_(context.irqs, irqs.second) {
  next_event_is(sent_at_);
}

void Fdcan::reset() {
  RegisterBlock::reset();
  fifos_ = {};
  asked_.clear();
  sent_at_ = kNever;
  update();
}

CanFrame Fdcan::buffer(unsigned place) const {
  const std::uint32_t at = base_ + 0x278 + 72 * place;
  const std::uint32_t t0 = ram_.word(at), t1 = ram_.word(at + 4);
  CanFrame frame;
  frame.extended = bit(t0, 30);
  frame.remote = bit(t0, 29);
  frame.id = frame.extended ? t0 & 0x1FFFFFFFu : field(t0, 18, 11);
  frame.fd = bit(t1, 21) && bit(value(kCccr), 8);
  frame.fast = frame.fd && bit(t1, 20) && bit(value(kCccr), 9);
  frame.bytes = static_cast<std::uint8_t>(can_bytes(field(t1, 16, 4), frame.fd));
  for (unsigned i = 0; i < frame.bytes; ++i)
    frame.data[i] = static_cast<std::uint8_t>(ram_.read(at + 8 + i, 1));
  return frame;
}

// Of the nominal rate, in clocks behind the divider.
double Fdcan::bit_clocks() const {
  const std::uint32_t n = value(kNbtp);
  return (field(n, 16, 9) + 1.0) * (3.0 + field(n, 8, 8) + field(n, 0, 7));
}

double Fdcan::bit_cycles() const {
  return bit_clocks() * divider(value(0x100)) * system().core_hz() / context_.clocks.bus_hz(Bus::kApb1);
}

void Fdcan::transmit_next() {
  if (sent_at_ != kNever || asked_.empty() || !running()) return;
  if (bit(value(kTxbc), 24)) {  // queue: lowest identifier first; FIFO: in order
    const auto key = [this](unsigned b) {
      const CanFrame f = buffer(b);
      return f.extended ? std::uint64_t{f.id} << 1 | 1 : std::uint64_t{f.id} << 19;
    };
    std::stable_sort(asked_.begin(), asked_.end(),
                     [&key](unsigned a, unsigned b) { return key(a) < key(b); });
  }
  const CanFrame frame = buffer(asked_.front());
  const std::uint32_t d = value(kDbtp);
  const double fast = (field(d, 16, 5) + 1.0) * (3.0 + field(d, 8, 5) + field(d, 4, 4));
  const double clocks =
      (can_frame_bits(frame) * bit_clocks() + can_fast_bits(frame) * fast) * divider(value(0x100));
  const double cycles = clocks * system().core_hz() / context_.clocks.bus_hz(Bus::kApb1);
  sent_at_ = now() + std::max<Cycles>(1, static_cast<Cycles>(std::llround(cycles)));
}

void Fdcan::run_events() {
  if (sent_at_ > now() || asked_.empty()) return;
  const unsigned place = asked_.front();
  const Cycles end = sent_at_;
  const CanFrame frame = buffer(place);
  asked_.erase(asked_.begin());
  sent_at_ = kNever;
  value(kTxbrp) &= ~(1u << place);
  value(kTxbto) |= 1u << place;
  if (bit(value(kTxbtie), place)) value(kIr) |= kTc;
  if (asked_.empty()) value(kIr) |= kTfe;
  transmit_next();
  const bool loop = bit(value(kCccr), 7) && bit(value(kTest), 4), silent = loop && bit(value(kCccr), 5);
  if (loop) take(frame);
  if (!silent) sent(frame, end);
  update();
}

int Fdcan::filter(const CanFrame& frame, unsigned& index) const {
  const std::uint32_t global = value(kRxgfc);
  if (frame.remote && bit(global, frame.extended ? 0 : 1)) return -1;
  const unsigned count = frame.extended ? field(global, 24, 4) : field(global, 16, 5);
  for (unsigned i = 0; i < count && i < (frame.extended ? 8u : 28u); ++i) {
    std::uint32_t id1, id2, action, kind;
    if (frame.extended) {
      const std::uint32_t f0 = ram_.word(base_ + 0x70 + 8 * i), f1 = ram_.word(base_ + 0x74 + 8 * i);
      id1 = f0 & 0x1FFFFFFFu, action = f0 >> 29, id2 = f1 & 0x1FFFFFFFu, kind = f1 >> 30;
      if (kind == 3) kind = 0;  // a range, without the extended mask
    } else {
      const std::uint32_t f = ram_.word(base_ + 4 * i);
      id1 = field(f, 16, 11), id2 = field(f, 0, 11), action = field(f, 27, 3), kind = f >> 30;
      if (kind == 3) continue;
    }
    const bool hit = kind == 0   ? frame.id >= id1 && frame.id <= id2
                     : kind == 1 ? frame.id == id1 || frame.id == id2
                                 : ((frame.id ^ id1) & id2) == 0;
    if (!hit || action == 0) continue;
    index = i;
    if (action == 3) return -1;
    if (action == 1 || action == 5) return 0;
    if (action == 2 || action == 6) return 1;
  }
  index = 0x80;  // matched no filter
  const unsigned rest = field(global, frame.extended ? 2 : 4, 2);
  return rest < 2 ? static_cast<int>(rest) : -1;
}

void Fdcan::take(const CanFrame& frame) {
  if (!running() || (frame.fd && !bit(value(kCccr), 8))) return off_bus(now());
  unsigned index = 0;
  const int to = filter(frame, index);
  if (to < 0) return unwanted(now());
  Fifo& fifo = fifos_[static_cast<std::size_t>(to)];
  const unsigned shift = 3 * static_cast<unsigned>(to);
  if (fifo.fill == kPlaces) {
    fifo.lost = true;
    overflow(now());
    value(kIr) |= 4u << shift;
    if (!bit(value(kRxgfc), to == 0 ? 9 : 8)) return update();  // blocking; else the oldest goes
    fifo.get = (fifo.get + 1) % kPlaces;
    --fifo.fill;
  }
  const std::uint32_t at = element(static_cast<unsigned>(to), (fifo.get + fifo.fill) % kPlaces);
  ++fifo.fill;
  ram_.write(at, 4, (frame.extended ? 1u << 30 | frame.id : frame.id << 18) | (frame.remote ? 1u << 29 : 0u));
  ram_.write(at + 4, 4,
             (index & 0x80u) << 24 | (index & 0x7Fu) << 24 | (frame.fd ? 1u << 21 : 0u) |
                 (frame.fast ? 1u << 20 : 0u) | can_dlc(frame.bytes) << 16);
  for (unsigned i = 0; i < frame.bytes; ++i) ram_.write(at + 8 + i, 1, frame.data[i]);
  value(kIr) |= (1u | (fifo.fill == kPlaces ? 2u : 0u)) << shift;
  update();
  system().reschedule();
}

void Fdcan::update() {
  // ILS: groups of IR that go to line 1: FIFO 0, FIFO 1, messages, transmit FIFO, …
  const std::uint32_t active = value(kIr) & value(kIe), ils = value(kIls);
  const std::uint32_t groups[] = {0x7, 0x38, 0x1C0, 0x1E00, 0x6000, 0x18000, 0xFE0000};
  std::uint32_t second = 0;
  for (unsigned g = 0; g < 7; ++g) second |= bit(ils, g) ? groups[g] : 0u;
  irq0_.set(bit(value(kIle), 0) && (active & ~second) != 0);
  irq1_.set(bit(value(kIle), 1) && (active & second) != 0);
}

std::uint32_t Fdcan::load(std::uint32_t offset) {
  if (offset == kRxf0s || offset == kRxf1s) {
    const Fifo& f = fifos_[offset == kRxf0s ? 0 : 1];
    return f.fill | f.get << 8 | (f.get + f.fill) % kPlaces << 16 | (f.fill == kPlaces ? 1u << 24 : 0u) |
           (f.lost ? 1u << 25 : 0u);
  }
  if (offset == kTxfqs) {
    unsigned put = 0;
    while (put < kPlaces && bit(value(kTxbrp), put)) ++put;
    const auto used = static_cast<unsigned>(asked_.size());
    const unsigned get = asked_.empty() ? 0 : asked_.front();
    return (kPlaces - used) | get << 8 | put % kPlaces << 16 | (used == kPlaces ? 1u << 21 : 0u);
  }
  return value(offset);
}

void Fdcan::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  switch (offset) {
    case kCccr: {
      keep(offset, written, lanes);
      std::uint32_t& cccr = value(kCccr);
      if ((cccr & 1u) == 0) cccr &= ~2u;          // CCE only with INIT
      cccr = (cccr & ~8u) | (cccr & 0x10u) >> 1;  // CSA follows CSR
      transmit_next();
      break;
    }
    case kIr:
      value(kIr) &= ~written;
      break;
    case kRxf0a:
    case kRxf1a: {
      Fifo& f = fifos_[offset == kRxf0a ? 0 : 1];
      const unsigned up_to = ((written & 7u) % kPlaces + 1 + kPlaces - f.get) % kPlaces;
      const unsigned taken = std::min(f.fill, up_to == 0 ? kPlaces : up_to);
      f.get = (f.get + taken) % kPlaces;
      f.fill -= taken;
      f.lost = false;
      break;
    }
    case kTxbar:
      if (!running()) break;
      for (unsigned b = 0; b < kPlaces; ++b) {
        if (!bit(written, b) || bit(value(kTxbrp), b)) continue;
        value(kTxbrp) |= 1u << b;
        value(kTxbto) &= ~(1u << b);
        value(kTxbcf) &= ~(1u << b);
        asked_.push_back(b);
      }
      transmit_next();
      break;
    case kTxbcr:
      for (unsigned b = 0; b < kPlaces; ++b) {
        const auto at = std::find(asked_.begin(), asked_.end(), b);
        if (!bit(written, b) || at == asked_.end() || (at == asked_.begin() && sent_at_ != kNever)) continue;
        asked_.erase(at);
        value(kTxbrp) &= ~(1u << b);
        value(kTxbcf) |= 1u << b;
        if (bit(value(kTxbcie), b)) value(kIr) |= kTcf;
      }
      break;
    default:
      keep(offset, written, lanes);
      break;
  }
  update();
}

}  // namespace omnihil::mcu
