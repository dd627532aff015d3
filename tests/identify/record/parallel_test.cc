// Loops within loops: every piece once, idle threads at inner loops, faults by their place.
#include "identify/record/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace omnihil {
namespace {

// Where two threads meet. One that comes alone gives up after a time that is longer than any wake-up: then the test fails.
class MeetingOfTwo {
 public:
  bool meet() {
    std::unique_lock lock(mutex_);
    ++here_;
    came_.notify_all();
    return came_.wait_for(lock, std::chrono::seconds(30), [&] { return here_ == 2; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  int here_ = 0;
};

TEST(ParallelFor, DoesEveryPieceOfEveryLoopOnce) {
  for (const int jobs : {1, 2, 3, 8}) {
    std::vector<std::atomic<int>> done(4 * 5 * 3);
    parallel_for(jobs, 4, [&](int a) {
      parallel_for(1, 5, [&](int b) {
        parallel_for(3, [&](int c) { ++done[static_cast<std::size_t>((a * 5 + b) * 3 + c)]; });
      });
    });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1) << jobs;
  }
}

TEST(ParallelFor, AThreadWithNothingElseToDoTakesPiecesOfAnInnerLoop) {
  MeetingOfTwo meeting;
  std::vector<char> met(2, 0);
  parallel_for(2, 2, [&](int outer) {
    if (outer == 0) return;  // of two threads one is free from here on
    parallel_for(1, 2, [&](int inner) { met[static_cast<std::size_t>(inner)] = meeting.meet() ? 1 : 0; });
  });
  EXPECT_EQ(met, std::vector<char>(2, 1));
}

TEST(ParallelFor, ATeamIsOfAllLoopsWhileItLives) {
  const ThreadTeam team(2);
  for (int loop = 0; loop < 3; ++loop) {
    MeetingOfTwo meeting;
    std::vector<char> met(2, 0);
    parallel_for(2, [&](int k) { met[static_cast<std::size_t>(k)] = meeting.meet() ? 1 : 0; });
    EXPECT_EQ(met, std::vector<char>(2, 1)) << loop;
  }
}

TEST(ParallelFor, OneJobStaysOnItsThreadAndInOrder) {
  const ThreadTeam none(1);
  std::vector<int> order;
  parallel_for(1, 4, [&](int k) { order.push_back(k); });
  parallel_for(2, [&](int k) { order.push_back(10 + k); });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 10, 11}));
}

TEST(ParallelFor, ThrowsTheFaultOfTheLowestPieceAfterAllHaveEnded) {
  for (const int jobs : {2, 3}) {
    std::atomic<int> ended = 0;
    std::string said;
    try {
      parallel_for(jobs, 6, [&](int k) {
        parallel_for(2, [&](int inner) {
          if (k >= 2 && inner == 1) throw std::runtime_error(std::to_string(k));
        });
        ++ended;
      });
    } catch (const std::runtime_error& fault) {
      said = fault.what();
    }
    EXPECT_EQ(said, "2") << jobs;
    EXPECT_EQ(ended, 2) << jobs;
  }
}

}  // namespace
}  // namespace omnihil
