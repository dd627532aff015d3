// ADC of the RP2040 (datasheet §4.9): one at a time or one after the other, round robin, FIFO with its interrupt and DMA
// request. A conversion is 96 clocks; it samples in the first two of them (a guess). With DIV above 95 the next one begins
// DIV + 1 clocks after the one before, and its result comes then, later than on the chip. Errors of a conversion and the
// noise of the real one are not there; the temperature sensor says 27 degC.
#include "firmware_iface/mcu/rp2040/adc.h"

#include <algorithm>
#include <array>
#include <deque>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint16_t {
  kCs = 0x00,
  kResult = 0x04,
  kFcs = 0x08,
  kFifo = 0x0C,
  kDiv = 0x10,
  kIntr = 0x14,
  kInte = 0x18,
  kIntf = 0x1C,
  kInts = 0x20
};
constexpr RegisterInfo kRegisters[] = {
    {kCs, "CS", 0, 0x001F700B}, {kResult, "RESULT", 0, 0},  {kFcs, "FCS", 0, 0x0F00000F},
    {kFifo, "FIFO", 0, 0},      {kDiv, "DIV", 0, 0xFFFFFF}, {kIntr, "INTR", 0, 0},
    {kInte, "INTE", 0, 1},      {kIntf, "INTF", 0, 1},      {kInts, "INTS", 0, 0}};
constexpr int kIrq = 22;
constexpr unsigned kMany = 3, kOnce = 2;
constexpr std::size_t kDepth = 4;
constexpr std::uint32_t kOver = 1u << 11, kUnder = 1u << 10;
constexpr double kSampling = 2.0, kConversion = 96.0;
constexpr unsigned kTemperature = 4;
constexpr double kAt27DegC_V = 0.706;

class RpAdc final : public Atomic<Adc> {
 public:
  explicit RpAdc(ChipContext& context)
      : Atomic<Adc>("ADC", kRegisters, AdcTriggers{}, context),
        irq_(context.irqs, kIrq),
        dma_(context.dma.line("ADC")) {
    set_voltage(kTemperature, kAt27DegC_V);
  }
  void reset() override {
    Adc::reset();
    fifo_.clear();
    result_ = input_ = errors_ = 0;
    settle();
    update();
  }
  Cycles stable_until(std::uint32_t offset) const override { return (offset & 0xFFCu) == kFifo ? 0 : kNever; }

 protected:
  unsigned length(Group group) const override { return group == Group::kRegular ? inputs_ : 0; }
  unsigned channel(Group, unsigned place) const override { return sequence_[place % inputs_]; }
  double sample_clocks(unsigned) const override { return kSampling; }
  double convert_clocks() const override {
    const double pace = bit(value(kCs), kMany) ? value(kDiv) / 256.0 + 1.0 : 0.0;
    return std::max(kConversion, pace) - kSampling;
  }
  double clock_hz() const override { return context().clocks.bus_hz(Bus::kAdc); }
  unsigned bits() const override { return 12; }
  bool left_aligned() const override { return false; }
  bool continues() const override { return bit(value(kCs), kMany) && enabled(); }
  bool one_per_trigger() const override { return !bit(value(kCs), kMany); }
  bool injected_follow() const override { return false; }
  std::pair<int, unsigned> trigger(Group) const override { return {-1, 0}; }
  bool armed(Group) const override { return false; }
  bool enabled() const override { return bit(value(kCs), 0); }

  void result(Group, unsigned place, std::uint32_t code, bool) override {
    result_ = code;
    input_ = sequence_[(place + 1) % inputs_];
    if (outside_) leave_outside();
    if (bit(value(kFcs), 0)) {
      if (fifo_.size() >= kDepth)
        errors_ |= kOver;
      else
        fifo_.push_back(bit(value(kFcs), 1) ? code >> 4 : code);
    }
    update();
  }
  std::uint32_t load(std::uint32_t offset) override {
    const std::uint32_t is = shown(offset);
    if (offset == kFifo) {
      if (fifo_.empty())
        errors_ |= kUnder;
      else
        fifo_.pop_front();
      update();
    }
    return is;
  }
  std::uint32_t shown(std::uint32_t offset) override {
    constexpr std::uint32_t kReady = 1u << 8;
    switch (offset) {
      case kCs:
        return (value(kCs) & ~0x7000u) | input_ << 12 | (enabled() && !busy(Group::kRegular) ? kReady : 0u);
      case kResult:
        return result_;
      case kFcs:
        return value(kFcs) | static_cast<std::uint32_t>(fifo_.size()) << 16 | errors_ |
               (fifo_.size() >= kDepth ? 1u << 9 : 0u) | (fifo_.empty() ? 1u << 8 : 0u);
      case kFifo:
        return fifo_.empty() ? 0u : fifo_.front();
      case kIntr:
        return reached() ? 1u : 0u;
      case kInts:
        return (reached() && bit(value(kInte), 0)) || bit(value(kIntf), 0) ? 1u : 0u;
      default:
        return value(offset);
    }
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override {
    if (offset == kCs) {
      registers_change();
      const std::uint32_t robin = field(value(kCs), 16, 5),
                          input = std::min(field(written, 12, 3), kTemperature);
      keep(offset, written, lanes);
      if (!enabled() || input != input_ || robin != field(value(kCs), 16, 5)) {
        stop(Group::kRegular);
        input_ = input;
        settle();
      }
      if (enabled()) context().clocks.need(Bus::kAdc, name());
      if (enabled() && (bit(written, kOnce) || bit(written, kMany))) start(Group::kRegular);
    } else {
      if (offset == kFcs) errors_ &= ~written;
      if (offset == kDiv) registers_change();
      keep(offset, written, lanes);
    }
    update();
  }

 private:
  bool reached() const { return fifo_.size() >= std::max<std::size_t>(1, field(value(kFcs), 24, 4)); }
  void update() {
    irq_.set((shown(kInts) & 1u) != 0);
    context().dma.set(dma_, bit(value(kFcs), 3) && reached());
  }
  // AINSEL, then the others of RROBIN upwards and round.
  void settle() {
    const std::uint32_t robin = field(value(kCs), 16, 5);
    inputs_ = 0;
    outside_ = robin != 0 && !bit(robin, input_);
    for (std::uint32_t i = 0; i < sequence_.size(); ++i) {
      const std::uint32_t input = (input_ + i) % sequence_.size();
      if (i == 0 || bit(robin, input)) sequence_[inputs_++] = static_cast<std::uint8_t>(input);
    }
  }

  // An AINSEL that is not in RROBIN is taken once: the next place is 1 already, the others are turned round to it.
  void leave_outside() {
    outside_ = false;
    const auto all = sequence_;
    --inputs_;
    for (unsigned i = 1; i <= inputs_; ++i) sequence_[i % inputs_] = all[i];
  }

  std::array<std::uint8_t, 5> sequence_{};
  bool outside_ = false;
  unsigned inputs_ = 1;
  std::deque<std::uint32_t> fifo_;
  std::uint32_t result_ = 0, input_ = 0, errors_ = 0;
  IrqLine irq_;
  int dma_;
};
}  // namespace

std::unique_ptr<Atomic<Adc>> make_adc(ChipContext& context) { return std::make_unique<RpAdc>(context); }

}  // namespace omnihil::mcu::rp2040
