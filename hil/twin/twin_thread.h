// The twin beside a tap, in a thread of its own: the tap's loop leaves a copy of the bytes and goes on.
//
//   TwinThread twin(feed, runner, stdout);
//   Tap tap(std::move(host), std::move(dongle), &twin, step_ns);             // or in an ObserverList with a recorder
//   twin.finish(end_ns);                                                     // what was left is watched too
//
// A status line twice a second on a terminal, every ten seconds elsewhere. The thread may fall behind (a terminal that is held, a
// computer that is too slow): bytes wait, at most kMostWaiting of them, then the oldest are left out and counted; the tap never waits.
#pragma once
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <thread>

#include "hil/twin/twin_feed.h"
#include "hil/twin/twin_runner.h"

namespace omnihil {

class TwinThread : public SessionObserver {
 public:
  static constexpr std::size_t kMostWaiting = 4 << 20;  // bytes: minutes of six robots at 60 Hz

  // Neither is used by anybody else until finish(). out: for the status line; null: none.
  TwinThread(TwinFeed& feed, TwinRunner& runner, std::FILE* out);
  ~TwinThread();
  TwinThread(const TwinThread&) = delete;
  TwinThread& operator=(const TwinThread&) = delete;

  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void finish(std::int64_t end_ns);
  std::uint64_t left_out() const { return left_out_; }  // bytes; after finish()

 private:
  struct Passed {
    bool from_host = false;
    std::int64_t now_ns = 0;
    std::vector<std::uint8_t> bytes;
  };
  void leave(bool from_host, std::int64_t now_ns, std::span<const std::uint8_t> bytes);
  void run();
  void watch(const std::deque<Passed>& passed);
  void print();

  TwinFeed& feed_;
  TwinRunner& runner_;
  std::FILE* out_;
  bool terminal_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Passed> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t left_out_ = 0;
  bool ending_ = false;
  double printed_s_ = -1e9, now_s_ = 0.0;
  std::thread thread_;
};

}  // namespace omnihil
