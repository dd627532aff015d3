#include "sim/drive/inverter.h"

#include <fmt/format.h>

#include <cmath>

namespace omnihil {

std::vector<std::string> problems_of(const Inverter& inverter) {
  std::vector<std::string> problems;
  const double f = inverter.pwm_frequency_Hz;
  if (!(f >= 8e3 && f <= 100e3))
    problems.push_back(fmt::format("pwm_frequency_Hz = {}: must be 8000 to 100000", f));
  const auto not_negative = [&](const char* name, double value) {
    if (!(value >= 0.0) || !std::isfinite(value))
      problems.push_back(fmt::format("{} = {}: must be 0 or greater", name, value));
  };
  not_negative("dead_time_s", inverter.dead_time_s);
  not_negative("switch_resistance_ohm", inverter.switch_resistance_ohm);
  not_negative("diode_forward_V", inverter.diode_forward_V);
  if (inverter.dead_time_s * f >= 0.25)
    problems.push_back(fmt::format("dead_time_s = {}: must be less than a quarter of the PWM period, {} s",
                                   inverter.dead_time_s, 0.25 / f));
  return problems;
}

}  // namespace omnihil
