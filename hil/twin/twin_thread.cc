#include "hil/twin/twin_thread.h"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

namespace omnihil {
namespace {

constexpr double kTerminal_s = 0.5, kElsewhere_s = 10.0;  // between two status lines; a choice

}  // namespace

TwinThread::TwinThread(TwinFeed& feed, TwinRunner& runner, std::FILE* out)
    : feed_(feed), runner_(runner), out_(out), terminal_(out != nullptr && ::isatty(::fileno(out)) == 1) {
  thread_ = std::thread([this] { run(); });
}

TwinThread::~TwinThread() { finish(0); }

void TwinThread::leave(bool from_host, std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  Passed passed{from_host, now_ns, {bytes.begin(), bytes.end()}};
  {
    const std::lock_guard lock(mutex_);
    waiting_bytes_ += bytes.size();
    waiting_.push_back(std::move(passed));
    while (waiting_bytes_ > kMostWaiting) {
      left_out_ += waiting_.front().bytes.size();
      waiting_bytes_ -= waiting_.front().bytes.size();
      waiting_.pop_front();
    }
  }
  changed_.notify_one();
}

void TwinThread::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  leave(true, now_ns, bytes);
}
void TwinThread::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  leave(false, now_ns, bytes);
}

void TwinThread::run() {
  for (bool ending = false; !ending;) {
    std::deque<Passed> passed;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
      passed = std::exchange(waiting_, {});
      waiting_bytes_ = 0;
      ending = ending_;
    }
    watch(passed);
    print();
  }
}

void TwinThread::watch(const std::deque<Passed>& passed) {
  for (const Passed& p : passed) {
    p.from_host ? feed_.host_bytes(p.now_ns, p.bytes) : feed_.dongle_bytes(p.now_ns, p.bytes);
    now_s_ = 1e-9 * static_cast<double>(p.now_ns);
    while (const std::optional<Run> piece = feed_.next(p.now_ns)) runner_.take(*piece);
  }
}

void TwinThread::print() {
  if (out_ == nullptr || now_s_ - printed_s_ < (terminal_ ? kTerminal_s : kElsewhere_s)) return;
  printed_s_ = now_s_;
  fmt::print(out_, "{}{}{}", terminal_ ? "\r\x1b[K" : "", runner_.status_line(), terminal_ ? "" : "\n");
  std::fflush(out_);
}

void TwinThread::finish(std::int64_t end_ns) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  while (const std::optional<Run> piece = feed_.next(end_ns)) runner_.take(*piece);
  if (terminal_) fmt::print(out_, "\n");
}

}  // namespace omnihil
