#include "firmware_iface/mcu/stm32/watchdog.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace omnihil::mcu {
namespace {
constexpr RegisterInfo kIwdg[] = {{0x00, "KR", 0, 0},
                                  {0x04, "PR", 0, 7},
                                  {0x08, "RLR", 0xFFF, 0xFFF},
                                  {0x0C, "SR", 0, 0},
                                  {0x10, "WINR", 0xFFF, 0xFFF}};
constexpr RegisterInfo kWwdg[] = {{0x00, "CR", 0x7F, 0xFF}, {0x04, "CFR", 0x7F, 0x3FFF}, {0x08, "SR", 0, 0}};

class Iwdg final : public RegisterBlock {
 public:
  explicit Iwdg(ChipContext& context) : RegisterBlock("IWDG", context.system, kIwdg), context_(context) {
    next_event_is(at_);
    context.clocks.listen(*this);
  }
  void reset() override {
    RegisterBlock::reset();
    deadline_ns_ = -1;
    updating_until_ns_.fill(-1);
    open_ = false;
    at_ = kNever;
  }
  Cycles stable_until(std::uint32_t offset) const override { return offset == 0x0C ? 0 : kNever; }
  void clock_changed() override {
    at_ = deadline_ns_ < 0 ? kNever : std::max(now(), system().from_ns(deadline_ns_));
  }
  void run_events() override {
    if (at_ > now()) return;
    at_ = kNever;
    system().request_reset("IWDG");
  }

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    if (offset != 0x0C) return value(offset);
    std::uint32_t flags = 0;
    for (std::size_t i = 0; i < updating_until_ns_.size(); ++i) {
      if (system().to_ns(now()) < updating_until_ns_[i]) flags |= 1u << i;
    }
    return flags;
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override {
    if (offset != 0) {
      if (!open_ || offset == 0x0C) return;
      const double before = divider();
      keep(offset, written, lanes);
      if (deadline_ns_ >= 0) update(offset, divider() / before);
      if (offset == 0x10 && open_ && deadline_ns_ >= 0) feed();
      return;
    }
    const std::uint32_t key = written & 0xFFFFu;
    if (key == 0xAAAA && deadline_ns_ >= 0) {
      const bool windowed = value(0x10) < value(0x08);
      if (windowed && deadline_ns_ - system().to_ns(now()) > counts_ns(value(0x10) + 1)) {
        return system().request_reset("IWDG");
      }
      feed();
    }
    if (key == 0xCCCC) feed();
    open_ = key == 0x5555;
  }

 private:
  double divider() const { return 4.0 * (1u << std::min(value(0x04) & 7u, 6u)); }
  std::int64_t counts_ns(std::uint32_t counts) const {
    return static_cast<std::int64_t>(std::llround(divider() * counts / context_.clocks.lsi_hz * 1e9));
  }
  // While it runs: what is left is counted on at the new prescaler, and SR says for five LSI periods that the register
  // is on its way (PVU, RVU, WVU).
  void update(std::uint32_t offset, double slower) {
    const std::int64_t now_ns = system().to_ns(now());
    updating_until_ns_[offset == 0x10 ? 2 : offset / 8] = now_ns + std::llround(5e9 / context_.clocks.lsi_hz);
    deadline_ns_ = now_ns + std::llround(static_cast<double>(deadline_ns_ - now_ns) * slower);
    clock_changed();
  }
  void feed() {
    deadline_ns_ = system().to_ns(now()) + counts_ns(value(0x08) + 1);
    clock_changed();
  }
  ChipContext& context_;
  std::int64_t deadline_ns_ = -1;                                 // below 0: not started
  std::array<std::int64_t, 3> updating_until_ns_ = {-1, -1, -1};  // PR, RLR, WINR
  bool open_ = false;
  Cycles at_ = kNever;
};

class Wwdg final : public RegisterBlock {
 public:
  Cycles stable_until(std::uint32_t offset) const override { return offset < 4 ? 0 : kNever; }
  Wwdg(int irq, unsigned at, unsigned bits, ChipContext& context, Bus bus)
      : RegisterBlock("WWDG", context.system, kWwdg),
        context_(context),
        bus_(bus),
        irq_(context.irqs, irq),
        tb_at_(at),
        tb_bits_(bits) {
    next_event_is(at_);
    context.clocks.listen(*this);
  }
  void reset() override {
    RegisterBlock::reset();
    on_ = false;
    at_ = kNever;
    irq_.set(false);
  }
  void clock_changed() override {
    if (!on_) return;
    const std::uint32_t count = counter();
    count_ = count;
    anchor_ = now();
    plan();
  }
  void run_events() override {
    if (at_ > now()) return;
    if (counter() < 0x40) return bite();
    value(0x08) |= 1;  // 0x40 reached: early wake-up
    irq_.set(bit(value(0x04), 9));
    plan();
  }

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    return offset == 0 && on_ ? 0x80u | counter() : value(offset);
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override {
    if (offset == 0x08) {
      value(0x08) &= written;
      irq_.set(bit(value(0x04), 9) && bit(value(0x08), 0));
      return;
    }
    if (offset == 0 && on_ && counter() > (value(0x04) & 0x7Fu)) return bite();
    keep(offset, written, lanes);
    if (offset != 0) {
      irq_.set(bit(value(0x04), 9) && bit(value(0x08), 0));
      return;
    }
    on_ = on_ || bit(value(0), 7);
    count_ = value(0) & 0x7Fu;
    anchor_ = now();
    if (on_ && count_ < 0x40) return bite();
    plan();
  }

 private:
  Cycles count_cycles() const {
    const ClockRatio clock = context_.clocks.bus(bus_);
    return (Cycles{4096} << field(value(0x04), tb_at_, tb_bits_)) * clock.div / clock.mul;
  }
  std::uint32_t counter() const {
    const Cycles gone = (now() - anchor_) / count_cycles();
    return gone >= count_ ? 0 : count_ - static_cast<std::uint32_t>(gone);
  }
  void plan() {
    if (!on_) return;
    const Cycles step = count_cycles();
    const Cycles wake = anchor_ + (count_ - 0x40) * step;
    at_ = wake > now() && count_ > 0x40 ? wake : anchor_ + (count_ - 0x3F) * step;
  }
  void bite() {
    at_ = kNever;
    on_ = false;
    system().request_reset("WWDG");
  }
  ChipContext& context_;
  Bus bus_;
  IrqLine irq_;
  unsigned tb_at_, tb_bits_;
  bool on_ = false;
  std::uint32_t count_ = 0x7F;
  Cycles anchor_ = 0, at_ = kNever;
};
}  // namespace

std::unique_ptr<RegisterBlock> make_iwdg(ChipContext& context) { return std::make_unique<Iwdg>(context); }
std::unique_ptr<RegisterBlock> make_wwdg(int irq, unsigned at, unsigned bits, ChipContext& context, Bus bus) {
  return std::make_unique<Wwdg>(irq, at, bits, context, bus);
}

}  // namespace omnihil::mcu
