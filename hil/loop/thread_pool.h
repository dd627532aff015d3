// Pieces of work on several cores: the caller's thread and a few that wait for it.
//
//   ThreadPool pool(4);                      // three threads beside the caller's
//   pool.each(24, [&](std::size_t n) { boards[n]->run_until_ns(end_ns); });
//
// Each thread begins with a share of its own, the same one whenever there are as many pieces, so that what a piece works on
// stays in its core's cache; whoever is done with it takes what others have not begun. Which thread does which differs from run
// to run: pieces share nothing that changes. Between two calls threads stay awake for a moment (30 us; 500 us where the last 32
// calls came within that: a bench that never sleeps), then sleep.
// Signals are left to the caller's thread. One call of each() at a time, and none from within a piece.
#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sim/robot/electric_ports.h"

namespace omnihil {

// That this process may use.
int host_cores();

class ThreadPool final : public Workers {
 public:
  explicit ThreadPool(int threads)
      : shares_(static_cast<std::size_t>(threads)) {}  // they are made when there is work for them
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

 protected:
  void run(std::size_t count, Piece piece, void* of) override;

 private:
  void start();
  void wait_for_work(std::size_t self);
  void take_pieces(std::uint32_t turn, std::size_t self);
  void take_from(std::size_t share, std::uint32_t turn);
  std::size_t begin_of(std::size_t share, std::size_t count) const { return share * count / shares_.size(); }
  void note_error(std::size_t n);

  // A turn is one call of each(). `next` is the turn and the piece of a share that is to be taken next: a piece is taken by
  // moving it on, which succeeds only while that turn lasts; and a turn lasts until all of its pieces are done.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> next{0};
  };
  std::vector<Share> shares_;  // one for each thread
  std::atomic<std::uint32_t> turn_{0};
  std::atomic<std::size_t> count_{0}, done_{0};
  std::atomic<Piece> piece_{nullptr};
  std::atomic<void*> of_{nullptr};
  std::atomic<bool> ended_{false};
  std::mutex errors_;
  std::exception_ptr error_;
  std::size_t error_at_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace omnihil
