// The eight PWM slices of the RP2040: two channels each, on pins 2 n, 2 n + 1, and 16 above them.
//
//   PwmSlice slice(3, io, context);      // "PWM3", channels A (0) and B (1)
//   slice.period_s();                    // (TOP + 1) (DIV / 16) / clk_sys, twice that phase-correct
//
// Law: RP2040 datasheet §4.5: a channel is high while the counter is below its CC; CC and TOP are taken over when the
// counter wraps; DIVMODE counts freely, while B is high, or at its edges. The fraction of DIV is spread evenly. A channel
// none of whose pins is given to PWM is off. Wraps are announced where somebody listens (interrupt, DMA, CC and TOP on
// their way, a trace). Cannot represent: PH_ADV and PH_RET while it runs faster than the core polls them.
#pragma once
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/rp2040/io_bank.h"
#include "firmware_iface/mcu/stm32/timer/pwm_outputs.h"

namespace omnihil::mcu::rp2040 {

inline constexpr unsigned kSlices = 8;

// Its registers are those of Pwm; it is a block of its own for its name and its events.
class PwmSlice final : public Peripheral, public PwmOutputs {
 public:
  enum Register : std::uint32_t { kCsr = 0x00, kDiv = 0x04, kCtr = 0x08, kCc = 0x0C, kTop = 0x10 };
  PwmSlice(unsigned number, IoBank& io, ChipContext& context);
  void reset() override;
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  std::uint32_t peek(std::uint32_t offset) override { return read(offset, 4); }
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override;
  void run_events() override;
  void on_wrap(std::function<void()> listener) { on_wrap_ = std::move(listener); }
  void hear_wraps(bool on);  // somebody waits for them
  bool enabled() const { return (csr_ & 1u) != 0; }
  void advance();  // to this instant

  unsigned channels() const override { return 2; }
  std::string_view channel_letters() const override { return "AB"; }
  unsigned complements() const override { return 0; }
  bool level(unsigned channel, bool complement) const override;
  void look() override { advance(); }
  double period_s() const override;
  std::uint64_t updates_lost() const override { return lost_; }
  void note_lost() { ++lost_; }

 protected:
  TimerPin find_pin(unsigned channel, bool complement) const override;

 private:
  enum Mode : unsigned { kFree, kGated, kRising, kFalling };
  unsigned mode() const { return csr_ >> 4 & 3u; }
  bool phase_correct() const { return (csr_ & 2u) != 0; }
  bool counts() const;  // by the clock, now
  std::uint64_t period() const { return (std::uint64_t{top_} + 1) << (phase_correct() ? 1 : 0); }
  std::uint32_t step() const;  // sixteenths of a cycle for one count
  std::uint32_t counter() const;
  void count(std::uint64_t ticks);
  void wrapped();
  void transfer();
  void plan();
  void moved(Cycles before);
  bool find_b() const;
  void b_changed();
  void outputs_changed();

  unsigned number_;
  IoBank& io_;
  System& system_;
  std::function<void()> on_wrap_;
  std::uint32_t csr_ = 0, div_ = 0x10;
  std::uint32_t top_ = 0xFFFF, next_top_ = 0xFFFF;
  std::array<std::uint32_t, 2> cc_{}, next_cc_{};
  std::uint64_t position_ = 0;  // within the period, in counts
  std::uint32_t part_ = 0;      // and beyond it in sixteenths of a cycle
  Cycles since_ = 0;            // when that was
  std::uint32_t edges_ = 0;     // of B, before DIV, in sixteenths
  bool heard_ = false, b_ = false;
  std::uint64_t lost_ = 0;
  Cycles next_ = kNever;
};

class Pwm final : public Rp2040Block {
 public:
  Pwm(std::vector<PwmSlice*> slices, ChipContext& context);
  void reset() override;
  Cycles stable_until(std::uint32_t) const override { return 0; }
  // By DMA: a channel waits for this slice's wraps.
  void want_wraps(unsigned slice, bool wanted);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void hear();
  void look();
  void wrapped(unsigned slice);
  void update();

  ChipContext& context_;
  std::vector<PwmSlice*> slices_;
  std::array<int, kSlices> requests_{};
  Interrupts interrupts_;
  std::uint32_t wanted_ = 0;  // by DMA
  IrqLine line_;
};

}  // namespace omnihil::mcu::rp2040
