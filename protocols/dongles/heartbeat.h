// A sign of life at whole multiples of a period of virtual time.
//
//   Heartbeat heartbeat(1'000'000'000);
//   if (heartbeat.due(now_ns)) …      // once per period, however many were missed
#pragma once
#include <cstdint>

namespace omnihil {

class Heartbeat {
 public:
  explicit Heartbeat(std::int64_t period_ns) : period_ns_(period_ns), next_ns_(period_ns) {}
  bool due(std::int64_t now_ns) {
    if (now_ns < next_ns_) return false;
    next_ns_ = (now_ns / period_ns_ + 1) * period_ns_;
    return true;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_;
};

}  // namespace omnihil
