#include "hil/loop/air_delay.h"

#include <algorithm>
#include <cmath>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr std::uint64_t kStream = stream_of("air_delay");
constexpr std::uint64_t kNormalStream = stream_of("air_delay_normal");

}  // namespace

double AirDelay::draw() { return uniform(seed_, kStream, drawn_++); }

double AirDelay::latency_s() {
  const double above_s = options_.latency_mean_s - options_.latency_least_s;
  if (above_s <= 0.0) return options_.latency_least_s;
  switch (options_.latency_law) {
    case LatencyLaw::kUniform:
      return options_.latency_least_s + 2.0 * above_s * draw();
    case LatencyLaw::kLognormal: {
      const double z = gaussian(seed_, kNormalStream, drawn_++);
      const double sigma = options_.latency_sigma;
      return options_.latency_least_s + above_s * std::exp(sigma * z - 0.5 * sigma * sigma);
    }
    case LatencyLaw::kExponential:
      break;
  }
  return options_.latency_least_s - above_s * std::log1p(-draw());
}

std::int64_t AirDelay::copy_late_ns(std::int64_t at_ns, std::int64_t& latest_ns) {
  double late_s = latency_s();
  if (options_.held_share > 0.0 && draw() < options_.held_share) {
    late_s += options_.held_s;
    ++counts_.held;
  }
  std::int64_t arrives_ns = at_ns + std::llround(late_s * 1e9);
  if (options_.in_order) arrives_ns = std::max(arrives_ns, latest_ns);
  if (arrives_ns < latest_ns) ++counts_.overtaken;
  latest_ns = std::max(latest_ns, arrives_ns);
  return arrives_ns - at_ns;
}

AirFate AirDelay::fate(int robot_id, AirWay way, std::int64_t at_ns) {
  AirFate fate;
  if (!options_.delays()) return fate;
  std::int64_t& latest_ns = latest_ns_[{robot_id, way}];
  if (options_.twice_share > 0.0 && draw() < options_.twice_share) {
    fate.copies = 2;
    ++counts_.twice;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(fate.copies); ++i)
    fate.late_ns[i] = copy_late_ns(at_ns, latest_ns);
  return fate;
}

}  // namespace omnihil
