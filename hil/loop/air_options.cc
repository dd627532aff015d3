#include "hil/loop/air_options.h"

#include <fmt/format.h>

namespace omnihil {
namespace {

constexpr double kLongest_s = 1.0;  // choice: a bench's queues hold what is under way

void between(double value, double low, double high, const char* what, std::vector<std::string>& problems) {
  if (value >= low && value <= high) return;
  problems.push_back(fmt::format("{}: found {}, allowed: {} to {}", what, value, low, high));
}

}  // namespace

std::vector<std::string> air_problems(const AirOptions& o) {
  std::vector<std::string> problems;
  between(o.share, 0.0, 1.0, "air: share", problems);
  between(o.burst_share, 0.0, 1.0, "air: share lost in bursts", problems);
  between(o.others_load, 0.0, 10.0, "air: load of others", problems);
  between(o.x_m, -100.0, 100.0, "air: transmitter's x in m", problems);
  between(o.y_m, -100.0, 100.0, "air: transmitter's y in m", problems);
  if (o.burst_bad_packets != 0.0 || o.burst_good_packets != 0.0) {
    between(o.burst_good_packets, 1.0, 1e9, "air: mean packets between bursts", problems);
    between(o.burst_bad_packets, 1.0, 1e9, "air: mean packets of a burst", problems);
  }
  between(o.latency_mean_s, 0.0, kLongest_s, "air: mean latency in s", problems);
  between(o.latency_least_s, 0.0, o.latency_mean_s, "air: least latency in s", problems);
  const bool lognormal = o.latency_law == LatencyLaw::kLognormal;
  between(o.latency_sigma, lognormal ? 0.01 : 0.0, lognormal ? 3.0 : 0.0, "air: sigma of a lognormal latency",
          problems);
  between(o.twice_share, 0.0, 1.0, "air: share that arrives twice", problems);
  between(o.held_share, 0.0, 1.0, "air: share held back", problems);
  between(o.held_s, o.held_share > 0.0 ? 1e-6 : 0.0, kLongest_s, "air: time held back in s", problems);
  between(o.bit_error_rate, 0.0, 0.5, "air: bit error rate", problems);
  return problems;
}

}  // namespace omnihil
