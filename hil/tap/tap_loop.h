// The tap's loop on the wall clock, and its own delay.
//
//   const TapRun run = run_tap(tap, [] { return false; }, nullptr);      // or when a signal came
//   run.delay.p50_us, run.delay.p99_us;       // from bytes that wait until they are handed on
//
// Sleeps until either side has something, 1 ms at most: a host that opens its port is noticed then.
#pragma once
#include <cstdint>
#include <functional>

#include "hil/tap/tap.h"
#include "hil/tap/tap_vision.h"

namespace omnihil {

struct TapDelay {
  std::uint64_t passes = 0;  // that moved something
  double p50_us = 0.0, p99_us = 0.0, most_us = 0.0;
};

struct TapRun {
  std::int64_t end_ns = 0;    // since its start
  bool lost = false;          // the dongle or the port went away: tap.problem()
  TapDelay delay;             // from waking up to written
  double unix_start_s = 0.0;  // by this computer's clock
};

// `vision`: heard beside it, on the same clock; not owned, null: none. Its time is not in the delay.
TapRun run_tap(Tap& tap, const std::function<bool()>& stop, TapVision* vision);

}  // namespace omnihil
