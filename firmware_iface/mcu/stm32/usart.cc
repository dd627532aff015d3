#include "firmware_iface/mcu/stm32/usart.h"

#include <algorithm>
#include <cmath>

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
constexpr RegisterInfo kV1[] = {{0x00, "SR", 0xC0, 0},
                                {0x04, "DR", 0, 0},
                                {0x08, "BRR", 0, 0xFFFF},
                                {0x0C, "CR1", 0, 0xBFFF, 0x0003},
                                {0x10, "CR2", 0, 0x7F7F, 0x4800},
                                {0x14, "CR3", 0, 0x0FFF, 0x0326},
                                {0x18, "GTPR", 0, 0xFFFF}};
constexpr RegisterInfo kControlOfV2[] = {{0x00, "CR1", 0, 0xFFFFFFFF, 0xEC006002},
                                         {0x04, "CR2", 0, 0xFFFFFFFF, 0x00FFC800},
                                         {0x08, "CR3", 0, 0xFFFFFFFF, 0xFF008326}};
constexpr RegisterInfo kRateOfV2[] = {{0x0C, "BRR", 0, 0xFFFF}, {0x10, "GTPR", 0, 0xFFFF}, {0x14, "RTOR", 0}};
constexpr RegisterInfo kRateOfLowPower[] = {{0x0C, "BRR", 0, 0xFFFFF}};
constexpr RegisterInfo kDataOfV2[] = {{0x18, "RQR", 0, 0}, {0x1C, "ISR", 0xC0, 0},
                                      {0x20, "ICR", 0, 0}, {0x24, "RDR", 0, 0},
                                      {0x28, "TDR", 0, 0}, {0x2C, "PRESC", 0, 0xF, 0xF}};
constexpr RegisterInfo kControlWithFifo[] = {{0x00, "CR1", 0, 0xFFFFFFFF, 0x0C006002},
                                             {0x04, "CR2", 0, 0xFFFFFFFF, 0x00FFC800},
                                             {0x08, "CR3", 0, 0xFFFFFFFF, 0x01008326}};
constexpr RegisterInfo kDataWithFifo[] = {{0x18, "RQR", 0, 0}, {0x1C, "ISR", 0xC0, 0},
                                          {0x20, "ICR", 0, 0}, {0x24, "RDR", 0, 0},
                                          {0x28, "TDR", 0, 0}, {0x2C, "PRESC", 0, 0xF}};
constexpr auto kV2 = joined(kControlOfV2, kRateOfV2, kDataOfV2);
constexpr auto kFifo = joined(kControlWithFifo, kRateOfV2, kDataWithFifo);
constexpr auto kLowPowerFifo = joined(kControlWithFifo, kRateOfLowPower, kDataWithFifo);
constexpr auto kLowPower = joined(kControlOfV2, kRateOfLowPower, kDataOfV2);

std::span<const RegisterInfo> rows_of(const UsartSpec& spec) {
  if (spec.low_power) return spec.fifo > 0 ? std::span<const RegisterInfo>(kLowPowerFifo) : kLowPower;
  if (spec.fifo > 0) return kFifo;
  return spec.v2 ? std::span<const RegisterInfo>(kV2) : kV1;
}
// Status: the same places in SR and ISR.
constexpr std::uint32_t kOre = 1u << 3, kIdle = 1u << 4, kRxne = 1u << 5, kTc = 1u << 6, kTxe = 1u << 7;
constexpr std::uint32_t kErrors = 0x1F;
constexpr std::uint32_t kTxfe = 1u << 23, kRxff = 1u << 24, kRxft = 1u << 26, kTxft = 1u << 27;  // with FIFOs
// CR1
constexpr std::uint32_t kRe = 1u << 2, kTe = 1u << 3, kPce = 1u << 10, kM = 1u << 12, kOver8 = 1u << 15;
constexpr std::uint32_t kDmar = 1u << 6, kDmat = 1u << 7;  // CR3
}  // namespace

Usart::Usart(UsartSpec spec, ChipContext& context)
    : RegisterBlock(spec.name, context.system, rows_of(spec)),
      spec_(std::move(spec)),
      context_(context),
      irq_(context.irqs, spec_.irq),
      dma_rx_(context.dma.line(spec_.name + "_RX")),
      dma_tx_(context.dma.line(spec_.name + "_TX")) {
  next_event_is(next_);
  context.clocks.listen(*this);
  Usart::reset();
}

void Usart::reset() {
  RegisterBlock::reset();
  status_ = kTxe | kTc;
  status_read_ = false;
  holding_.clear();
  received_more_.clear();
  schedule(transmit_end_, kNever);
  schedule(idle_at_, kNever);
  update();
}

bool Usart::on(std::uint32_t which) const { return bit(cr1(), spec_.v2 ? 0 : 13) && (cr1() & which) != 0; }

