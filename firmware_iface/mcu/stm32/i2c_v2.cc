#include <algorithm>
#include <cmath>

#include "firmware_iface/mcu/stm32/i2c.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr1 = 0x00,
  kCr2 = 0x04,
  kTimingr = 0x10,
  kIsr = 0x18,
  kIcr = 0x1C,
  kRxdr = 0x24,
  kTxdr = 0x28
};
constexpr RegisterInfo kRegisters[] = {{kCr1, "CR1", 0, 0x00FFDFFF, 0x00FB0008},
                                       {kCr2, "CR2", 0, 0x07FFFFFF, 0x04001800},
                                       {0x08, "OAR1", 0, 0x87FF, 0x8000},
                                       {0x0C, "OAR2", 0, 0x87FE, 0x8000},
                                       {kTimingr, "TIMINGR"},
                                       {0x14, "TIMEOUTR", 0, 0xFFFFFFFF, 0x80008000},
                                       {kIsr, "ISR", 1, 0},
                                       {kIcr, "ICR", 0, 0},
                                       {0x20, "PECR", 0, 0},
                                       {kRxdr, "RXDR", 0, 0},
                                       {kTxdr, "TXDR", 0, 0}};
constexpr std::uint32_t kTxe = 1, kTxis = 2, kRxne = 4, kNackf = 16, kStopf = 32, kTc = 64, kTcr = 128,
                        kBusy = 1u << 15;
constexpr std::uint32_t kStart = 1u << 13, kStop = 1u << 14, kReload = 1u << 24, kAutoend = 1u << 25;

