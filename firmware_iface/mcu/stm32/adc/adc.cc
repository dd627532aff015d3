#include "firmware_iface/mcu/stm32/adc/adc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil::mcu {

Adc::Adc(std::string name, std::span<const RegisterInfo> registers, const AdcTriggers& triggers,
         ChipContext& context)
    : RegisterBlock(std::move(name), context.system, registers), context_(context) {
  next_event_is(phase_end_);
  const auto lines = [&context](const std::vector<std::string>& names, std::vector<int>& out) {
    for (const std::string& n : names) out.push_back(n.empty() ? -1 : context.triggers.source(n));
  };
  lines(triggers.regular, regular_lines_);
  lines(triggers.injected, injected_lines_);
}

void Adc::reset() {
  RegisterBlock::reset();
  active_ = Group::kNone;
  suspended_ = false;
  regular_place_ = place_ = 0;
  held_ = false;
  phase_end_ = kNever;
  listen();
}

void Adc::set_source(unsigned channel, AnalogSource source, bool steady) {
  const unsigned at = channel % sources_.size();
  sources_[at] = std::move(source);
  steady_ = (steady_ & ~(1u << at)) | (steady ? 1u << at : 0u);
}

void Adc::follow(bool injected, double delay_clocks) {
  if (!enabled()) return;
  late_clocks_ = delay_clocks;
  start(injected ? Group::kInjected : Group::kRegular);
  late_clocks_ = 0.0;
  system().reschedule();
}

void Adc::start(Group group) {
  if (length(group) == 0) return;
  const bool injected = group == Group::kInjected;
  if (in_group() && group_->passes_on(*this, injected)) return;
  if (group == Group::kRegular) {
    if (busy(Group::kRegular)) return;
    if (active_ == Group::kInjected) {
      suspended_ = true;
      return;
    }
    place_ = one_per_trigger() ? regular_place_ : 0;
  } else {
    if (active_ == Group::kInjected) return;
    if (active_ == Group::kRegular) {
      suspended_ = true;
      regular_place_ = place_;
    }
    place_ = 0;
  }
  active_ = group;
  begin();
  if (in_group()) group_->started(*this, injected);
}

void Adc::stop(Group group) {
  if (group == Group::kRegular) {
    suspended_ = false;
    regular_place_ = 0;
  }
  if (active_ != group) return;
  active_ = Group::kNone;
  held_ = false;
  phase_end_ = kNever;
  if (suspended_) {
    suspended_ = false;
    active_ = Group::kRegular;
    place_ = regular_place_;
    begin();
  }
}

Cycles Adc::cycles(Lasted& before, double clocks) {
  const double core_hz = system().core_hz(), own_hz = clock_hz();
  if (clocks != before.clocks || core_hz != before.core_hz || own_hz != before.clock_hz) {
    const auto cycles = static_cast<Cycles>(std::llround(clocks * core_hz / own_hz));
    before = {clocks, core_hz, own_hz, std::max<Cycles>(1, cycles)};
  }
  return before.cycles;
}

// Starts sampling the channel at place_.
void Adc::begin() {
  const unsigned input = channel(active_, place_);
  sampling_ = true;
  sampling_clocks_ = sample_clocks(input) + late_clocks_;
  const Cycles begun = now();
  phase_end_ = sampled_at_ = begun + cycles(sampling_lasted_, sampling_clocks_);
  held_ = (steady_ >> input & 1u) != 0;
  if (held_) phase_end_ = begun + whole();
}

void Adc::run_events() {
  if (phase_end_ > now()) return;
  if (sampling_) {
    const bool ends_too = held_;
    sample();
    if (!ends_too) {
      phase_end_ += conversion();
      return;
    }
  }
  finish();
}

void Adc::sample() {
  const unsigned input = channel(active_, place_);
  double volts = 0.0;
  if (sources_[input]) {
    volts = sources_[input](system().to_ns(sampled_at_));
  } else {
    system().report_unmodelled(name(), fmt::format("input {} converted; nothing is connected to it", input));
  }
  const unsigned resolution = bits();
  const double full = static_cast<double>(1u << resolution);
  const double code = std::floor(volts / reference_V * full + 0.5);
  code_ = code > 0.0 ? static_cast<std::uint32_t>(std::min(code, full - 1.0)) : 0u;
  if (left_aligned()) code_ <<= resolution == 6 ? 2 : 16 - resolution;
  sampling_ = held_ = false;
}

void Adc::finish() {
  const Group group = active_;
  const unsigned place = place_;
  const bool last = place + 1 >= length(group);
  active_ = Group::kNone;
  phase_end_ = kNever;
  // What comes next is settled before the result is told: telling it may start or stop conversions.
  if (group == Group::kInjected) {
    if (!last) {
      active_ = group;
      ++place_;
    } else if (suspended_) {
      suspended_ = false;
      active_ = Group::kRegular;
      place_ = regular_place_;
    }
  } else if (one_per_trigger()) {
    regular_place_ = last ? 0 : place + 1;
  } else if (!last || goes_on()) {
    active_ = group;
    place_ = last ? 0 : place + 1;
  }
  if (active_ != Group::kNone) begin();
  const std::uint32_t code = code_;
  result(group, place, code, last);
  if (group == Group::kRegular && in_group()) group_->regular_result(*this, code);
  if (group == Group::kRegular && last && injected_follow()) start(Group::kInjected);
}

void Adc::triggered(int source, bool rising) {
  const Cycles before = phase_end_;
  for (const Group group : {Group::kInjected, Group::kRegular}) {
    const auto& lines = group == Group::kRegular ? regular_lines_ : injected_lines_;
    const auto [number, edges] = trigger(group);
    if (number < 0 || static_cast<std::size_t>(number) >= lines.size()) continue;
    if (lines[static_cast<std::size_t>(number)] != source || (edges & (rising ? 1u : 2u)) == 0) continue;
    if (armed(group)) start(group);
  }
  if (phase_end_ != before) system().event_moved(&phase_end_, before);
}

// Listens to the triggers that the registers select, and to no others.
void Adc::listen() {
  std::vector<int> wanted;
  for (const Group group : {Group::kRegular, Group::kInjected}) {
    const auto& lines = group == Group::kRegular ? regular_lines_ : injected_lines_;
    const auto [number, edges] = trigger(group);
    if (number < 0 || edges == 0 || !armed(group)) continue;
    if (static_cast<std::size_t>(number) >= lines.size() || lines[static_cast<std::size_t>(number)] < 0) {
      system().report_unmodelled(name(), fmt::format("trigger {} is not modelled", number));
      continue;
    }
    wanted.push_back(lines[static_cast<std::size_t>(number)]);
  }
  for (const auto* lines : {&regular_lines_, &injected_lines_}) {
    for (const int line : *lines) {
      if (line >= 0) {
        context_.triggers.listen(line, *this, std::find(wanted.begin(), wanted.end(), line) != wanted.end());
      }
    }
  }
}

}  // namespace omnihil::mcu
