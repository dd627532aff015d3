#include <algorithm>

#include "firmware_iface/mcu/stm32/i2c.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCr1 = 0x00, kCr2 = 0x04, kDr = 0x10, kSr1 = 0x14, kSr2 = 0x18, kCcr = 0x1C };
constexpr RegisterInfo kRegisters[] = {{kCr1, "CR1", 0, 0xBFFB, 0x30F2},
                                       {kCr2, "CR2", 0, 0x1F3F},
                                       {0x08, "OAR1", 0, 0xC3FF},
                                       {0x0C, "OAR2", 0, 0xFF},
                                       {kDr, "DR", 0, 0},
                                       {kSr1, "SR1", 0, 0},
                                       {kSr2, "SR2", 0, 0},
                                       {kCcr, "CCR", 0, 0xCFFF},
                                       {0x20, "TRISE", 2, 0x3F},
                                       {0x24, "FLTR", 0, 0x1F}};
constexpr std::uint32_t kPe = 1, kStart = 1u << 8, kStop = 1u << 9, kAck = 1u << 10, kSwrst = 1u << 15;
constexpr std::uint32_t kSb = 1, kAddr = 2, kBtf = 4, kRxne = 1u << 6, kTxe = 1u << 7, kAf = 1u << 10;
constexpr std::uint32_t kErrors = 0xDF00;
constexpr std::uint32_t kMsl = 1, kBusy = 2, kTra = 4;

class I2cV1 final : public I2c {
 public:
  I2cV1(const I2cSpec& spec, ChipContext& context) : I2c(spec, kRegisters, context) { next_event_is(at_); }

  void reset() override {
    RegisterBlock::reset();
    idle();
    update();
  }
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override {
    return (offset & ~3u) == kDr || (offset & ~3u) == kSr2 ? 0 : kNever;
  }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override { return offset == kDr ? data_ : value(offset); }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  enum class Doing : std::uint8_t { kNothing, kStarting, kAddressing, kSending, kReceiving };
  Cycles bit_cycles() const {
    const std::uint32_t ccr = value(kCcr);
    const unsigned halves = !bit(ccr, 15) ? 2 : bit(ccr, 14) ? 25 : 3;
    const ClockRatio clock = context_.clocks.bus(spec_.bus);
    return std::max<Cycles>(4, Cycles{std::max(1u, ccr & 0xFFFu)} * halves * clock.div / clock.mul);
  }
  void after_bits(Doing doing, unsigned bits) {
    doing_ = doing;
    at_ = now() + bit_cycles() * bits;
  }
  void idle() {
    doing_ = Doing::kNothing;
    at_ = kNever;
    device_ = nullptr;
    shifted_full_ = last_ = nack_next_ = false;
  }
  void stop() {
    value(kCr1) &= ~kStop;
    value(kSr1) &= ~kBtf;
    value(kSr2) = 0;
    const bool kept = shifted_full_;
    idle();
    shifted_full_ = kept;  // a byte received before the stop can still be read
  }
  void send(std::uint32_t byte);
  void received(std::uint8_t byte);
  void receive_more();
  std::uint32_t read_data();
  void update();

  Doing doing_ = Doing::kNothing;
  Cycles at_ = kNever;
  I2cDevice* device_ = nullptr;
  std::uint8_t shifting_ = 0, data_ = 0, shifted_ = 0;
  bool shifted_full_ = false, data_full_ = false, last_ = false, nack_next_ = false, sr1_read_ = false;
};

void I2cV1::update() {
  const std::uint32_t sr1 = value(kSr1), cr2 = value(kCr2);
  const bool buffers = bit(cr2, 10) && (sr1 & (kRxne | kTxe)) != 0;
  irq_event_.set(bit(cr2, 9) && ((sr1 & (kSb | kAddr | kBtf)) != 0 || buffers));
  irq_error_.set(bit(cr2, 8) && (sr1 & kErrors) != 0);
  context_.dma.set(dma_rx_, bit(cr2, 11) && (sr1 & kRxne) != 0);
  context_.dma.set(dma_tx_, bit(cr2, 11) && (value(kSr1) & kTxe) != 0);
}

