// SPI of H7 (RM0433 §50): settings while it is off, transfers of TSIZE frames that CSTART begins, FIFOs of bytes.
#include <cmath>
#include <deque>

#include "firmware_iface/mcu/stm32/spi.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr1 = 0x00,
  kCr2 = 0x04,
  kCfg1 = 0x08,
  kCfg2 = 0x0C,
  kIer = 0x10,
  kSr = 0x14,
  kIfcr = 0x18,
  kTxdr = 0x20,
  kRxdr = 0x30
};
constexpr RegisterInfo kRegisters[] = {{kCr1, "CR1", 0, 0x0001FF01, 0x0001E900},
                                       {kCr2, "CR2", 0, 0xFFFFFFFF, 0xFFFF0000},
                                       {kCfg1, "CFG1", 0x00070007, 0x705FDFFF, 0x00401E00},
                                       {kCfg2, "CFG2", 0, 0xF7FE80FF, 0x00BA8000},
                                       {kIer, "IER", 0, 0x7FF, 0x5A0},
                                       {kSr, "SR", 0x1002, 0},
                                       {kIfcr, "IFCR", 0, 0},
                                       {kTxdr, "TXDR", 0, 0},
                                       {kRxdr, "RXDR", 0, 0},
                                       {0x40, "CRCPOLY", 0x107},
                                       {0x44, "TXCRC", 0, 0},
                                       {0x48, "RXCRC", 0, 0},
                                       {0x4C, "UDRDR"},
                                       {0x50, "I2SCFGR", 0, 0x03FF7FFF, 0x1}};
// SR
constexpr std::uint32_t kRxp = 1u << 0, kTxp = 1u << 1, kDxp = 1u << 2, kEot = 1u << 3, kTxtf = 1u << 4,
                        kOvr = 1u << 6, kModf = 1u << 9, kSusp = 1u << 11, kTxc = 1u << 12, kRxwne = 1u << 15;
constexpr std::uint32_t kFlags = kEot | kTxtf | kOvr | kModf | kSusp;  // that stay until they are cleared
constexpr std::uint32_t kSpe = 1u << 0, kCstart = 1u << 9, kCsusp = 1u << 10, kMaster = 1u << 22;

