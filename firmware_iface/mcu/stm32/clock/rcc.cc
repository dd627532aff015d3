#include "firmware_iface/mcu/stm32/clock/rcc.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace omnihil::mcu {

void Rcc::reset() {
  RegisterBlock::reset();
  flags_cleared_ = false;
  apply();
}

std::uint32_t Rcc::load(std::uint32_t offset) {
  const std::uint32_t v = value(offset);
  std::uint32_t out = v;
  for (const RccReady& row : map_.ready) {
    if (row.offset == offset) out |= (v & row.switches) << row.up;
  }
  if (offset == map_.cfgr) out |= selected() << map_.sws;
  if (offset == map_.csr) out |= reset_flags();
  return out;
}

void Rcc::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset == map_.csr && bit(written, map_.rmvf)) flags_cleared_ = true;
  if (std::find(map_.tree.begin(), map_.tree.end(), offset) != map_.tree.end()) apply();
}

void Rcc::select(std::uint32_t wanted, double hz) {
  constexpr double kSlowest_hz = 1e5;  // of a source that is meant
  const int by = wanted < map_.switches.size() ? map_.switches[wanted] : -1;
  bool ready = by >= 0 && bit(value(0x00), static_cast<unsigned>(by));
  if (wanted == map_.hsi) {
    ready = true, hz = clocks().hsi_hz;  // switched on by the hardware when it is asked for
  }
  if (!ready || hz < kSlowest_hz) {
    system().report_unmodelled(name(), "CFGR selects a clock that is off or of no frequency; it stays");
    return;
  }
  selected_ = wanted;
  sysclk_hz_ = hz;
}

std::uint32_t Rcc::reset_flags() const {
  if (flags_cleared_) return 0;
  const RccReasons& by = map_.reasons;
  const std::string_view cause = system().reset_cause();
  if (cause == "IWDG") return by.pin | by.iwdg;
  if (cause == "WWDG") return by.pin | by.wwdg;
  if (cause == "power-on" || cause == "brown-out") return by.pin | by.power;
  return by.pin | by.software;
}

std::uint32_t Rcc::ahb_divider(std::uint32_t code) {
  constexpr std::uint32_t kDividers[] = {2, 4, 8, 16, 64, 128, 256, 512};
  return code < 8 ? 1 : kDividers[code & 7u];
}

std::uint32_t Rcc::apb_divider(std::uint32_t code) { return code < 4 ? 1 : 2u << (code & 3u); }

ClockRatio Rcc::ratio(double hz, double core_hz) {
  const auto ticks = static_cast<std::uint64_t>(std::llround(hz));
  const auto cycles = static_cast<std::uint64_t>(std::llround(core_hz));
  const std::uint64_t common = std::gcd(ticks, cycles);
  return {static_cast<std::uint32_t>(ticks / common), static_cast<std::uint32_t>(cycles / common)};
}

void Rcc::kernel(ClockState& state, Bus which, double hz) {
  if (hz > 0.0) {
    state.of(which) = ratio(hz, state.hclk_hz);
  } else {
    state.off |= 1u << static_cast<unsigned>(which);
  }
}

ClockState Rcc::buses(double sysclk_hz, std::uint32_t ahb, std::uint32_t apb1, std::uint32_t apb2) {
  ClockState state;
  state.sysclk_hz = sysclk_hz;
  state.hclk_hz = sysclk_hz / ahb;
  state.of(Bus::kApb1) = {1, apb1};
  state.of(Bus::kApb2) = {1, apb2};
  state.of(Bus::kAdc) = {ahb, 1};  // SYSCLK
  // An APB prescaler other than 1 doubles the timers' clock: half its divider.
  state.timers = {ClockRatio{1, 1}, ClockRatio{1, apb1 == 1 ? 1 : apb1 / 2},
                  ClockRatio{1, apb2 == 1 ? 1 : apb2 / 2}};
  return state;
}

std::unique_ptr<Rcc> make_rcc(RccFamily family, ChipContext& context) {
  if (family == RccFamily::kF0 || family == RccFamily::kF3) return make_rcc_f0_f3(family, context);
  if (family == RccFamily::kF1) return make_rcc_f1(context);
  if (family == RccFamily::kG0) return make_rcc_g0(context);
  if (family == RccFamily::kG4) return make_rcc_g4(context);
  if (family == RccFamily::kH7) return make_rcc_h7(context);
  if (family == RccFamily::kL4) return make_rcc_l4(context);
  return make_rcc_f4_f7(family, context);
}

}  // namespace omnihil::mcu
