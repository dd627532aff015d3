#include "firmware_iface/mcu/stm32/spi.h"

#include <deque>
#include <utility>

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCr1 = 0x00, kCr2 = 0x04, kSr = 0x08, kDr = 0x0C };
constexpr RegisterInfo kFirst[] = {{kCr1, "CR1", 0, 0xFFFF, 0x3080}};
constexpr RegisterInfo kCr2OfV1[] = {{kCr2, "CR2", 0, 0xF7, 0x10}};
constexpr RegisterInfo kCr2OfV2[] = {{kCr2, "CR2", 0x700, 0x7FFF, 0x6018}};
constexpr RegisterInfo kRest[] = {{kSr, "SR", 2, 0},          {kDr, "DR", 0, 0},
                                  {0x10, "CRCPR", 7, 0xFFFF}, {0x14, "RXCRCR", 0, 0},
                                  {0x18, "TXCRCR", 0, 0},     {0x1C, "I2SCFGR", 0, 0xFFF, 0x400},
                                  {0x20, "I2SPR", 2, 0x3FF}};
constexpr auto kV1 = joined(kFirst, kCr2OfV1, kRest);
constexpr auto kV2 = joined(kFirst, kCr2OfV2, kRest);
constexpr std::uint32_t kRxne = 1, kTxe = 2, kOvr = 1u << 6, kBsy = 1u << 7;
constexpr std::uint32_t kSpe = 1u << 6;  // CR1
class SpiClassic final : public Spi {
 public:
  SpiClassic(const SpiSpec& spec, ChipContext& context);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == kDr ? 0 : kNever; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  unsigned frame_bits() const;
  bool wide() const { return frame_bits() > 8; }
  std::size_t capacity() const { return spec_.v2 ? (wide() ? 2 : 4) : 1; }
  std::size_t ready_at() const { return spec_.v2 && !wide() && !bit(value(kCr2), 12) ? 2 : 1; }
  Cycles frame_cycles() const;
  void push(std::uint32_t frame);
  void begin();
  std::uint32_t status() const;
  void update();

  std::deque<std::uint32_t> transmit_, receive_;
  std::uint32_t shifting_ = 0;
  bool overrun_ = false;
  Cycles frame_end_ = kNever;
};

SpiClassic::SpiClassic(const SpiSpec& spec, ChipContext& context)
    : Spi(spec, spec.v2 ? std::span<const RegisterInfo>(kV2) : std::span<const RegisterInfo>(kV1), context) {
  next_event_is(frame_end_);
}

void SpiClassic::reset() {
  RegisterBlock::reset();
  transmit_.clear();
  receive_.clear();
  overrun_ = false;
  frame_end_ = kNever;
  update();
}

unsigned SpiClassic::frame_bits() const {
  if (!spec_.v2) return bit(value(kCr1), 11) ? 16 : 8;  // DFF
  return std::max(field(value(kCr2), 8, 4), 3u) + 1;    // DS
}

Cycles SpiClassic::frame_cycles() const {
  const ClockRatio clock = context_.clocks.bus(spec_.bus);
  return Cycles{frame_bits()} * (2u << field(value(kCr1), 3, 3)) * clock.div / clock.mul;
}

void SpiClassic::push(std::uint32_t frame) {
  if (transmit_.size() >= capacity()) return;
  transmit_.push_back(frame);
  if (frame_end_ == kNever) begin();
}

void SpiClassic::begin() {
  if (transmit_.empty() || (value(kCr1) & kSpe) == 0) return;
  shifting_ = transmit_.front();
  transmit_.pop_front();
  frame_end_ = now() + frame_cycles();
}

void SpiClassic::run_events() {
  if (frame_end_ > now()) return;
  const Cycles end = std::exchange(frame_end_, kNever);
  const std::uint32_t answer = exchange(shifting_, frame_bits()), cr1 = value(kCr1);
  passed({shifting_, answer, frame_bits(), end - frame_cycles(), end, bit(cr1, 1), bit(cr1, 0)});
  if (receive_.size() < capacity()) {
    receive_.push_back(answer);
  } else {
    overrun_ = true;
  }
  begin();
  update();
}

