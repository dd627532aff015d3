// A reading of a sensor as the effects make it, whatever moves: how much older than its stamp it is (Place::kTiming), and
// what an encoder shows of the motion at that instant (Place::kSensor).
//
//   const ReadingStamp at = stamp_of(time_s, k, seed, stream_of("timing"));
//   const double seen_s = at.time_s - reading_age(effects, states, Stamped::kDriveSensors, at);
//   read_encoder(effects, states, at, turned_rad, port);     // port: with the true motion then
//
// Without a key of random numbers effects that draw them give their expected value.
#pragma once
#include <optional>
#include <vector>

#include "sim/law/effect_set.h"

namespace omnihil {

struct ReadingStamp {
  double time_s = 0.0;
  double dt_s = 0.0;  // since the reading before
  std::optional<NoiseKey> noise;
};

// Of sample k of a clock; no seed: no key.
inline ReadingStamp stamp_of(const std::vector<double>& time_s, std::size_t k,
                             const std::optional<std::uint64_t>& seed, std::uint64_t stream) {
  ReadingStamp at{.time_s = time_s[k], .dt_s = k > 0 ? time_s[k] - time_s[k - 1] : 0.0, .noise = {}};
  if (seed) at.noise = NoiseKey{*seed, stream, k};
  return at;
}

template <typename T>
T reading_age(const EffectSet<T>& effects, T* states, Stamped what, const ReadingStamp& at) {
  TimingPort<T> port;
  port.what = what;
  port.time_s = at.time_s;
  port.dt_s = at.dt_s;
  port.noise = at.noise ? &*at.noise : nullptr;
  effects.timing.apply(effects.values(), states, port);
  return port.age_s;
}

// turned_rad: by the rotor, since the reading before.
template <typename T>
void read_encoder(const EffectSet<T>& effects, T* states, const ReadingStamp& at, const T& turned_rad,
                  SensorPort<T>& port) {
  port.travel_rad = value_of(turned_rad) < 0.0 ? T(-turned_rad) : turned_rad;
  port.time_s = at.time_s;
  port.dt_s = at.dt_s;
  port.noise = at.noise ? &*at.noise : nullptr;
  effects.sensor.apply(effects.values(), states, port);
}

}  // namespace omnihil
