#include "firmware_iface/mcu/stm32/adc/adc_together.h"

#include <algorithm>

#include "firmware_iface/mcu/stm32/adc/adc.h"

namespace omnihil::mcu {

void AdcTogether::add(Adc& adc) {
  adcs_.push_back(&adc);
  ranks_.emplace_back();
  adc.join(*this);
}

void AdcTogether::reset() { set(0, 0); }

void AdcTogether::set(unsigned multi, unsigned delay_clocks) {
  struct Mode {
    unsigned code;
    bool regular, injected, interleaved, alternate;
  };
  constexpr Mode kModes[] = {{0b0000, false, false, false, false}, {0b0001, true, true, false, false},
                             {0b0010, true, false, false, true},   {0b0011, false, true, true, false},
                             {0b0101, false, true, false, false},  {0b0110, true, false, false, false},
                             {0b0111, false, false, true, false},  {0b1001, false, false, false, true}};
  const auto* mode = std::find_if(std::begin(kModes), std::end(kModes),
                                  [multi](const Mode& row) { return row.code == (multi & 0xFu); });
  known_ = mode != std::end(kModes);
  const Mode is = known_ ? *mode : kModes[0];
  regular_ = is.regular;
  injected_ = is.injected;
  interleaved_ = is.interleaved;
  alternate_ = is.alternate;
  const unsigned wanted = is.code == 0 ? 1 : (multi & 0x10u) != 0 ? 3 : 2;
  members_ = std::min(wanted, static_cast<unsigned>(adcs_.size()));
  delay_clocks_ = delay_clocks;
  turn_ = 0;
  results_.clear();
  for (auto& rank : ranks_) rank.clear();
}

unsigned AdcTogether::place(const Adc& adc) const {
  for (unsigned i = 0; i < members_ && i < adcs_.size(); ++i) {
    if (adcs_[i] == &adc) return i;
  }
  return 0;
}

bool AdcTogether::passes_on(const Adc& adc, bool injected) {
  if (!alternate_ || !injected || &adc != adcs_[0]) return false;
  const unsigned mine = turn_;
  turn_ = (turn_ + 1) % members_;
  if (mine == 0) return false;
  adcs_[mine]->follow(true, 0);
  return true;
}

void AdcTogether::started(const Adc& adc, bool injected) {
  if (members_ < 2 || &adc != adcs_[0]) return;
  const bool late = interleaved_ && !injected;
  if (!late && !(injected ? injected_ : regular_)) return;
  // Never two of them sample at a time.
  const double delay = late ? std::max<double>(delay_clocks_, adc.sampling_clocks()) : 0.0;
  for (unsigned i = 1; i < members_; ++i) adcs_[i]->follow(injected, i * delay);
}

void AdcTogether::regular_result(const Adc& adc, std::uint32_t code) {
  if (members_ < 2 || !(regular_ || interleaved_)) return;
  bool member = false;
  for (unsigned i = 0; i < members_; ++i) {
    if (adcs_[i] != &adc) continue;
    member = true;
    if (interleaved_) {
      results_.push_back(code);
    } else {
      ranks_[i].push_back(code);
    }
  }
  if (!member) return;
  const auto has_rank = [](const auto& rank) { return !rank.empty(); };
  while (std::all_of(ranks_.begin(), ranks_.begin() + members_, has_rank)) {
    for (unsigned i = 0; i < members_; ++i) {
      results_.push_back(ranks_[i].front());
      ranks_[i].erase(ranks_[i].begin());
    }
  }
  const std::size_t taken = deliver_(results_);
  results_.erase(results_.begin(),
                 results_.begin() + static_cast<std::ptrdiff_t>(std::min(taken, results_.size())));
}

}  // namespace omnihil::mcu
