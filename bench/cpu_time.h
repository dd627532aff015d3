// CPU time of the calling thread: what a benchmark costs, whatever else the machine does.
//
// Where instructions are counted (tools/bench_count.py) a look at the clock is a second after the one before: what is done
// then depends on no clock.
#pragma once
#include <ctime>

namespace omnihil {

inline bool clock_counts_looks = false;

inline double thread_cpu_s() {
  static double looks_s = 0.0;
  if (clock_counts_looks) return looks_s += 1.0;
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace omnihil