class SpiV3 final : public Spi {
 public:
  SpiV3(const SpiSpec& spec, ChipContext& context) : Spi(spec, kRegisters, context) {
    next_event_is(frame_end_);
  }
  void reset() override {
    RegisterBlock::reset();
    flags_ = 0;
    stop();
    update();
  }
  void run_events() override;
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override {
    access_bytes_ = bytes;
    return RegisterBlock::read(offset, bytes);
  }
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == kRxdr ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override {
    if (offset == kSr) return status();
    return offset == kRxdr ? (receive_.empty() ? 0 : receive_.front()) : value(offset);
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  bool on() const { return (value(kCr1) & kSpe) != 0; }
  unsigned frame_bits() const { return std::max(field(value(kCfg1), 0, 5), 3u) + 1; }
  // What a frame takes in a FIFO: whole bytes, three of them as four.
  std::size_t frame_bytes() const { return frame_bits() <= 8 ? 1 : frame_bits() <= 16 ? 2 : 4; }
  std::size_t capacity() const { return spec_.fifo_bytes / frame_bytes(); }
  std::size_t threshold() const { return std::min<std::size_t>(field(value(kCfg1), 5, 4) + 1, capacity()); }
  std::uint32_t size() const { return field(value(kCr2), 0, 16); }  // of the transfer; 0: without an end
  Cycles frame_cycles() const {
    const ClockRatio clock = context_.clocks.bus(spec_.bus);
    return std::max<Cycles>(
        1, Cycles{frame_bits()} * (2u << field(value(kCfg1), 28, 3)) * clock.div / clock.mul);
  }
  bool awaits_more() const { return size() == 0 || given_ < size(); }  // frames of the processor
  void stop() {
    transmit_.clear();
    receive_.clear();
    given_ = done_ = 0;
    frame_end_ = kNever;
    value(kCr1) &= ~kCstart;
  }
  void begin();
  std::uint32_t status() const;
  void update();

  std::deque<std::uint32_t> transmit_, receive_;
  std::uint32_t flags_ = 0, shifting_ = 0;
  std::uint32_t given_ = 0, done_ = 0;  // frames of this transfer: written, exchanged
  unsigned access_bytes_ = 4;           // of the read that is going on: how many frames it takes from RXDR
  Cycles frame_end_ = kNever;
};

void SpiV3::begin() {
  if (frame_end_ != kNever || transmit_.empty() || !on() || (value(kCr1) & kCstart) == 0) return;
  shifting_ = transmit_.front();
  transmit_.pop_front();
  frame_end_ = now() + frame_cycles();
}

void SpiV3::run_events() {
  if (frame_end_ > now()) return;
  const Cycles end = std::exchange(frame_end_, kNever);
  const std::uint32_t answer = exchange(shifting_, frame_bits()), cfg2 = value(kCfg2);
  passed({shifting_, answer, frame_bits(), end - frame_cycles(), end, bit(cfg2, 25), bit(cfg2, 24)});
  const bool simplex = field(cfg2, 17, 2) == 1;  // COMM: transmits alone
  if (!simplex && receive_.size() < capacity()) {
    receive_.push_back(answer);
  } else if (!simplex) {
    flags_ |= kOvr;
  }
  ++done_;
  if (size() != 0 && done_ >= size()) {
    flags_ |= kEot;
    value(kCr1) &= ~kCstart;
  } else if ((value(kCr1) & kCsusp) != 0) {
    flags_ |= kSusp;
    value(kCr1) &= ~(kCstart | kCsusp);
  }
  begin();
  update();
}

std::uint32_t SpiV3::status() const {
  std::uint32_t sr = flags_;
  const bool ended = size() != 0 && done_ >= size();
  // The last frames of a transfer may be fewer than a packet: RXWNE and RXPLVL tell of them.
  if (receive_.size() >= threshold()) sr |= kRxp;
  if (awaits_more() && capacity() - transmit_.size() >= threshold()) sr |= kTxp;
  if ((sr & (kRxp | kTxp)) == (kRxp | kTxp)) sr |= kDxp;
  if (frame_end_ == kNever && transmit_.empty() && (size() == 0 || ended || !on())) sr |= kTxc;
  const std::size_t bytes = receive_.size() * frame_bytes();
  if (bytes >= 4) sr |= kRxwne;
  sr |= static_cast<std::uint32_t>(bytes % 4 / frame_bytes()) << 13;  // RXPLVL
  const std::uint32_t left = size() > done_ ? size() - done_ : 0;
  return sr | left << 16;  // CTSIZE
}

// Interrupts and requests by the flags; DMA last: it reads and writes the data registers at once.
void SpiV3::update() {
  const std::uint32_t cfg1 = value(kCfg1);
  irq_.set(on() && (status() & value(kIer) & (kFlags | kRxp | kTxp | kDxp)) != 0);
  context_.dma.set(dma_rx_, on() && bit(cfg1, 14) && !receive_.empty() &&
                                ((status() & kRxp) != 0 || (size() != 0 && done_ >= size())));
  context_.dma.set(dma_tx_, on() && bit(cfg1, 15) && (status() & kTxp) != 0);
}

std::uint32_t SpiV3::load(std::uint32_t offset) {
  if (offset == kSr) return status();
  if (offset != kRxdr) return value(offset);
  std::uint32_t data = 0;
  for (std::size_t at = 0; at < 4 && !receive_.empty(); at += frame_bytes()) {
    data |= receive_.front() << (8 * at);
    receive_.pop_front();
    if (at + frame_bytes() >= access_bytes_) break;
  }
  update();
  return data;
}

void SpiV3::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  switch (offset) {
    case kTxdr: {
      const std::size_t bytes = (lanes & 0xFFFF0000u) != 0 ? 4 : (lanes & 0xFF00u) != 0 ? 2 : 1;
      const std::uint32_t mask = 0xFFFFFFFFu >> (32 - 8 * frame_bytes());
      for (std::size_t at = 0; at < std::max(bytes, frame_bytes()); at += frame_bytes()) {
        if (!on() || !awaits_more() || transmit_.size() >= capacity()) break;
        transmit_.push_back(written >> (8 * at) & mask);
        if (++given_ == size() && size() != 0) flags_ |= kTxtf;
      }
      begin();
      break;
    }
    case kIfcr:
      flags_ &= ~written;
      if ((written & kEot) != 0 && size() != 0 && done_ >= size()) given_ = done_ = 0;  // the next transfer
      break;
    case kCr1: {
      const bool was = on();
      const std::uint32_t start = value(kCr1) & kCstart;
      keep(offset, written, lanes);
      value(kCr1) |= start;  // cleared by the end of the transfer alone
      if (was && !on()) stop();
      if (!was && on()) {
        given_ = done_ = 0;
        if ((value(kCfg2) & kMaster) == 0) system().report_unmodelled(name(), "switched on as a slave");
        context_.clocks.need(spec_.bus, name());
      }
      if ((value(kCr1) & kCsusp) != 0 && frame_end_ == kNever) {  // between two frames
        flags_ |= kSusp;
        value(kCr1) &= ~(kCstart | kCsusp);
      }
      begin();
      break;
    }
    case kCfg1:
    case kCfg2:
      if (on() && offset == kCfg2) break;  // protected
      keep(offset, written, lanes);
      break;
    default:
      keep(offset, written, lanes);
  }
  update();
}
}  // namespace

std::unique_ptr<Spi> make_spi_v3(const SpiSpec& spec, ChipContext& context) {
  return std::make_unique<SpiV3>(spec, context);
}

}  // namespace omnihil::mcu
