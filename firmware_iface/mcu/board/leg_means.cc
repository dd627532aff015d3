#include "firmware_iface/mcu/board/leg_means.h"

namespace omnihil::mcu {

void LegMeans::begin(const BridgeLegs& legs, std::int64_t at_ns) {
  first_ = held_ = legs;
  times_ = {};
  since_ns_ = at_ns;
  changed_ = {};
}

void LegMeans::pass(std::int64_t at_ns) {
  const auto ns = static_cast<double>(at_ns - since_ns_);
  since_ns_ = at_ns;
  if (ns <= 0.0) return;
  for (std::size_t x = 0; x < kLegs; ++x) {
    Times& t = times_[x];
    const double duty = held_.duty_ratio[x];
    const std::uint32_t leg = held_.leg[x];
    const bool one_switch = leg == OMNIHIL_LEG_HIGH || leg == OMNIHIL_LEG_LOW;
    if (leg == OMNIHIL_LEG_PWM || (one_switch && duty == 1.0)) {
      t.always_on += ns;
      if (leg != OMNIHIL_LEG_LOW) t.upper_always += ns * duty;
      continue;
    }
    t.other += ns;
    if (leg == OMNIHIL_LEG_HIGH) t.upper_other += ns * duty;
    if (leg == OMNIHIL_LEG_LOW) t.lower_other += ns * duty;
  }
}

void LegMeans::hold(const BridgeLegs& legs, std::int64_t at_ns) {
  std::array<bool, kLegs> moved{};
  for (std::size_t x = 0; x < kLegs; ++x)
    moved[x] = legs.leg[x] != held_.leg[x] || legs.duty_ratio[x] != held_.duty_ratio[x];
  if (moved == std::array<bool, kLegs>{}) return;
  pass(at_ns);
  held_ = legs;
  for (std::size_t x = 0; x < kLegs; ++x) changed_[x] = changed_[x] || moved[x];
}

BridgeLegs LegMeans::end(std::int64_t at_ns) {
  pass(at_ns);
  BridgeLegs mean = first_;
  for (std::size_t x = 0; x < kLegs; ++x) {
    const Times& t = times_[x];
    const double all = t.always_on + t.other;
    if (!changed_[x] || all <= 0.0) continue;
    const double upper = t.upper_always + t.upper_other;
    const double lower = t.always_on - t.upper_always + t.lower_other;
    const auto is = [&](std::uint32_t leg, double duty) {
      mean.leg[x] = leg;
      mean.duty_ratio[x] = duty;
    };
    if (t.other == 0.0 || (t.other <= t.always_on && upper > 0.0 && lower > 0.0)) {
      is(OMNIHIL_LEG_PWM, t.upper_always / t.always_on);
    } else if (upper > 0.0 && lower > 0.0) {  // longer open than not
      const bool up = t.upper_other >= t.lower_other;
      is(up ? OMNIHIL_LEG_HIGH : OMNIHIL_LEG_LOW, (up ? t.upper_other : t.lower_other) / t.other);
      if (mean.duty_ratio[x] == 0.0) mean.leg[x] = OMNIHIL_LEG_OFF;
    } else if (upper > 0.0) {
      is(OMNIHIL_LEG_HIGH, upper / all);
    } else if (lower > 0.0) {
      is(OMNIHIL_LEG_LOW, lower / all);
    } else {
      is(OMNIHIL_LEG_OFF, 0.0);
    }
  }
  return mean;
}

}  // namespace omnihil::mcu
