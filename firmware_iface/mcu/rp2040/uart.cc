#include "firmware_iface/mcu/rp2040/uart.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint16_t {
  kDr = 0x00,
  kRsr = 0x04,
  kFr = 0x18,
  kIbrd = 0x24,
  kFbrd = 0x28,
  kLcr = 0x2C,
  kCr = 0x30,
  kIfls = 0x34,
  kImsc = 0x38,
  kRis = 0x3C,
  kMis = 0x40,
  kIcr = 0x44,
  kDmacr = 0x48
};
constexpr RegisterInfo kRegisters[] = {{kDr, "UARTDR", 0, 0},
                                       {kRsr, "UARTRSR", 0, 0},
                                       {kFr, "UARTFR", 0x90, 0},
                                       {0x20, "UARTILPR", 0, 0xFF, 0xFF},
                                       {kIbrd, "UARTIBRD", 0, 0xFFFF},
                                       {kFbrd, "UARTFBRD", 0, 0x3F},
                                       {kLcr, "UARTLCR_H", 0, 0xFF, 0x81},
                                       {kCr, "UARTCR", 0x300, 0xFF87, 0xC086},
                                       {kIfls, "UARTIFLS", 0x12, 0x3F},
                                       {kImsc, "UARTIMSC", 0, 0x7FF},
                                       {kRis, "UARTRIS", 0, 0},
                                       {kMis, "UARTMIS", 0, 0},
                                       {kIcr, "UARTICR", 0, 0},
                                       {kDmacr, "UARTDMACR", 0, 7},
                                       {0xFE0, "UARTPERIPHID0", 0x11, 0},
                                       {0xFE4, "UARTPERIPHID1", 0x10, 0},
                                       {0xFE8, "UARTPERIPHID2", 0x34, 0},
                                       {0xFEC, "UARTPERIPHID3", 0, 0},
                                       {0xFF0, "UARTPCELLID0", 0x0D, 0},
                                       {0xFF4, "UARTPCELLID1", 0xF0, 0},
                                       {0xFF8, "UARTPCELLID2", 0x05, 0},
                                       {0xFFC, "UARTPCELLID3", 0xB1, 0}};
enum : std::uint32_t { kRx = 1u << 4, kTx = 1u << 5, kTimeout = 1u << 6, kOverrun = 1u << 10 };
constexpr unsigned kTxe = 8, kRxe = 9, kFifos = 4, kParity = 1, kEven = 2, kTwoStops = 3;
// Part of 32 at which a level is reached: IFLS of both FIFOs.
constexpr std::size_t kLevels[] = {4, 8, 16, 24, 28, 28, 28, 28};
}  // namespace

RpUart::RpUart(unsigned number, int irq, ChipContext& context)
    : Rp2040Block("UART" + std::to_string(number), context.system, kRegisters),
      context_(context),
      irq_(context.irqs, irq),
      dma_rx_(context.dma.line(name() + "_RX")),
      dma_tx_(context.dma.line(name() + "_TX")) {
  next_event_is(next_);
  context.clocks.listen(*this);
}

void RpUart::reset() {
  Rp2040Block::reset();
  raw_ = errors_ = 0;
  gap_ = false;
  received_.clear();
  holding_.clear();
  sent_at_ = timeout_at_ = kNever;
  schedule();
  update();
}

bool RpUart::on(unsigned which) const { return bit(value(kCr), 0) && bit(value(kCr), which); }
std::size_t RpUart::depth() const { return bit(value(kLcr), kFifos) ? 32 : 1; }
unsigned RpUart::data_bits() const { return 5 + field(value(kLcr), 5, 2); }
unsigned RpUart::frame_bits() const {
  return 1 + data_bits() + (bit(value(kLcr), kParity) ? 1 : 0) + (bit(value(kLcr), kTwoStops) ? 2 : 1);
}

double RpUart::baud() const {
  const double divider = value(kIbrd) + value(kFbrd) / 64.0;
  return context_.clocks.bus_hz(Bus::kPeripheral) / (16.0 * std::max(divider, 1.0));
}

Cycles RpUart::bit_times(unsigned bits) const {
  return std::max<Cycles>(1, static_cast<Cycles>(std::llround(bits * system().core_hz() / baud())));
}

void RpUart::feed(std::span<const std::uint8_t> bytes, std::int64_t at_ns, double bit_ns) {
  const double one = bit_ns > 0 ? bit_ns : 1e9 / baud();
  const auto frame_ns = static_cast<std::int64_t>(std::llround(one * frame_bits()));
  std::int64_t at = waiting_.empty() ? at_ns : std::max(at_ns, waiting_.back().at_ns);
  for (const std::uint8_t byte : bytes) waiting_.push_back({at += frame_ns, byte});
  schedule();
  system().reschedule();
}

void RpUart::clock_changed() { schedule(); }

void RpUart::schedule() {
  comes_at_ = waiting_.empty() ? kNever : std::max(now(), system().from_ns(waiting_.front().at_ns));
  next_ = std::min({sent_at_, comes_at_, timeout_at_});
}

