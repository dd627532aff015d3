// A timer: counter, PWM with complementary outputs, capture, encoder, master and slave.
//
//   Timer timer({.number = 1, .bus = Bus::kApb2, .channels = 4, .advanced = true, …}, context);
//   timer.on_output([&](std::int64_t now_ns) { timer.output(0); });     // duty changes, at their instant
//   timer.set_shaft([&](std::int64_t at_ns) { return counts; });      // encoder inputs: counts over time
//   timer.set_input(0, true);                                         // a Hall edge on channel 1, now
//
// Law: reference manuals RM0090 §17-20, RM0316 §20-23, RM0440 §29-31. Counter, flags and outputs are worked
// out from the core clock when they are looked at; only instants that somebody listens to are scheduled. The
// period is exactly (PSC + 1)(ARR + 1) timer ticks. Encoder counts are those of the instant of the read.
// Cannot represent: input filters, external trigger input, asymmetric and combined PWM modes (8 and up),
// channels 5 and 6, break filters, the HRTIM; an encoder's overflow interrupt comes up to 50 us late.
#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"
#include "firmware_iface/mcu/stm32/timer/counter_law.h"
#include "firmware_iface/mcu/stm32/timer/pwm_outputs.h"

namespace omnihil::mcu {

struct TimerSpec {
  int number = 0;
  Bus bus = Bus::kApb1;
  unsigned channels = 4;
  bool bits32 = false;
  bool advanced = false;        // BDTR, repetition, complementary outputs
  bool fast_clock = false;      // can run from twice the PLL (F3: TIM1, TIM8)
  bool new_layout = false;      // G4: DMA registers at 0x3DC
  bool selects_inputs = false;  // H7: TISEL
  int irq_update = -1, irq_compare = -1, irq_break = -1,
      irq_trigger = -1;                          // the last three: as update if below 0
  std::vector<std::string> internal_triggers{};  // ITR0.. by name: "TIM2_TRGO"
};

struct TimerOutput {
  TimerPin main, complement;
  double dead_time_s = 0.0;
  double period_s = 0.0;  // of the PWM
};

class Timer final : public RegisterBlock, public TriggerSink, public TriggerSender, public PwmOutputs {
 public:
  using ShaftCount = std::function<std::int64_t(std::int64_t at_ns)>;
  Timer(TimerSpec spec, ChipContext& context);

  void reset() override;
  void run_events() override;
  void clock_changed() override;
  void triggered(int source, bool rising) override;
  void heard_changed() override;
  Cycles stable_until(std::uint32_t offset) const override;

