// Work that does not depend on its order, on several threads. Each piece writes to its own place, so the
// result is the same at any number of threads.
//
//   parallel_for(jobs, n, [&](int k) { out[k] = work(k); });
//
// An exception of a piece is thrown again here, after all pieces have ended: that of the lowest index k.
#pragma once
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace omnihil {

template <typename Work>
void parallel_for(int jobs, int count, Work&& work) {
  const int threads = jobs < count ? jobs : count;
  if (threads <= 1) {
    for (int k = 0; k < count; ++k) work(k);
    return;
  }
  std::atomic<int> next{0};
  std::vector<std::exception_ptr> faults(static_cast<std::size_t>(count));
  const auto run = [&] {
    for (int k = next.fetch_add(1); k < count; k = next.fetch_add(1)) {
      try {
        work(k);
      } catch (...) {
        faults[static_cast<std::size_t>(k)] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> pool;
  for (int k = 1; k < threads; ++k) pool.emplace_back(run);
  run();
  for (std::thread& thread : pool) thread.join();
  for (const std::exception_ptr& fault : faults) {
    if (fault) std::rethrow_exception(fault);
  }
}

}  // namespace omnihil
