// CPU time of the calling thread: what a benchmark costs, whatever else the machine does.
#pragma once
#include <ctime>

namespace omnihil {

inline double thread_cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace omnihil
