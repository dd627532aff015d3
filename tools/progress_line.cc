#include "tools/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace omnihil {
namespace {

constexpr std::chrono::milliseconds kBetween{200};
constexpr double kFirstEstimate = 0.05;  // share of the work before which no time is named

}  // namespace

ProgressLine::ProgressLine(bool as_lines)
    : start_(std::chrono::steady_clock::now()),
      shown_(start_ - kBetween),
      terminal_(::isatty(STDERR_FILENO) == 1),
      as_lines_(as_lines) {}

ProgressLine::~ProgressLine() { clear(); }

double ProgressLine::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressLine::show(const std::string& doing, double share) {
  if (as_lines_) {
    if (doing == last_) return;
    last_ = doing;
    std::fprintf(stderr, "%s\n",
                 fmt::format("{:7.1f} s  {:3.0f} %  {}", elapsed_s(), 100.0 * share, doing).c_str());
    std::fflush(stderr);
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || now - shown_ < kBetween) return;
  shown_ = now;
  std::string text = fmt::format("{:3.0f} %  {}", 100.0 * share, doing);
  if (share > kFirstEstimate && share < 1.0) {
    text += fmt::format(", about {:.0f} s left", elapsed_s() * (1.0 - share) / share);
  }
  std::fprintf(stderr, "\r\x1b[K%s", text.c_str());
  std::fflush(stderr);
  written_ = true;
}

void ProgressLine::clear() {
  if (!written_) return;
  std::fprintf(stderr, "\r\x1b[K");
  std::fflush(stderr);
  written_ = false;
}

}  // namespace omnihil
