// Analogue to digital converters: the sequence and its timing here, the registers of a family in adc_v1,
// adc_v2, adc_f1.
//
//   adc.set_source(5, [](std::int64_t at_ns) { return 1.65; });   // volts at input 5, as a function of time
//
// Law: a conversion samples for the time of its channel, then takes 12 (v1) or 12.5 clocks; the value is that
// of the instant at which sampling ends: code = volts * 2^n / Vref, rounded, clipped at both ends. Injected
// conversions interrupt regular ones, which then start anew. Inputs without a source read 0 V, and are
// reported once. Dual and triple modes: adc_together.h. Cannot represent: analogue watchdogs, offsets, oversampling,
// differential inputs, source impedance, noise (a source may bring its own).
#pragma once
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/adc/adc_together.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

using AnalogSource = std::function<double(std::int64_t at_ns)>;

struct AdcTriggers {  // names by the number in EXTSEL, JEXTSEL; "" where there is none
  std::vector<std::string> regular, injected;
};

class Adc : public RegisterBlock, public TriggerSink {
 public:
  Adc(std::string name, std::span<const RegisterInfo> registers, const AdcTriggers& triggers,
      ChipContext& context);
  void reset() override;
  void run_events() override;
  void triggered(int source, bool rising) override;
  void clock_changed() override { registers_change(); }

  // Steady: nothing that the chip does changes what it tells, and who else changes it calls take_samples() first. It may
  // then be asked at the end of the conversion, which saves the event at the end of its sampling.
  void set_source(unsigned channel, AnalogSource source, bool steady = false);
  // A source that always tells the same.
  void set_voltage(unsigned channel, double volts) {
    set_source(
        channel, [volts](std::int64_t) { return volts; }, true);
  }
  void take_samples() {  // those whose instant has come
    if (held_ && sampled_at_ <= now()) sample();
  }
  double reference_V = 3.3;
  // For the group that it belongs to.
  void join(AdcTogether& group) { group_ = &group; }
  void follow(bool injected, double delay_clocks);  // a slave's start, by the master's
  // Before anything changes that a conversion under way is measured by: registers, clocks.
  void registers_change() {
    take_samples();
    if (std::exchange(held_, false)) phase_end_ = sampled_at_;
  }
  // How long after this one's begin another may sample: its own sampling and two clocks.
  double sampling_clocks() const { return sample_clocks(channel(Group::kRegular, place_)) + 2.0; }

 protected:
  enum class Group : std::uint8_t { kNone, kRegular, kInjected };
  // What a family's registers say.
  virtual unsigned length(Group group) const = 0;
  virtual unsigned channel(Group group, unsigned place) const = 0;
  virtual double sample_clocks(unsigned channel) const = 0;
  virtual double convert_clocks() const = 0;
  virtual double clock_hz() const = 0;
  virtual unsigned bits() const = 0;
  virtual bool left_aligned() const = 0;
  // One result, the last of its sequence or not.
  virtual void result(Group group, unsigned place, std::uint32_t code, bool last) = 0;
  virtual bool continues() const = 0;        // regular sequences: at once again
  virtual bool one_per_trigger() const = 0;  // regular: discontinuous, one conversion per start
  virtual bool injected_follow() const = 0;  // JAUTO
  // Which trigger starts a group (number in its table, or -1), and on which edges: 1 rising, 2 falling, 3
  // both.
  virtual std::pair<int, unsigned> trigger(Group group) const = 0;
  virtual bool armed(Group group) const = 0;  // waits for its trigger
  virtual bool enabled() const = 0;           // switched on

  void start(Group group);
  void stop(Group group);
  bool busy(Group group) const { return active_ == group || (group == Group::kRegular && suspended_); }
  void listen();
  ChipContext& context() const { return context_; }

 private:
  void begin();
  void sample();
  // Of the core, for so many clocks of the converter; each of the two parts of a conversion has lasted so long before, mostly.
  struct Lasted {
    double clocks = 0.0, core_hz = 0.0, clock_hz = 0.0;
    Cycles cycles = 0;
  };
  Cycles cycles(Lasted& before, double clocks);
  // Of what follows the sampling: both together are whole cycles, not each of them.
  Cycles conversion() { return whole() - cycles(sampling_lasted_, sampling_clocks_); }
  Cycles whole() { return cycles(whole_lasted_, sampling_clocks_ + convert_clocks()); }
  void finish();
  bool goes_on() const {
    return in_group() && group_->is_slave(*this) ? group_->master().continues() : continues();
  }
  bool in_group() const { return group_ != nullptr && group_->members() > 1; }

  ChipContext& context_;
  std::array<AnalogSource, 32> sources_;
  std::uint32_t steady_ = 0;  // a bit for each source that is
  std::vector<int> regular_lines_, injected_lines_;
  AdcTogether* group_ = nullptr;
  double late_clocks_ = 0.0;  // of the next begin() alone
  Group active_ = Group::kNone;
  bool suspended_ = false;  // a regular sequence waits for injected ones
  bool sampling_ = false;
  bool held_ = false;  // phase_end_ is the end of a conversion whose source has not been asked yet
  Cycles sampled_at_ = 0;
  unsigned place_ = 0, regular_place_ = 0;
  std::uint32_t code_ = 0;
  Cycles phase_end_ = kNever;
  double sampling_clocks_ = 0.0;  // of the conversion under way
  Lasted sampling_lasted_, whole_lasted_;
};

}  // namespace omnihil::mcu
