#include "hil/loop/thread_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <utility>

namespace omnihil {
namespace {

using Clock = std::chrono::steady_clock;
// Choices. What a thread needs to fall asleep and to be woken again is of the first's order, and several times that on a
// virtual machine; what a bench does between two turns by itself (the physics of six robots) is within the second.
constexpr std::chrono::microseconds kAwake{30}, kLongAwake{500};
constexpr int kProving = 32;                   // waits: several steps of a bench; a choice
constexpr std::uint64_t kClosed = 0xFFFFFFFF;  // a place that no count reaches

constexpr int kLooks = 16;  // between two looks at the clock: below a microsecond; a choice

// Leaves the core's units to the other thread of the same core, where there is one.
void relax() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// True as soon as `done` is; false when it has not become so in that time.
template <class Done>
bool comes_soon(Done done, std::chrono::microseconds patience) {
  const auto end = Clock::now() + patience;
  for (int looks = 1; !done(); ++looks) {
    relax();
    if (looks % kLooks == 0 && Clock::now() >= end) return false;
  }
  return true;
}

}  // namespace

int host_cores() {
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return std::max(1, CPU_COUNT(&cores));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Of the caller's scheduling, whatever it has become since.
void ThreadPool::start() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  for (std::size_t i = 1; i < shares_.size(); ++i) threads_.emplace_back([this, i] { wait_for_work(i); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ThreadPool::~ThreadPool() {
  ended_ = true;
  ++turn_;
  turn_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

// Stays awake for long only while nothing else ever happens: one wait in the last few that was longer (a bench that sleeps
// until its next step) would be lost each time.
void ThreadPool::wait_for_work(std::size_t self) {
  int short_waits = 0;
  for (std::uint32_t seen = 0;;) {
    const Clock::time_point idle_from = Clock::now();
    const auto patience = short_waits >= kProving ? kLongAwake : kAwake;
    if (!comes_soon([&] { return turn_.load() != seen; }, patience)) turn_.wait(seen);
    short_waits = Clock::now() - idle_from < kLongAwake ? std::min(short_waits + 1, kProving) : 0;
    seen = turn_.load();
    if (ended_) return;
    take_pieces(seen, self);
  }
}

void ThreadPool::take_pieces(std::uint32_t turn, std::size_t self) {
  for (std::size_t i = 0; i < shares_.size(); ++i) take_from((self + i) % shares_.size(), turn);
}

void ThreadPool::take_from(std::size_t share, std::uint32_t turn) {
  std::atomic<std::uint64_t>& first = shares_[share].next;
  for (;;) {
    std::uint64_t next = first.load();
    const std::size_t n = next & 0xFFFFFFFFu;
    if (next >> 32 != turn || n >= begin_of(share + 1, count_.load())) return;
    const Piece piece = piece_.load();
    void* const of = of_.load();
    if (!first.compare_exchange_strong(next, next + 1)) continue;
    try {
      piece(of, n);
    } catch (...) {
      note_error(n);
    }
    if (done_.fetch_add(1) + 1 == count_.load()) done_.notify_all();
  }
}

void ThreadPool::note_error(std::size_t n) {
  const std::lock_guard lock(errors_);
  if (error_ && error_at_ < n) return;
  error_ = std::current_exception();
  error_at_ = n;
}

void ThreadPool::run(std::size_t count, Piece piece, void* of) {
  if (count == 0) return;
  if (count > 1 && threads_.empty()) start();
  const std::uint32_t turn = turn_.load() + 1;
  // whoever still looks for pieces of the last turn finds none, whatever count_ says
  for (Share& share : shares_) share.next = kClosed;
  piece_ = piece;
  of_ = of;
  done_ = 0;
  count_ = count;
  for (std::size_t i = 0; i < shares_.size(); ++i)
    shares_[i].next = std::uint64_t{turn} << 32 | begin_of(i, count);
  turn_ = turn;
  if (count > 1) turn_.notify_all();
  take_pieces(turn, 0);
  const auto all_done = [&] { return done_.load() == count; };
  while (!all_done() && !comes_soon(all_done, kLongAwake)) {
    const std::size_t so_far = done_.load();
    if (so_far != count) done_.wait(so_far);
  }
  if (!error_) return;
  std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace omnihil
