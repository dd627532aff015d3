// Packets that come late, twice, or after one that was sent behind them.
//
//   AirDelay delay({.latency_least_s = 0.002, .latency_mean_s = 0.005, .twice_share = 0.01}, 7);
//   const AirFate fate = delay.fate(3, AirWay::kToRobot, now_ns);       // one copy or two, each with its lateness
//
// latency   of each copy by itself: never below the least; what is above it has the law and the mean that are asked for:
//             exponential  -(mean - least) ln(1 - u)
//             uniform      2 (mean - least) u
//             lognormal    (mean - least) exp(sigma z - sigma^2 / 2)
// twice     a share of the packets arrives a second time, with a latency of its own
// held      a share is held back by a fixed time besides: what is sent meanwhile overtakes it
// Latencies are independent, so packets overtake each other; in_order keeps each robot's in the order of sending, as one
// queue does: a packet that would come before its forerunner comes with it.
// Pure: drawn from the seed and the packet's number. Cannot: latencies that hang together, as those of a full queue do.
#pragma once
#include <cstdint>
#include <map>
#include <utility>

#include "hil/loop/air_options.h"
#include "protocols/radio_air.h"

namespace omnihil {

struct AirDelayCounts {
  std::uint64_t twice = 0, held = 0, overtaken = 0;  // overtaken: arrived after one that was sent later
};

class AirDelay {
 public:
  AirDelay(const AirOptions& options, std::uint64_t seed) : options_(options), seed_(seed) {}

  AirFate fate(int robot_id, AirWay way, std::int64_t at_ns);
  const AirDelayCounts& counts() const { return counts_; }

 private:
  double draw();
  double latency_s();
  std::int64_t copy_late_ns(std::int64_t at_ns, std::int64_t& latest_ns);

  AirOptions options_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  std::map<std::pair<int, AirWay>, std::int64_t> latest_ns_;  // arrival of all so far
  AirDelayCounts counts_;
};

}  // namespace omnihil
