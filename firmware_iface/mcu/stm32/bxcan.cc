#include "firmware_iface/mcu/stm32/bxcan.h"

#include <algorithm>

#include "firmware_iface/mcu/stm32/register_table.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kMcr = 0x00,
  kMsr = 0x04,
  kTsr = 0x08,
  kRf0r = 0x0C,
  kIer = 0x14,
  kBtr = 0x1C,
  kTx = 0x180,
  kRx = 0x1B0,
  kFmr = 0x200,
  kFm1r = 0x204,
  kFs1r = 0x20C,
  kFfa1r = 0x214,
  kFa1r = 0x21C,
  kBanks = 0x240
};
constexpr std::uint32_t kInrq = 1, kSleep = 2, kMcrReset = 1u << 15;

std::span<const RegisterInfo> table(unsigned banks) {
  static const auto make = [](unsigned n) {
    RegisterTable t;
    t.add(kMcr, "MCR", 0x00010002, 0x000100FF, 0x00000080);
    t.add(kMsr, "MSR", 0x00000C02, 0);
    t.add(kTsr, "TSR", 0x1C000000, 0);
    t.add(kRf0r, "RF0R", 0, 0);
    t.add(0x10, "RF1R", 0, 0);
    t.add(kIer, "IER", 0, 0x00038F7F);
    t.add(0x18, "ESR", 0, 0x70);
    t.add(kBtr, "BTR", 0x01230000, 0xC37F03FF, 0x80000000);
    for (unsigned m = 0; m < 3; ++m) {
      const std::string s = std::to_string(m);
      t.add(kTx + 16 * m, "TI" + s + "R");
      t.add(kTx + 16 * m + 4, "TDT" + s + "R", 0, 0xFFFF010F, 0x100);
      t.add(kTx + 16 * m + 8, "TDL" + s + "R");
      t.add(kTx + 16 * m + 12, "TDH" + s + "R");
    }
    for (unsigned f = 0; f < 2; ++f) {
      const std::string s = std::to_string(f);
      t.add(kRx + 16 * f, "RI" + s + "R", 0, 0);
      t.add(kRx + 16 * f + 4, "RDT" + s + "R", 0, 0);
      t.add(kRx + 16 * f + 8, "RDL" + s + "R", 0, 0);
      t.add(kRx + 16 * f + 12, "RDH" + s + "R", 0, 0);
    }
    if (n == 0) return t;
    t.add(kFmr, "FMR", 0x2A1C0E01);
    t.add(kFm1r, "FM1R");
    t.add(kFs1r, "FS1R");
    t.add(kFfa1r, "FFA1R");
    t.add(kFa1r, "FA1R");
    for (unsigned b = 0; b < n; ++b) {
      t.add(kBanks + 8 * b, "F" + std::to_string(b) + "R1");
      t.add(kBanks + 8 * b + 4, "F" + std::to_string(b) + "R2");
    }
    return t;
  };
  static const RegisterTable none = make(0), few = make(14), many = make(28);
  return (banks == 0 ? none : banks <= 14 ? few : many).rows();
}

// A frame as a receive mailbox and 32-bit filters show it: identifier, IDE, RTR.
std::uint32_t long_word(const CanFrame& f) {
  return (f.extended ? f.id << 3 | 4u : f.id << 21) | (f.remote ? 2u : 0u);
}
// As 16-bit filters show it: STID[10:0] RTR IDE EXID[17:15].
std::uint32_t short_word(const CanFrame& f) {
  if (!f.extended) return f.id << 5 | (f.remote ? 16u : 0u);
  return (f.id >> 18) << 5 | (f.remote ? 16u : 0u) | 8u | (f.id >> 15 & 7u);
}
}  // namespace

BxCan::BxCan(const std::string& name, std::array<int, 4> irqs, unsigned banks, BxCan* filters,
             ChipContext& context)
    : RegisterBlock(name, context.system, table(banks)),
      context_(context),
      filters_(filters != nullptr ? filters : this),
      banks_(banks),
      irq_tx_(context.irqs, irqs[0]),
      irq_rx0_(context.irqs, irqs[1]),
      irq_rx1_(context.irqs, irqs[2]),
      irq_sce_(context.irqs, irqs[3]) {
  next_event_is(sent_at_);
  if (filters != nullptr) filters->second_ = this;
}

void BxCan::reset() {
  RegisterBlock::reset();
  for (auto& fifo : fifos_) fifo.clear();
  sending_ = -1;
  sent_at_ = kNever;
  update();
}

