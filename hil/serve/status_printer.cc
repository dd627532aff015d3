#include "hil/serve/status_printer.h"

#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>

namespace omnihil {
namespace {

// Columns of the terminal, one left free: a full line would wrap on some of them.
std::size_t columns(std::FILE* out) {
  winsize size{};
  if (::ioctl(::fileno(out), TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return 79;
  return size.ws_col - 1u;
}

}  // namespace

StatusPrinter::StatusPrinter(std::FILE* out) : out_(out), terminal_(::isatty(::fileno(out)) == 1) {
  // Signals are for the loop's thread: they end its sleep.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::thread([this] { run(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void StatusPrinter::post(const ServeStatus& status) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  status_ = status;
  fresh_ = true;
}

void StatusPrinter::run() {
  const auto interval = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10'000);
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, interval, [this] { return stopping_; })) {
    if (!fresh_) continue;
    fresh_ = false;
    const ServeStatus status = status_;
    lock.unlock();
    print(status);
    lock.lock();
  }
}

void StatusPrinter::print(const ServeStatus& status) {
  if (terminal_) {
    std::fprintf(out_, "\r%s\033[K", status_line(status, columns(out_)).c_str());
    line_open_ = true;
  } else {
    std::fprintf(out_, "%s\n", status_line(status, 0).c_str());
  }
  std::fflush(out_);
}

void StatusPrinter::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (line_open_) std::fputc('\n', out_);
  line_open_ = false;
}

}  // namespace omnihil
