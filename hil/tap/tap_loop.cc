#include "hil/tap/tap_loop.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace omnihil {
namespace {

using Clock = std::chrono::steady_clock;

void wait_for_any(int a, int b, int c) {
  pollfd watched[3];
  nfds_t count = 0;
  for (const int fd : {a, b, c}) {
    if (fd >= 0) watched[count++] = {fd, POLLIN, 0};
  }
  const timespec most{0, 1'000'000};
  ::ppoll(watched, count, &most, nullptr);
}

// Of what is kept; every further one replaces a kept one in turn, so that a long run is told by its end.
constexpr std::size_t kKept = 1 << 20;
constexpr int kLastPasses = 64;  // of 4 kB: both queues and what a pty holds

}  // namespace

TapRun run_tap(Tap& tap, const std::function<bool()>& stop, TapVision* vision) {
  const auto start = Clock::now();
  const auto since_start = [&] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
  };
  TapRun run;
  run.unix_start_s =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  std::vector<float> delay_us;
  while (!stop()) {
    wait_for_any(tap.host_handle(), tap.dongle_handle(), vision != nullptr ? vision->handle() : -1);
    const std::int64_t woken_ns = since_start();
    run.lost = !tap.pass(woken_ns);
    if (run.lost) break;
    const std::int64_t done_ns = since_start();
    if (vision != nullptr) vision->pass(done_ns);
    if (!tap.moved()) continue;
    const auto taken_us = static_cast<float>(static_cast<double>(done_ns - woken_ns) / 1e3);
    if (delay_us.size() < kKept) {
      delay_us.push_back(taken_us);
    } else {
      delay_us[run.delay.passes % kKept] = taken_us;
    }
    ++run.delay.passes;
  }
  // What waits when the user stops it still belongs to the record.
  for (int n = 0; n < kLastPasses && !run.lost; ++n) {
    if (!tap.pass(since_start()) || !tap.moved()) break;
  }
  run.end_ns = since_start();
  if (delay_us.empty()) return run;
  std::sort(delay_us.begin(), delay_us.end());
  const auto at = [&](double share) {
    return static_cast<double>(
        delay_us[static_cast<std::size_t>(share * static_cast<double>(delay_us.size() - 1))]);
  };
  run.delay.p50_us = at(0.5);
  run.delay.p99_us = at(0.99);
  run.delay.most_us = at(1.0);
  return run;
}

}  // namespace omnihil