// Core cycles of one bit: BRR periods of the bus clock (by 16), or as RM0316 §29.5.4 for oversampling by 8.
Cycles Usart::bit_cycles() const {
  const std::uint32_t brr = value(spec_.v2 ? 0x0C : 0x08);
  const std::uint32_t periods = (cr1() & kOver8) != 0 ? ((brr & 0xFFF0u) | (brr & 0x7u) << 1) / 2 : brr;
  const ClockRatio clock = context_.clocks.bus(spec_.bus);
  constexpr unsigned kPrescalers[] = {1, 2, 4, 6, 8, 10, 12, 16, 32, 64, 128, 256, 256, 256, 256, 256};
  const Cycles each = Cycles{clock.div} * (spec_.fifo > 0 ? kPrescalers[value(0x2C) & 15u] : 1);
  if (spec_.low_power) return std::max<Cycles>(1, Cycles{brr} * each / (Cycles{256} * clock.mul));
  return std::max<Cycles>(1, Cycles{periods} * each / clock.mul);
}

double Usart::baud() const { return system().core_hz() / static_cast<double>(bit_cycles()); }

unsigned Usart::frame_bits() const {
  const unsigned data = (cr1() & kM) != 0 ? 9 : spec_.v2 && bit(cr1(), 28) ? 7 : 8;
  return 1 + data + (field(cr2(), 12, 2) == 2 ? 2 : 1);
}

void Usart::feed(std::span<const std::uint8_t> bytes, std::int64_t at_ns, double bit_ns) {
  const double bit = bit_ns > 0 ? bit_ns : 1e9 / baud();
  const auto frame_ns = static_cast<std::int64_t>(std::llround(bit * frame_bits()));
  std::int64_t at = at_ns;
  if (!waiting_.empty()) at = std::max(at, waiting_.back().at_ns);
  for (const std::uint8_t byte : bytes) waiting_.push_back({at += frame_ns, byte});
  clock_changed();
  system().reschedule();
}

void Usart::clock_changed() {
  schedule(receive_at_,
           waiting_.empty() ? kNever : std::max(now(), system().from_ns(waiting_.front().at_ns)));
}

void Usart::run_events() {
  if (transmit_end_ <= now()) {
    const Cycles end = transmit_end_;
    const auto byte = static_cast<std::uint8_t>(shifting_);
    if (watcher_) show_frame(true, shifting_, end);
    schedule(transmit_end_, kNever);
    if (!holding_.empty()) {
      shifting_ = holding_.front();
      holding_.pop_front();
      schedule(transmit_end_, end + frame_cycles());
      status_ |= kTxe;
    } else {
      status_ |= kTc;
    }
    if (on_transmit_) {
      on_transmit_(byte, end);
    } else {
      ledger_.lost("byte", "sent, the port leads nowhere", end);
    }
  }
  while (!waiting_.empty() && receive_at_ <= now()) {
    const std::uint8_t byte = waiting_.front().byte;
    waiting_.pop_front();
    clock_changed();
    if (watcher_) show_frame(false, byte, now());
    receive(byte);
  }
  if (idle_at_ <= now()) {
    schedule(idle_at_, kNever);
    status_ |= kIdle;
  }
  update();
}

void Usart::show_frame(bool sent, std::uint32_t data, Cycles end) const {
  const unsigned bits = frame_bits(), stop = field(cr2(), 12, 2) == 2 ? 2 : 1, of_data = bits - 1 - stop;
  std::uint32_t levels = data & ((1u << of_data) - 1u);
  if ((cr1() & kPce) != 0) {  // the last of them is made
    levels &= (1u << (of_data - 1)) - 1u;
    const bool odd = (__builtin_popcount(levels) & 1) != 0;
    if (odd != bit(cr1(), 9)) levels |= 1u << (of_data - 1);
  }
  levels = levels << 1 | ((1u << stop) - 1u) << (1 + of_data);
  watcher_({sent, static_cast<std::uint8_t>(data), levels, bits, bit_cycles(), end});
}

void Usart::receive(std::uint8_t byte) {
  if (!on(kRe)) return ledger_.lost("byte", "came while the receiver was off", now());
  schedule(idle_at_, now() + frame_cycles());
  std::uint32_t data = byte;
  if ((cr1() & (kPce | kM)) == (kPce | kM)) {  // the parity bit is the ninth
    const bool odd = (__builtin_popcount(byte) & 1) != 0;
    data |= (odd != bit(cr1(), 9) ? 1u : 0u) << 8;
  }
  if ((status_ & kRxne) != 0 && received_count() < capacity()) {
    received_more_.push_back(data);
  } else if ((status_ & kRxne) != 0) {
    if (!(spec_.v2 && bit(cr3(), 12))) status_ |= kOre;
    ++overruns_;
    ledger_.lost("byte", "came before the one before them was read (overrun)", now());
    if (spec_.v2 && bit(cr3(), 12)) received_ = data;  // OVRDIS: the newest byte wins
  } else {
    received_ = data;
    status_ |= kRxne;
  }
  update();
}

