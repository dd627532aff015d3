// SPI0 and SPI1 of the RP2040 (datasheet §4.4, ARM DDI 0194G): FIFOs of 8, frames of 4 to 16 bits at clk_peri / (CPSDVSR
// (SCR + 1)). Not there: slave, loop-back, the frame formats of TI and National.
#include <algorithm>
#include <deque>
#include <string>

#include "firmware_iface/mcu/rp2040/buses.h"

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint16_t {
  kCr0 = 0x00,
  kCr1 = 0x04,
  kDr = 0x08,
  kSr = 0x0C,
  kCpsr = 0x10,
  kImsc = 0x14,
  kRis = 0x18,
  kMis = 0x1C,
  kIcr = 0x20,
  kDmacr = 0x24
};
constexpr RegisterInfo kRegisters[] = {{kCr0, "SSPCR0", 0, 0xFFFF, 0x0030},
                                       {kCr1, "SSPCR1", 0, 0x000F, 0x000D},
                                       {kDr, "SSPDR", 0, 0},
                                       {kSr, "SSPSR", 3, 0},
                                       {kCpsr, "SSPCPSR", 0, 0xFF},
                                       {kImsc, "SSPIMSC", 0, 0xF},
                                       {kRis, "SSPRIS", 8, 0},
                                       {kMis, "SSPMIS", 0, 0},
                                       {kIcr, "SSPICR", 0, 0},
                                       {kDmacr, "SSPDMACR", 0, 3},
                                       {0xFE0, "SSPPERIPHID0", 0x22, 0},
                                       {0xFE4, "SSPPERIPHID1", 0x10, 0},
                                       {0xFE8, "SSPPERIPHID2", 0x34, 0},
                                       {0xFEC, "SSPPERIPHID3", 0, 0},
                                       {0xFF0, "SSPPCELLID0", 0x0D, 0},
                                       {0xFF4, "SSPPCELLID1", 0xF0, 0},
                                       {0xFF8, "SSPPCELLID2", 0x05, 0},
                                       {0xFFC, "SSPPCELLID3", 0xB1, 0}};
constexpr std::size_t kDepth = 8;
constexpr std::uint32_t kOverrun = 1, kTimeout = 2, kRx = 4, kTx = 8;

class SpiPl022 final : public Atomic<Spi> {
 public:
  SpiPl022(const SpiSpec& spec, ChipContext& context) : Atomic<Spi>(spec, kRegisters, context) {
    next_event_is(end_);
  }
  void reset() override {
    RegisterBlock::reset();
    transmit_.clear();
    receive_.clear();
    latched_ = 0;
    end_ = kNever;
    update();
  }
  void run_events() override {
    if (end_ > now()) return;
    const std::uint32_t in = exchange(shifting_, bits());
    passed({shifting_, in, bits(), end_ - frame_cycles(), end_, bit(value(kCr0), 6), bit(value(kCr0), 7)});
    if (receive_.size() < kDepth)
      receive_.push_back(in);
    else
      latched_ |= kOverrun;
    end_ = kNever;
    begin();
    if (end_ == kNever && !receive_.empty()) latched_ |= kTimeout;  // 32 bit times later on the chip
    update();
  }
  Cycles stable_until(std::uint32_t offset) const override { return (offset & 0xFFCu) == kDr ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    const std::uint32_t is = shown(offset);
    if (offset == kDr && !receive_.empty()) {
      receive_.pop_front();
      if (receive_.empty()) latched_ &= ~kTimeout;
      update();
    }
    return is;
  }
  std::uint32_t shown(std::uint32_t offset) override {
    switch (offset) {
      case kDr:
        return receive_.empty() ? 0u : receive_.front();
      case kSr:
        return (transmit_.empty() ? 1u : 0u) | (transmit_.size() < kDepth ? 2u : 0u) |
               (receive_.empty() ? 0u : 4u) | (receive_.size() >= kDepth ? 8u : 0u) |
               (end_ != kNever || !transmit_.empty() ? 16u : 0u);
      case kRis:
        return raw();
      case kMis:
        return raw() & value(kImsc);
      default:
        return value(offset);
    }
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override {
    if (offset == kDr) {
      if (transmit_.size() < kDepth) transmit_.push_back(written & ((1u << bits()) - 1u));
    } else if (offset == kIcr) {
      latched_ &= ~(written & 3u);
    } else {
      keep(offset, written, lanes);
      if (offset == kCr1 && bit(written, 1)) context_.clocks.need(Bus::kPeripheral, name());
    }
    begin();
    update();
  }

 private:
  unsigned bits() const { return std::max(field(value(kCr0), 0, 4), 3u) + 1; }
  Cycles frame_cycles() const {
    const ClockRatio clock = context_.clocks.bus(Bus::kPeripheral);
    const Cycles divider = Cycles{std::max(value(kCpsr) & 0xFEu, 2u)} * (field(value(kCr0), 8, 8) + 1);
    return std::max<Cycles>(1, bits() * divider * clock.div / clock.mul);
  }
  void begin() {
    if (end_ != kNever || transmit_.empty() || !bit(value(kCr1), 1)) return;
    shifting_ = transmit_.front();
    transmit_.pop_front();
    end_ = now() + frame_cycles();
  }
  std::uint32_t raw() const {
    return latched_ | (receive_.size() >= kDepth / 2 ? kRx : 0u) |
           (transmit_.size() <= kDepth / 2 ? kTx : 0u);
  }
  void update() {
    irq_.set((raw() & value(kImsc)) != 0);
    context_.dma.set(dma_rx_, !receive_.empty() && bit(value(kDmacr), 0));
    context_.dma.set(dma_tx_, transmit_.size() < kDepth && bit(value(kDmacr), 1));
  }

  std::deque<std::uint32_t> transmit_, receive_;
  std::uint32_t shifting_ = 0, latched_ = 0;
  Cycles end_ = kNever;
};
}  // namespace

std::unique_ptr<Atomic<Spi>> make_spi_pl022(unsigned number, int irq, ChipContext& context) {
  return std::make_unique<SpiPl022>(SpiSpec{.name = "SPI" + std::to_string(number), .irq = irq}, context);
}

}  // namespace omnihil::mcu::rp2040