  const TimerSpec& spec() const { return spec_; }
  unsigned channels() const override { return spec_.channels; }
  unsigned complements() const override { return spec_.advanced ? std::min(spec_.channels, 3u) : 0; }
  void set_shaft(ShaftCount shaft);
  void set_input(unsigned channel, bool level);
  // The break input's pin: outputs follow at once, whatever the clock does (its filter is off).
  void break_input(bool level);
  TimerOutput output(unsigned channel) const;
  // Of a pin that is driven: its level at this instant, as if there were no dead time.
  bool level(unsigned channel, bool complement) const override;
  void look() override {
    if (!encoder()) sync();
  }
  bool paired(unsigned channel) const {  // both of its pins are on: dead time lies between them
    return (enable_bits() >> 4 * channel & 5u) == 5u;
  }
  bool reference(unsigned channel) const;  // OCxREF now
  double period_s() const override;        // (PSC + 1) periods of the count
  // Update events, software's own aside, that found the flag of the one before still set.
  std::uint64_t updates_lost() const override { return updates_lost_; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  static constexpr unsigned kChannels = 4;
  // timer.cc
  bool encoder() const { return encoder_; }
  std::uint64_t position() const {
    const std::uint64_t at = start_ + done_, period = law_.period();
    return at < period ? at : at % period;
  }
  std::uint64_t ticks_at(Cycles at) const;
  Cycles cycle_of(std::uint64_t ticks) const;
  std::uint32_t count() const;
  void set_count(std::uint32_t count);
  void move_to(std::uint64_t position);  // from the last tick on
  void sync() {
    if (encoder()) {
      sync_encoder();
    } else {
      sync_count();
    }
  }
  void sync_count();
  void skip_periods(std::uint64_t whole);
  void boundary();
  void update_event(bool by_software);
  void transfer();
  void follow_settings();
  Cycles after(std::uint64_t ticks) const { return cycle_of(done_ + ticks); }
  void raise(std::uint32_t flags);
  void update_irqs();
  void generate(std::uint32_t events);
  void store_dma_burst(std::uint32_t written);
  bool store_preload(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes);
  // timer_plan.cc
  bool transfer_pending() const { return preloaded_ != 0; }
  void note_preloads();
  void plan();
  std::uint32_t awaited_matches() const;
  std::uint32_t heard_edges() const;
  std::uint32_t find_heard_edges() const;
  Cycles next_match(unsigned channel) const;
  Cycles next_edge(unsigned channel) const;
  // timer_output.cc
  void note_settings();
  unsigned output_mode(unsigned channel) const { return mode_[channel]; }
  bool captures(unsigned channel) const { return (captures_ >> channel & 1u) != 0; }
  bool acts_on_match(unsigned channel) const { return (acting_ >> channel & 1u) != 0; }
  unsigned match_positions(unsigned channel, std::array<std::uint64_t, 2>& at) const;
  void mark_matches(std::uint64_t ticks);
  void matched(unsigned channel);
  void look_at_references();
  void reference_moved(unsigned channel, bool level);
  bool reference_of(unsigned channel, bool falling, std::uint64_t count) const;
  std::uint32_t references_at(std::uint64_t position) const;
  TimerPin find_pin(unsigned channel, bool complement) const override;
  bool is_plain_pwm(unsigned channel) const;
  TimerPin work_out_pin(unsigned channel, bool complement) const;
  double dead_ticks() const;
  void outputs_changed();
  void commutate();
  std::uint32_t enable_bits() const { return commutates() ? ccer_ : value(0x20); }
  bool commutates() const { return spec_.advanced && bit(value(0x04), 0); }
  // timer_input.cc
  void sync_encoder();
  std::int64_t shaft_edges() const;
  std::int64_t unwrapped() const;
  std::uint32_t shaft_count() const;
  void input_edge(unsigned input, bool level);
  bool selected_edge(unsigned channel, bool level) const;
  void capture(unsigned channel);
  void trigger_edge();
  bool look_at_break();  // whether it has switched the outputs off
  void listen_to_triggers();
  bool timer_input(unsigned input) const;

  TimerSpec spec_;
  std::uint64_t updates_lost_ = 0;
  ChipContext& context_;
  ClockRatio clock_;
  CounterLaw law_;                              // of the active ARR
  std::uint64_t prescale_ = 1;                  // active PSC + 1
  std::array<std::uint64_t, kChannels> ccr_{};  // active
  std::array<char, kChannels> toggled_{};       // OCxREF of the modes that act on matches
  std::uint32_t seen_references_ = 0;           // a bit per channel, at the last look
  std::uint32_t preloaded_ = 0;  // what waits for the next update: a bit per channel, kChannels: PSC or ARR
  std::array<std::uint32_t, 2> ccmr_{};  // active where channels are commutated
  std::uint32_t ccer_ = 0;
  std::array<std::uint8_t, kChannels> mode_{};  // of the outputs, active
  std::uint32_t captures_ = 0, flag_only_ = 0;  // a bit per channel: an input; a match sets its flag alone
  std::uint32_t acting_ = 0, outputs_ = 0;      // its reference acts on matches; it is there, and no input
  bool encoder_ = false;
  std::uint32_t asking_ = 0;  // flags that hold an interrupt line
  bool running_ = false;
  Cycles anchor_ = 0;                   // when the counter stood at start_
  std::uint64_t start_ = 0, done_ = 0;  // position at the anchor; ticks since then that were dealt with
  std::uint64_t repeat_left_ = 0;
  Cycles next_ = kNever;
  bool update_alone_ = false;                              // next_ is the next update or never, and ...
  std::uint32_t heard_then_ = 0;                           // ... the triggers' version when that was found
  mutable std::uint32_t heard_ = 0, heard_version_ = ~0u;  // heard_edges() at a version of the triggers
  ShaftCount shaft_;
  std::int64_t shaft_zero_ = 0, shaft_seen_ = 0;
  bool shaft_falling_ = false;
  std::array<char, kChannels> inputs_{};
  std::array<unsigned, kChannels> edges_left_{};  // of the input prescalers
  bool break_high_ = false;                       // active: enabled, and the pin at its active level
  std::optional<bool> break_level_ = {};          // the pin's; nobody drives it: never active
  unsigned burst_ = 0;
  int trgo_ = 0;
  std::array<int, kChannels> compare_{}, dma_channel_{};
  std::vector<int> internal_;
  int dma_update_ = 0, dma_trigger_ = 0, dma_com_ = 0;
  IrqLine irq_update_, irq_compare_, irq_break_, irq_trigger_;
};

}  // namespace omnihil::mcu
