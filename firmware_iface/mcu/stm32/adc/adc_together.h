// Converters that a common block has work together: dual and triple modes.
//
//   AdcTogether group([](std::span<const std::uint32_t> results) { return results.size(); });   // all are taken
//   group.add(adc1);  group.add(adc2);                     // the first is the master
//   group.set(0b00110, 0);                                 // MULTI or DUAL of CCR: regular simultaneous
//
// Law: RM0090 §13.9, RM0440 §21.4.30. Simultaneous: the master's start starts all, each its own sequence at its own
// sampling times. Interleaved: the k-th starts k delays after it. Alternate trigger: each injected start goes to the next
// in turn. The slaves go on for as long as the master does. Results of a rank are given out when all have it, the
// master's first; interleaved ones as they come. Cannot represent: a slave's sequence longer than the master's (its
// results are given out a rank late), an injected sequence in between that interrupts only one.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace omnihil::mcu {

class Adc;

class AdcTogether {
 public:
  // Takes results from the front and says how many.
  using Deliver = std::function<std::size_t(std::span<const std::uint32_t> results)>;
  explicit AdcTogether(Deliver deliver) : deliver_(std::move(deliver)) {}

  void add(Adc& adc);
  void reset();
  void set(unsigned multi, unsigned delay_clocks);
  // What is set is neither independent nor one of the modes.
  bool known() const { return known_; }
  unsigned members() const { return members_; }  // 1: independent

  // For the converters.
  bool is_slave(const Adc& adc) const { return place(adc) > 0; }
  const Adc& master() const { return *adcs_[0]; }
  bool passes_on(const Adc& adc, bool injected);  // an injected start that goes to another
  void started(const Adc& adc, bool injected);
  void regular_result(const Adc& adc, std::uint32_t code);

 private:
  unsigned place(const Adc& adc) const;  // among the members; members() or more: none

  Deliver deliver_;
  std::vector<Adc*> adcs_;
  std::vector<std::vector<std::uint32_t>> ranks_;  // of each member, not yet given out
  std::vector<std::uint32_t> results_;
  unsigned members_ = 1, delay_clocks_ = 0, turn_ = 0;
  bool known_ = true, regular_ = false, injected_ = false, interleaved_ = false, alternate_ = false;
};

}  // namespace omnihil::mcu