void RpUart::show_frame(bool sent, std::uint8_t byte, Cycles end) const {
  if (!watcher_) return;
  const unsigned bits = data_bits(), stops = bit(value(kLcr), kTwoStops) ? 2 : 1;
  std::uint32_t levels = byte & ((1u << bits) - 1u);
  unsigned at = bits;
  if (bit(value(kLcr), kParity)) {
    const bool odd = (std::popcount(levels) & 1) != 0;
    levels |= (odd == bit(value(kLcr), kEven) ? 1u : 0u) << at++;
  }
  levels = (levels | ((1u << stops) - 1u) << at) << 1;
  watcher_({sent, byte, levels, frame_bits(), bit_times(1), end});
}

void RpUart::run_events() {
  if (next_ > now()) return;
  if (sent_at_ <= now()) {
    const Cycles end = sent_at_;
    const std::uint8_t byte = shifting_;
    sent_at_ = kNever;
    show_frame(true, byte, end);
    if (!holding_.empty()) {
      const std::size_t before = holding_.size();
      shifting_ = holding_.front();
      holding_.pop_front();
      sent_at_ = end + bit_times(frame_bits());
      const std::size_t trigger = depth() == 1 ? 0 : kLevels[field(value(kIfls), 0, 3)];
      if (before > trigger && holding_.size() <= trigger) raw_ |= kTx;  // passes its level downwards
    }
    if (on_transmit_)
      on_transmit_(byte, end);
    else
      ledger_.lost("byte", "sent, the port leads nowhere", end);
  }
  while (!waiting_.empty() && comes_at_ <= now()) {
    const std::uint8_t byte = waiting_.front().byte;
    waiting_.pop_front();
    schedule();
    show_frame(false, byte, now());
    receive(byte);
  }
  if (timeout_at_ <= now()) {
    timeout_at_ = kNever;
    if (!received_.empty()) raw_ |= kTimeout;
  }
  schedule();
  update();
}

void RpUart::receive(std::uint8_t byte) {
  if (!on(kRxe)) return ledger_.lost("byte", "came while the receiver was off", now());
  if (received_.size() >= depth()) {
    raw_ |= kOverrun;
    errors_ |= 8u;
    gap_ = true;
    ledger_.lost("byte", "came before the ones before it were read (overrun)", now());
    return;
  }
  constexpr unsigned kOe = 11;
  received_.push_back(static_cast<std::uint16_t>((byte & ((1u << data_bits()) - 1u)) |
                                                 (std::exchange(gap_, false) ? 1u << kOe : 0u)));
  constexpr unsigned kTimeoutBits = 32;
  timeout_at_ = depth() > 1 ? now() + bit_times(kTimeoutBits) : kNever;
  levels();
}

void RpUart::transmit(std::uint8_t byte) {
  if (!on(kTxe)) return;
  if (sent_at_ == kNever) {
    shifting_ = byte;
    sent_at_ = now() + bit_times(frame_bits());
    if (depth() == 1) raw_ |= kTx;  // its one place is free again at once
  } else if (holding_.size() < depth()) {
    holding_.push_back(byte);
    if (holding_.size() > (depth() == 1 ? 0 : kLevels[field(value(kIfls), 0, 3)])) raw_ &= ~kTx;
  } else {
    ledger_.lost("byte", "written while the transmit FIFO was full", now());
  }
  schedule();
}

// The receive interrupt follows the FIFO's level.
void RpUart::levels() {
  const std::size_t trigger = depth() == 1 ? 1 : kLevels[field(value(kIfls), 3, 3)];
  if (received_.size() >= trigger)
    raw_ |= kRx;
  else
    raw_ &= ~kRx;
}

std::uint32_t RpUart::flags() const {
  return (received_.empty() ? 1u << 4 : 0u) | (holding_.size() >= depth() ? 1u << 5 : 0u) |
         (received_.size() >= depth() ? 1u << 6 : 0u) | (holding_.empty() ? 1u << 7 : 0u) |
         (sent_at_ != kNever ? 1u << 3 : 0u);
}

void RpUart::update() {
  irq_.set((raw_ & value(kImsc)) != 0);
  context_.dma.set(dma_rx_, !received_.empty() && bit(value(kDmacr), 0));
  context_.dma.set(dma_tx_, holding_.size() < depth() && bit(value(kDmacr), 1) && on(kTxe));
}

std::uint32_t RpUart::load(std::uint32_t offset) {
  const std::uint32_t is = shown(offset);
  if (offset == kDr && !received_.empty()) {
    received_.pop_front();
    levels();
    if (received_.empty()) raw_ &= ~kTimeout, timeout_at_ = kNever;
    schedule();
    update();
  }
  return is;
}

std::uint32_t RpUart::shown(std::uint32_t offset) {
  switch (offset) {
    case kDr:
      return received_.empty() ? 0u : received_.front();
    case kRsr:
      return errors_;
    case kFr:
      return flags();
    case kRis:
      return raw_;
    case kMis:
      return raw_ & value(kImsc);
    default:
      return value(offset);
  }
}

void RpUart::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kDr) {
    transmit(static_cast<std::uint8_t>(written & ((1u << data_bits()) - 1u)));
  } else if (offset == kIcr) {
    raw_ &= ~written;
  } else if (offset == kRsr) {
    errors_ = 0;
  } else {
    keep(offset, written, lanes);
    if (offset == kCr && bit(value(kCr), 0)) context_.clocks.need(Bus::kPeripheral, name());
    if (offset == kLcr || offset == kIfls) levels();
  }
  update();
}

}  // namespace omnihil::mcu::rp2040
