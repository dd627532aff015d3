#include "identify/predict/counted_setups.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

struct Speeds {
  std::vector<ComparedSignal*> signals;
  std::vector<double> readings;  // of all runs, one after the other, NaN between
  double quantum = 0.0;
  double period_s = 0.0;
};

Speeds speeds_of(std::vector<AxisSetup>& setups) {
  Speeds out;
  for (AxisSetup& s : setups) {
    for (std::size_t c = 0; c < s.compared.size(); ++c) {
      if (s.steady || s.method != Method::kForward || s.seen[c].quantity != Quantity::kSpeed) continue;
      ComparedSignal& signal = s.compared[c];
      out.signals.push_back(&signal);
      out.readings.push_back(kMissing);
      out.readings.insert(out.readings.end(), signal.measured.begin(), signal.measured.end());
      if (signal.quantum > 0.0)
        out.quantum = out.quantum > 0.0 ? std::min(out.quantum, signal.quantum) : signal.quantum;
      // the mean: a window holds that many samples however the clock rounds them
      const std::vector<double>& t = signal.time_s;
      if (t.size() > 1) out.period_s = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
    }
  }
  return out;
}

void give_noise(ComparedSignal& signal, CountedSpeed counted, double period_s) {
  // what is stated of the sensor is on top of the count
  const double rounding = signal.quantum / std::sqrt(12.0);
  const double rest = signal.noise_sigma * signal.noise_sigma - rounding * rounding;
  counted.sensor_sigma = signal.noise_is_stated ? std::sqrt(std::max(0.0, rest)) : 0.0;
  signal.counted = counted;
  signal.noise_is_stated = true;  // by the pulses
  signal.noise_sigma = std::hypot(counted.noise_sigma(), counted.sensor_sigma);
  signal.whitening_s = kWhitening_s;
  // white noise, summed up with a leak: sigma^2 T tau / 2
  signal.whitened_sigma = std::hypot(counted.integrated_sigma_rad(),
                                     counted.sensor_sigma * std::sqrt(0.5 * kWhitening_s * period_s));
}

}  // namespace

const EffectEntry* find_counted_speed(std::vector<AxisSetup>& setups, const DriveParams<double>& drive) {
  if (drive.pole_pairs <= 0 || drive.linear) return nullptr;
  const Speeds speeds = speeds_of(setups);
  for (const EffectEntry* e : all_effects()) {
    const EffectParam& pulses = e->info->params[0];
    if ((e->info->claims & kCountsPulses) == 0 || pulses.start_for == nullptr) continue;
    const double pulse_rad = 2.0 * std::numbers::pi / pulses.start_for(drive) / drive.gear_ratio;
    const CountedSpeed counted = counted_speed(speeds.readings, speeds.quantum, speeds.period_s, pulse_rad);
    if (counted.window_s <= 0.0) continue;
    for (ComparedSignal* s : speeds.signals) give_noise(*s, counted, speeds.period_s);
    return e;
  }
  return nullptr;
}

}  // namespace omnihil
