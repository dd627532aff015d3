// Pieces of work on several threads: each is done once, all are done when the call comes back, and errors are the first one's.
#include "hil/loop/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace omnihil {
namespace {

TEST(ThreadPoolTest, EveryPieceIsDoneOnceAndBeforeTheCallComesBack) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadPool pool(threads);
    std::vector<int> done(100, 0);  // not atomic: a piece is one thread's, and the caller's when all are done
    for (int turn = 1; turn <= 2000; ++turn) {
      const std::size_t count = static_cast<std::size_t>(turn) % done.size() + 1;
      std::fill(done.begin(), done.end(), 0);
      pool.each(count, [&](std::size_t n) { ++done[n]; });
      ASSERT_EQ(std::accumulate(done.begin(), done.end(), 0), static_cast<int>(count)) << threads;
      for (std::size_t n = 0; n < count; ++n) ASSERT_EQ(done[n], 1) << threads << " " << turn << " " << n;
    }
  }
}

// Two pieces that wait for each other end only where two threads take them.
TEST(ThreadPoolTest, TwoPiecesRunAtOnce) {
  ThreadPool pool(2);
  for (int turn = 0; turn < 50; ++turn) {
    std::atomic<int> here{0};
    pool.each(2, [&](std::size_t) {
      ++here;
      while (here < 2) {
      }
    });
    EXPECT_EQ(here, 2);
  }
}

// The caller's first piece waits for the other thread's, which therefore is the first of its own half.
TEST(ThreadPoolTest, EachThreadBeginsWithItsShare) {
  ThreadPool pool(2);
  const std::thread::id caller = std::this_thread::get_id();
  for (int turn = 0; turn < 50; ++turn) {
    std::atomic<int> first{-1};
    pool.each(6, [&](std::size_t n) {
      int none = -1;
      if (std::this_thread::get_id() != caller) first.compare_exchange_strong(none, static_cast<int>(n));
      while (n == 0 && first < 0) {
      }
    });
    EXPECT_EQ(first, 3);
  }
}

TEST(ThreadPoolTest, TheFirstErrorIsThrownOnAndTheOthersAreDone) {
  ThreadPool pool(3);
  for (int turn = 0; turn < 100; ++turn) {
    std::atomic<int> done{0};
    try {
      pool.each(20, [&](std::size_t n) {
        ++done;
        if (n % 7 == 3) throw std::runtime_error(std::to_string(n));
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
    EXPECT_EQ(done, 20);
    pool.each(4, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 24);
  }
}

TEST(ThreadPoolTest, NothingToDoIsDone) {
  ThreadPool pool(4);
  pool.each(0, [](std::size_t) { FAIL(); });
  EXPECT_GE(host_cores(), 1);
}

}  // namespace
}  // namespace omnihil