class I2cV2 final : public I2c {
 public:
  I2cV2(const I2cSpec& spec, ChipContext& context) : I2c(spec, kRegisters, context) { next_event_is(at_); }
  void reset() override {
    RegisterBlock::reset();
    doing_ = Doing::kNothing;
    at_ = kNever;
    update();
  }
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == kRxdr ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override { return value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  enum class Doing : std::uint8_t { kNothing, kAddressing, kSending, kReceiving };
  bool reading() const { return bit(value(kCr2), 10); }
  void after_bits(Doing doing, unsigned bits) {
    const std::uint32_t t = value(kTimingr);
    const double clocks = (field(t, 28, 4) + 1.0) * (field(t, 0, 8) + field(t, 8, 8) + 2.0) * bits;
    const double hz = spec_.from_hsi ? context_.clocks.hsi_hz : context_.clocks.bus_hz(spec_.bus);
    doing_ = doing;
    at_ = now() + std::max<Cycles>(4, static_cast<Cycles>(std::llround(clocks * system().core_hz() / hz)));
  }
  void stop() {
    std::uint32_t& isr = value(kIsr);
    isr = (isr & ~(kBusy | kTxis | kTc | kTcr)) | kStopf | kTxe;
    value(kCr2) &= ~(kStart | kStop);
    doing_ = Doing::kNothing;
    at_ = kNever;
    device_ = nullptr;
  }
  void next_byte();
  void nack() {
    value(kIsr) |= kNackf;
    stop();
  }
  void control();
  void update();

  Doing doing_ = Doing::kNothing;
  Cycles at_ = kNever;
  I2cDevice* device_ = nullptr;
  unsigned left_ = 0;
  std::uint8_t shifting_ = 0;
};

void I2cV2::update() {
  const std::uint32_t isr = value(kIsr), cr1 = value(kCr1);
  irq_event_.set(((isr & kTxis) != 0 && bit(cr1, 1)) || ((isr & kRxne) != 0 && bit(cr1, 2)) ||
                 ((isr & kNackf) != 0 && bit(cr1, 4)) || ((isr & kStopf) != 0 && bit(cr1, 5)) ||
                 ((isr & (kTc | kTcr)) != 0 && bit(cr1, 6)));
  context_.dma.set(dma_rx_, bit(cr1, 15) && (isr & kRxne) != 0);
  context_.dma.set(dma_tx_, bit(cr1, 14) && (value(kIsr) & kTxis) != 0);
}

// After an address or a byte: the next one, or what the end of NBYTES asks for.
void I2cV2::next_byte() {
  std::uint32_t& isr = value(kIsr);
  const std::uint32_t cr2 = value(kCr2);
  doing_ = Doing::kNothing;
  at_ = kNever;
  if (left_ == 0) {
    if ((cr2 & kReload) != 0) {
      isr |= kTcr;
    } else if ((cr2 & (kAutoend | kStop)) != 0) {
      stop();
    } else {
      isr |= kTc;
    }
  } else if (reading()) {
    if ((isr & kRxne) == 0) after_bits(Doing::kReceiving, 9);  // else the clock waits for RXDR to be read
  } else {
    isr |= kTxis | kTxe;
  }
}

void I2cV2::run_events() {
  if (at_ > now()) return;
  const Doing done = doing_;
  doing_ = Doing::kNothing;
  at_ = kNever;
  switch (done) {
    case Doing::kNothing:
      break;
    case Doing::kAddressing:
      value(kCr2) &= ~kStart;
      device_ = find(field(value(kCr2), 1, 7));
      if (device_ == nullptr) {
        nack();
        break;
      }
      device_->start(reading());
      next_byte();
      break;
    case Doing::kSending:
      --left_;
      if (device_ == nullptr || !device_->write(shifting_)) {
        nack();
      } else {
        next_byte();
      }
      break;
    case Doing::kReceiving:
      --left_;
      shifting_ = device_ != nullptr ? device_->read() : 0xFF;
      value(kRxdr) = shifting_;
      value(kIsr) |= kRxne;
      next_byte();
      break;
  }
  update();
}

std::uint32_t I2cV2::load(std::uint32_t offset) {
  if (offset == kRxdr && (value(kIsr) & kRxne) != 0) {
    value(kIsr) &= ~kRxne;
    const std::uint32_t byte = value(kRxdr);
    if (device_ != nullptr && doing_ == Doing::kNothing && left_ > 0) after_bits(Doing::kReceiving, 9);
    update();
    return byte;
  }
  return value(offset);
}

void I2cV2::control() {
  const std::uint32_t cr2 = value(kCr2);
  std::uint32_t& isr = value(kIsr);
  const unsigned bytes = field(cr2, 16, 8);
  if ((cr2 & kStart) != 0 && doing_ != Doing::kAddressing) {
    isr = (isr & ~(kTc | kTcr | kTxis)) | kBusy;
    left_ = bytes;
    return after_bits(Doing::kAddressing, 10);
  }
  if ((isr & kTcr) != 0 && bytes != 0) {  // NBYTES reloaded
    isr &= ~kTcr;
    left_ = bytes;
    next_byte();
  }
  if ((cr2 & kStop) != 0 && doing_ == Doing::kNothing && (isr & kBusy) != 0) stop();
}

void I2cV2::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  switch (offset) {
    case kIcr:
      value(kIsr) &= ~(written & 0x3F38u);
      break;
    case kIsr:
      if ((written & 1u) != 0) value(kIsr) = (value(kIsr) & ~kTxis) | kTxe;  // flush
      break;
    case kTxdr:
      value(kIsr) &= ~kTxis;
      if (device_ == nullptr || reading() || doing_ != Doing::kNothing || left_ == 0) break;
      shifting_ = static_cast<std::uint8_t>(written);
      value(kIsr) &= ~kTxe;
      after_bits(Doing::kSending, 9);
      break;
    case kCr1:
      keep(offset, written, lanes);
      if (!bit(value(kCr1), 0)) {  // off: the state machine and its flags are reset
        value(kIsr) = kTxe;
        value(kCr2) &= ~(kStart | kStop);
        doing_ = Doing::kNothing;
        at_ = kNever;
        device_ = nullptr;
      }
      break;
    case kCr2:
      keep(offset, written, lanes);
      if (bit(value(kCr1), 0)) control();
      break;
    default:
      keep(offset, written, lanes);
      break;
  }
  update();
}
}  // namespace

std::unique_ptr<I2c> make_i2c_v2(const I2cSpec& spec, ChipContext& context) {
  return std::make_unique<I2cV2>(spec, context);
}

}  // namespace omnihil::mcu