void I2cV1::run_events() {
  if (at_ > now()) return;
  const Doing done = doing_;
  doing_ = Doing::kNothing;
  at_ = kNever;
  std::uint32_t& sr1 = value(kSr1);
  switch (done) {
    case Doing::kNothing:
      break;
    case Doing::kStarting:
      value(kCr1) &= ~kStart;
      sr1 = (sr1 & kErrors) | kSb;
      value(kSr2) = kMsl | kBusy;
      break;
    case Doing::kAddressing:
      device_ = find(shifting_ >> 1);
      if (device_ == nullptr) {
        sr1 |= kAf;
        break;
      }
      device_->start((shifting_ & 1) != 0);
      sr1 |= kAddr;
      if ((shifting_ & 1) == 0) value(kSr2) |= kTra;
      break;
    case Doing::kSending:
      if (device_ == nullptr || !device_->write(shifting_)) {
        sr1 |= kAf;
      } else if (data_full_) {
        data_full_ = false;
        shifting_ = data_;
        after_bits(Doing::kSending, 9);
        sr1 |= kTxe;
      } else {
        sr1 |= kBtf | kTxe;
      }
      if (doing_ == Doing::kNothing && (value(kCr1) & kStop) != 0) stop();
      break;
    case Doing::kReceiving:
      received(device_ != nullptr ? device_->read() : 0xFF);
      break;
  }
  if (doing_ == Doing::kNothing && (value(kCr1) & kStart) != 0) after_bits(Doing::kStarting, 1);
  update();
}

void I2cV1::received(std::uint8_t byte) {
  // ACK speaks of this byte, or with POS of the next.
  const bool nack = bit(value(kCr1), 11) ? nack_next_ : (value(kCr1) & kAck) == 0;
  nack_next_ = (value(kCr1) & kAck) == 0;
  last_ = nack;
  if ((value(kSr1) & kRxne) == 0) {
    data_ = byte;
    value(kSr1) |= kRxne;
  } else {
    shifted_ = byte;
    shifted_full_ = true;
    value(kSr1) |= kBtf;
  }
  if ((value(kCr1) & kStop) != 0) {
    stop();
  } else {
    receive_more();
  }
}

void I2cV1::receive_more() {
  if (device_ != nullptr && doing_ == Doing::kNothing && !last_ && !shifted_full_)
    after_bits(Doing::kReceiving, 9);
}

std::uint32_t I2cV1::read_data() {
  const std::uint32_t byte = data_;
  value(kSr1) &= ~(kRxne | kBtf);
  if (shifted_full_) {
    data_ = shifted_;
    shifted_full_ = false;
    value(kSr1) |= kRxne;
  }
  if (value(kSr2) != 0 && (value(kSr2) & kTra) == 0) receive_more();
  update();
  return byte;
}

std::uint32_t I2cV1::load(std::uint32_t offset) {
  if (offset == kSr1) sr1_read_ = true;
  if (offset == kDr) return read_data();
  if (offset != kSr2) return value(offset);
  const std::uint32_t sr2 = value(kSr2);
  if (sr1_read_ && (value(kSr1) & kAddr) != 0) {  // SR1, then SR2: the address phase is over
    value(kSr1) &= ~kAddr;
    if ((sr2 & kTra) != 0) {
      value(kSr1) |= kTxe;
    } else {
      nack_next_ = false;
      last_ = false;
      receive_more();
    }
    update();
  }
  sr1_read_ = false;
  return sr2;
}

void I2cV1::send(std::uint32_t byte) {
  std::uint32_t& sr1 = value(kSr1);
  if ((sr1 & kSb) != 0) {
    sr1 &= ~kSb;
    shifting_ = static_cast<std::uint8_t>(byte);
    after_bits(Doing::kAddressing, 9);
  } else if ((value(kSr2) & kTra) != 0 && (sr1 & kAddr) == 0) {
    sr1 &= ~kBtf;
    if (doing_ == Doing::kSending) {
      data_ = static_cast<std::uint8_t>(byte);
      data_full_ = true;
      sr1 &= ~kTxe;
    } else {
      shifting_ = static_cast<std::uint8_t>(byte);
      after_bits(Doing::kSending, 9);
      sr1 |= kTxe;
    }
  }
}

void I2cV1::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kDr) {
    send(written & 0xFFu);
  } else if (offset == kSr1) {
    value(kSr1) &= written | ~lanes | ~kErrors;
  } else if (offset == kCr1) {
    keep(offset, written, lanes);
    std::uint32_t& cr1 = value(kCr1);
    if ((cr1 & kSwrst) != 0 || (cr1 & kPe) == 0) {
      idle();
      data_full_ = false;
      value(kSr1) = value(kSr2) = 0;
      cr1 &= ~(kStart | kStop);
    } else {
      if ((cr1 & kStop) != 0 && (doing_ == Doing::kNothing || doing_ == Doing::kStarting)) stop();
      if ((cr1 & kStart) != 0 && doing_ == Doing::kNothing) after_bits(Doing::kStarting, 1);
    }
  } else {
    keep(offset, written, lanes);
  }
  update();
}
}  // namespace

std::unique_ptr<I2c> make_i2c_v1(const I2cSpec& spec, ChipContext& context) {
  return std::make_unique<I2cV1>(spec, context);
}
std::unique_ptr<I2c> make_i2c(const I2cSpec& spec, ChipContext& context) {
  return spec.v2 ? make_i2c_v2(spec, context) : make_i2c_v1(spec, context);
}

}  // namespace omnihil::mcu