void Usart::transmit(std::uint32_t data) {
  if (!on(kTe)) return;
  status_ &= ~kTc;
  if (transmit_end_ == kNever) {
    shifting_ = data;
    schedule(transmit_end_, now() + frame_cycles());
  } else {
    if (holding_.size() >= capacity()) holding_.pop_back();  // written over
    holding_.push_back(data);
    if (holding_.size() >= capacity()) status_ &= ~kTxe;
  }
}

// Interrupt and DMA lines follow the flags. DMA last: it reads and writes the data register at once.
void Usart::update() {
  const std::uint32_t enable = cr1();
  bool asks = false;
  if (spec_.fifo > 0) {  // empty, full, and the thresholds of CR3
    const std::uint32_t fifo = fifo_status();
    asks = ((fifo & kTxfe) != 0 && bit(enable, 30)) || ((fifo & kRxff) != 0 && bit(enable, 31)) ||
           ((fifo & kTxft) != 0 && bit(cr3(), 23)) || ((fifo & kRxft) != 0 && bit(cr3(), 28));
  }
  irq_.set(asks || (status_ & enable & (kIdle | kRxne | kTc | kTxe)) != 0 ||
           ((status_ & kOre) != 0 && ((enable & kRxne) != 0 || bit(cr3(), 0))));
  context_.dma.set(dma_rx_, (status_ & kRxne) != 0 && (cr3() & kDmar) != 0);
  context_.dma.set(dma_tx_, (status_ & kTxe) != 0 && (cr3() & kDmat) != 0 && on(kTe));
}

// TXFE, RXFF, RXFT, TXFT while the FIFOs are on.
std::uint32_t Usart::fifo_status() const {
  if (capacity() == 1) return 0;
  constexpr unsigned kEighths[] = {1, 2, 4, 6, 7, 8, 8, 8};
  const std::size_t full = capacity(), in = received_count(), out = holding_.size();
  std::uint32_t status = (out == 0 ? kTxfe : 0u) | (in == full ? kRxff : 0u);
  if (in * 8 >= full * kEighths[field(cr3(), 25, 3)]) status |= kRxft;
  if ((full - out) * 8 >= full * kEighths[field(cr3(), 29, 3)]) status |= kTxft;
  return status;
}

std::uint32_t Usart::take() {
  const std::uint32_t data = received_;
  if (received_more_.empty()) {
    status_ &= ~kRxne;
  } else {
    received_ = received_more_.front();
    received_more_.pop_front();
  }
  if (status_read_) status_ &= ~kErrors;  // v1: SR, then DR
  status_read_ = false;
  update();
  return data;
}

std::uint32_t Usart::load(std::uint32_t offset) {
  if (!spec_.v2) {
    if (offset == 0x00) {
      status_read_ = true;
      return status_;
    }
    return offset == 0x04 ? take() : value(offset);
  }
  if (offset == 0x1C) {  // TEACK, REACK follow TE, RE
    return status_ | (spec_.fifo > 0 ? fifo_status() : 0u) | (on(kTe) ? 1u << 21 : 0u) |
           (on(kRe) ? 1u << 22 : 0u);
  }
  return offset == 0x24 ? take() : value(offset);
}

std::uint32_t Usart::shown(std::uint32_t offset) {
  if (offset == (spec_.v2 ? 0x24u : 0x04u)) return received_;
  return !spec_.v2 && offset == 0x00 ? status_ : load(offset);
}

void Usart::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == (spec_.v2 ? 0x28u : 0x04u)) {
    transmit(written & 0x1FFu);
  } else if (!spec_.v2 && offset == 0x00) {
    status_ &= written | ~lanes | ~(kRxne | kTc);
  } else if (spec_.v2 && offset == 0x20) {
    status_ &= ~(written & (kErrors | kTc));
  } else if (spec_.v2 && offset == 0x18) {
    if (bit(written, 3)) {  // RXFRQ
      status_ &= ~kRxne;
      received_more_.clear();
    }
    if (bit(written, 4)) {  // TXFRQ
      holding_.clear();
      status_ |= kTxe;
    }
  } else {
    keep(offset, written, lanes);
    control_changed();
  }
  update();
}

void Usart::control_changed() {
  if (bit(cr1(), spec_.v2 ? 0 : 13)) return context_.clocks.need(spec_.bus, name());
  received_more_.clear();
  if (transmit_end_ == kNever) return;  // switched off in the middle of a frame: it is lost
  schedule(transmit_end_, kNever);
  holding_.clear();
  status_ |= kTxe | kTc;
}

}  // namespace omnihil::mcu
