#include "identify/record/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace omnihil {
namespace {

struct PieceLoop {
  int count = 0;
  const std::function<void(int)>* work = nullptr;
  const PieceLoop* around = nullptr;  // whose piece began it; null: none
  int taken = 0;
  int ended = 0;
  std::vector<std::exception_ptr> faults;  // [piece]

  bool is_within(const PieceLoop& other) const {
    const PieceLoop* at = this;
    while (at != nullptr && at != &other) at = at->around;
    return at != nullptr;
  }
};

thread_local ThreadTeam::Shared* own_team = nullptr;
thread_local const PieceLoop* own_loop = nullptr;  // whose piece this thread is at

void rethrow_first(const std::vector<std::exception_ptr>& faults) {
  const auto first =
      std::find_if(faults.begin(), faults.end(), [](const std::exception_ptr& f) { return f != nullptr; });
  if (first != faults.end()) std::rethrow_exception(*first);
}

}  // namespace

class ThreadTeam::Shared {
 public:
  explicit Shared(int threads) {
    for (int k = 1; k < threads; ++k) pool_.emplace_back([this] { help(); });
  }
  ~Shared() {
    {
      const std::scoped_lock lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : pool_) thread.join();
  }

  void run(PieceLoop& loop) {
    std::unique_lock lock(mutex_);
    open_.push_back(&loop);
    if (waiting_ > 0) changed_.notify_all();
    while (loop.taken < loop.count) take_one(loop, lock);
    while (loop.ended < loop.count) {
      PieceLoop* const inner = first_open([&](const PieceLoop& l) { return l.is_within(loop); });
      inner != nullptr ? take_one(*inner, lock) : wait(lock);
    }
  }

 private:
  void help() {
    own_team = this;
    std::unique_lock lock(mutex_);
    while (!ending_) {
      PieceLoop* const any = first_open([](const PieceLoop&) { return true; });
      any != nullptr ? take_one(*any, lock) : wait(lock);
    }
  }

  // Loops are in the order in which they began: outer ones before what is within them.
  template <typename Condition>
  PieceLoop* first_open(Condition&& holds) const {
    const auto at =
        std::find_if(open_.begin(), open_.end(), [&](const PieceLoop* loop) { return holds(*loop); });
    return at == open_.end() ? nullptr : *at;
  }

  // Once its last piece has ended, a loop may be gone.
  void take_one(PieceLoop& loop, std::unique_lock<std::mutex>& lock) {
    const int piece = loop.taken++;
    if (loop.taken == loop.count) std::erase(open_, &loop);
    lock.unlock();
    std::exception_ptr fault;
    const PieceLoop* const before = own_loop;
    own_loop = &loop;
    try {
      (*loop.work)(piece);
    } catch (...) {
      fault = std::current_exception();
    }
    own_loop = before;
    lock.lock();
    loop.faults[static_cast<std::size_t>(piece)] = std::move(fault);
    if (++loop.ended == loop.count && waiting_ > 0) changed_.notify_all();
  }

  void wait(std::unique_lock<std::mutex>& lock) {
    ++waiting_;
    changed_.wait(lock);
    --waiting_;
  }

  std::mutex mutex_;  // of all below, and of the loops
  std::condition_variable changed_;
  std::vector<PieceLoop*> open_;  // with pieces that nobody has taken
  int waiting_ = 0;
  bool ending_ = false;
  std::vector<std::thread> pool_;
};

ThreadTeam::ThreadTeam(int threads) {
  if (threads <= 1 || own_team != nullptr) return;
  shared_ = std::make_unique<Shared>(threads);
  own_team = shared_.get();
}

ThreadTeam::~ThreadTeam() {
  if (shared_ != nullptr) own_team = nullptr;
}

void run_pieces(int jobs, int count, const std::function<void(int)>& work) {
  const ThreadTeam team(count > 1 ? jobs : 1);
  if (own_team == nullptr || count <= 1) {
    for (int k = 0; k < count; ++k) work(k);
    return;
  }
  PieceLoop loop{.count = count,
                 .work = &work,
                 .around = own_loop,
                 .faults = std::vector<std::exception_ptr>(static_cast<std::size_t>(count))};
  own_team->run(loop);
  rethrow_first(loop.faults);
}

}  // namespace omnihil