std::uint32_t SpiClassic::status() const {
  std::uint32_t sr = 0;
  if (receive_.size() >= ready_at()) sr |= kRxne;
  if (spec_.v2 ? transmit_.size() * 2 <= capacity() : transmit_.empty()) sr |= kTxe;
  if (overrun_) sr |= kOvr;
  if (frame_end_ != kNever) sr |= kBsy;
  if (!spec_.v2) return sr;
  const auto level = [this](std::size_t n) {
    return static_cast<std::uint32_t>(std::min<std::size_t>(wide() ? 2 * n : n, 3));
  };
  return sr | level(receive_.size()) << 9 | level(transmit_.size()) << 11;
}

void SpiClassic::update() {
  const std::uint32_t sr = status(), cr2 = value(kCr2);
  irq_.set(((sr & kRxne) != 0 && bit(cr2, 6)) || ((sr & kTxe) != 0 && bit(cr2, 7)) ||
           (overrun_ && bit(cr2, 5)));
  context_.dma.set(dma_rx_, (sr & kRxne) != 0 && bit(cr2, 0));
  context_.dma.set(dma_tx_, (status() & kTxe) != 0 && bit(cr2, 1) && (value(kCr1) & kSpe) != 0);
}

std::uint32_t SpiClassic::load(std::uint32_t offset) {
  if (offset == kSr) return status();
  if (offset != kDr) return value(offset);
  std::uint32_t data = 0;
  if (!receive_.empty()) {
    data = receive_.front();
    receive_.pop_front();
    if (spec_.v2 && !wide() && !bit(value(kCr2), 12) && !receive_.empty()) {  // a pair by one access
      data |= receive_.front() << 8;
      receive_.pop_front();
    }
  }
  overrun_ = false;
  update();
  return data;
}

std::uint32_t SpiClassic::shown(std::uint32_t offset) {
  if (offset != kDr) return load(offset);
  return receive_.empty() ? 0 : receive_.front();
}

void SpiClassic::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kDr) {
    if (wide()) {
      push(written & 0xFFFFu);
    } else {
      push(written & 0xFFu);
      if (spec_.v2 && (lanes & 0xFF00u) != 0) push(written >> 8 & 0xFFu);  // packed
    }
  } else if (offset == kSr) {
    return;
  } else {
    keep(offset, written, lanes);
    if (offset == kCr1 && frame_end_ == kNever) begin();
  }
  update();
}

}  // namespace

Spi::Spi(SpiSpec spec, std::span<const RegisterInfo> registers, ChipContext& context)
    : RegisterBlock(spec.name, context.system, registers),
      spec_(std::move(spec)),
      context_(context),
      irq_(context.irqs, spec_.irq),
      dma_rx_(context.dma.line(spec_.name + "_RX")),
      dma_tx_(context.dma.line(spec_.name + "_TX")) {}

void Spi::select(SpiDevice& device, bool selected) {
  for (Slave& slave : devices_) {
    if (slave.device != &device || slave.selected == selected) continue;
    slave.selected = selected;
    device.select(selected);
  }
}

std::uint32_t Spi::exchange(std::uint32_t out, unsigned bits) {
  const unsigned bytes = (bits + 7) / 8;
  std::uint32_t in = 0xFFFFFFFFu >> (32 - 8 * bytes);
  bool heard = false;
  for (const Slave& slave : devices_) {
    if (!slave.selected) continue;
    heard = true;
    std::uint32_t answer = 0;
    for (unsigned i = bytes; i-- > 0;)
      answer = answer << 8 | slave.device->exchange(static_cast<std::uint8_t>(out >> (8 * i)));
    in &= answer;
  }
  if (!heard) ledger_.lost("byte", "sent with no device selected", now(), bytes);
  return in;
}

std::unique_ptr<Spi> make_spi(const SpiSpec& spec, ChipContext& context) {
  if (spec.fifo_bytes > 0) return make_spi_v3(spec, context);
  return std::make_unique<SpiClassic>(spec, context);
}

}  // namespace omnihil::mcu