CanFrame BxCan::mailbox(unsigned m) const {
  const std::uint32_t tir = value(kTx + 16 * m);
  CanFrame frame;
  frame.extended = bit(tir, 2);
  frame.remote = bit(tir, 1);
  frame.id = frame.extended ? tir >> 3 : tir >> 21;
  frame.bytes = static_cast<std::uint8_t>(std::min(value(kTx + 16 * m + 4) & 15u, 8u));
  for (unsigned i = 0; i < frame.bytes && !frame.remote; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(value(kTx + 16 * m + 8 + 4 * (i / 4)) >> (8 * (i % 4)));
  }
  return frame;
}

void BxCan::transmit_next() {
  if (sending_ >= 0 || !running()) return;
  const bool by_request = bit(value(kMcr), 2);  // TXFP, else by identifier
  const auto before = [&](unsigned a, unsigned b) {
    if (by_request) return asked_[a] < asked_[b];
    return long_word(mailbox(a)) < long_word(mailbox(b));
  };
  for (unsigned m = 0; m < 3; ++m) {
    if (!bit(value(kTx + 16 * m), 0)) continue;
    if (sending_ < 0 || before(m, static_cast<unsigned>(sending_))) sending_ = static_cast<int>(m);
  }
  if (sending_ < 0) return;
  const ClockRatio clock = context_.clocks.bus(Bus::kApb1);
  sent_at_ =
      now() + bit_clocks() * can_frame_bits(mailbox(static_cast<unsigned>(sending_))) * clock.div / clock.mul;
}

// Bit time: (BRP + 1)(3 + TS1 + TS2) clocks of APB1
Cycles BxCan::bit_clocks() const {
  const std::uint32_t btr = value(kBtr);
  return Cycles{field(btr, 0, 10) + 1} * (3 + field(btr, 16, 4) + field(btr, 20, 3));
}

double BxCan::bit_cycles() const {
  const ClockRatio clock = context_.clocks.bus(Bus::kApb1);
  return static_cast<double>(bit_clocks() * clock.div) / static_cast<double>(clock.mul);
}

void BxCan::complete(unsigned m, bool ok) {
  value(kTx + 16 * m) &= ~1u;
  std::uint32_t& tsr = value(kTsr);
  tsr = (tsr & ~(0xFu << (8 * m))) | (ok ? 3u : 1u) << (8 * m) | 1u << (26 + m);
}

void BxCan::run_events() {
  if (sent_at_ > now() || sending_ < 0) return;
  const auto m = static_cast<unsigned>(sending_);
  const Cycles end = sent_at_;
  const CanFrame frame = mailbox(m);
  sending_ = -1;
  sent_at_ = kNever;
  complete(m, true);
  transmit_next();
  if (bit(value(kBtr), 30)) take(frame);  // LBKM
  if (!bit(value(kBtr), 31)) sent(frame, end);
  update();
}

bool BxCan::passes(unsigned bank, const CanFrame& frame, unsigned& number, unsigned fifo_numbers[2]) const {
  const bool list = bit(value(kFm1r), bank), whole = bit(value(kFs1r), bank);
  const unsigned fifo = bit(value(kFfa1r), bank) ? 1 : 0;
  const std::uint32_t r1 = value(kBanks + 8 * bank), r2 = value(kBanks + 8 * bank + 4);
  const std::uint32_t word = long_word(frame), half = short_word(frame);
  bool hit[4] = {};
  unsigned n = 0;
  if (whole && list) {
    hit[n++] = word == (r1 & ~1u);
    hit[n++] = word == (r2 & ~1u);
  } else if (whole) {
    hit[n++] = ((word ^ r1) & r2 & ~1u) == 0;
  } else if (list) {
    for (const std::uint32_t r : {r1, r2}) {
      hit[n++] = half == (r & 0xFFFFu);
      hit[n++] = half == r >> 16;
    }
  } else {
    for (const std::uint32_t r : {r1, r2}) hit[n++] = ((half ^ r) & r >> 16 & 0xFFFFu) == 0;
  }
  const unsigned base = fifo_numbers[fifo];
  fifo_numbers[fifo] += n;
  if (!bit(value(kFa1r), bank)) return false;
  for (unsigned i = 0; i < n; ++i) {
    if (!hit[i]) continue;
    number = base + i;
    return true;
  }
  return false;
}

int BxCan::match(const CanFrame& frame, unsigned first, unsigned last, unsigned& number) const {
  if (bit(value(kFmr), 0)) return -1;  // FINIT: filters are being set
  unsigned fifo_numbers[2] = {0, 0};
  int found = -1;
  for (unsigned bank = first; bank < last && bank < banks_; ++bank) {
    unsigned here = 0;
    const bool hit = passes(bank, frame, here, fifo_numbers);
    if (!hit || found >= 0) continue;
    found = bit(value(kFfa1r), bank) ? 1 : 0;
    number = here;
  }
  return found;
}

void BxCan::take(const CanFrame& frame) {
  if (!running() || frame.fd) return off_bus(now());
  const bool second = filters_ != this;
  unsigned split = filters_->banks_ > 14 ? field(filters_->value(kFmr), 8, 6) : 28;
  // With all of them given to a second controller that is off, the first one's still work (RM0090 says that none do; HAL
  // users who leave the field at 0 receive all the same: ST community, "CAN2 start bank ignored", 2016).
  if (!second && split == 0 && (second_ == nullptr || !second_->running())) split = 28;
  unsigned number = 0;
  const int fifo = second ? filters_->match(frame, split, 28, number) : match(frame, 0, split, number);
  if (fifo < 0) return unwanted(now());
  auto& queue = fifos_[static_cast<std::size_t>(fifo)];
  std::uint32_t& rfr = value(kRf0r + 4 * static_cast<unsigned>(fifo));
  if (queue.size() == 3) {
    rfr |= 1u << 4;  // FOVR
    overflow(now());
    if (!bit(value(kMcr), 3)) queue.back() = {frame, number};
  } else {
    queue.push_back({frame, number});
    if (queue.size() == 3) rfr |= 1u << 3;
  }
  show(static_cast<unsigned>(fifo));
  update();
  system().reschedule();
}

// The oldest frame of a FIFO in its mailbox.
void BxCan::show(unsigned fifo) {
  const auto& queue = fifos_[fifo];
  std::uint32_t& rfr = value(kRf0r + 4 * fifo);
  rfr = (rfr & ~3u) | static_cast<std::uint32_t>(queue.size());
  if (queue.empty()) return;
  const CanFrame& frame = queue.front().frame;
  const unsigned at = kRx + 16 * fifo;
  value(at) = long_word(frame);
  value(at + 4) = frame.bytes | queue.front().filter << 8;
  for (unsigned w = 0; w < 2; ++w) {
    value(at + 8 + 4 * w) = 0;
    for (unsigned i = 0; i < 4; ++i) value(at + 8 + 4 * w) |= std::uint32_t{frame.data[4 * w + i]} << (8 * i);
  }
}

void BxCan::update() {
  const std::uint32_t ier = value(kIer);
  irq_tx_.set(bit(ier, 0) && (value(kTsr) & 0x00010101u) != 0);
  for (unsigned f = 0; f < 2; ++f) {
    const std::uint32_t rfr = value(kRf0r + 4 * f);
    const bool high = (bit(ier, 1 + 3 * f) && (rfr & 3u) != 0) || (bit(ier, 2 + 3 * f) && bit(rfr, 3)) ||
                      (bit(ier, 3 + 3 * f) && bit(rfr, 4));
    (f == 0 ? irq_rx0_ : irq_rx1_).set(high);
  }
}

std::uint32_t BxCan::load(std::uint32_t offset) {
  if (offset != kTsr) return value(offset);
  std::uint32_t tsr = value(kTsr) & ~(3u << 24);  // CODE: the first free mailbox
  for (unsigned m = 0; m < 3; ++m) {
    if (bit(tsr, 26 + m)) return tsr | m << 24;
  }
  return tsr;
}

void BxCan::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kMcr) {
    if ((written & kMcrReset) != 0) return reset();
    keep(offset, written, lanes);
    const std::uint32_t mcr = value(kMcr);
    const std::uint32_t state = (mcr & kInrq) != 0 ? 1u : (mcr & kSleep) != 0 ? 2u : 0u;
    value(kMsr) = (value(kMsr) & ~3u) | state;
    transmit_next();
  } else if (offset == kMsr) {
    value(kMsr) &= ~(written & 0x1Cu);
  } else if (offset == kTsr) {
    for (unsigned m = 0; m < 3; ++m) {
      if (bit(written, 8 * m)) value(kTsr) &= ~(0xFu << (8 * m));
      if (bit(written, 8 * m + 7) && bit(value(kTx + 16 * m), 0) && sending_ != static_cast<int>(m))
        complete(m, false);
    }
  } else if (offset == kRf0r || offset == kRf0r + 4) {
    const unsigned fifo = (offset - kRf0r) / 4;
    value(offset) &= ~(written & 0x18u);
    if (bit(written, 5) && !fifos_[fifo].empty()) {
      fifos_[fifo].pop_front();
      show(fifo);
    }
  } else if (offset >= kTx && offset < kRx && (offset - kTx) % 16 == 0) {
    const unsigned m = (offset - kTx) / 16;
    if (!bit(value(kTsr), 26 + m)) return;  // occupied
    keep(offset, written, lanes);
    if (bit(value(offset), 0)) {
      asked_[m] = ++requests_;
      value(kTsr) &= ~(0xFu << (8 * m) | 1u << (26 + m));
      transmit_next();
    }
  } else {
    keep(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
