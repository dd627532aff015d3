// What a program says on a console: bytes to lines of printable text, the last of which are kept.
//
//   ConsoleText text([](const std::string& line) { … });
//   text.add("boot\r\nbatt");                     // the listener hears "boot"
//   text.lines();                                 // "boot", "batt"
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

class ConsoleText {
 public:
  static constexpr std::size_t kLines = 20, kColumns = 200;  // kept; what is longer is cut into lines

  explicit ConsoleText(std::function<void(const std::string&)> on_line = {}) : on_line_(std::move(on_line)) {}

  void add(std::string_view bytes) {
    for (const char c : bytes) {
      if (c == '\n' || open_.size() >= kColumns) close();
      if (c == '\n' || c == '\r') continue;
      open_ += (c >= ' ' && c < 127) || c == '\t' ? c : '.';
    }
  }
  std::uint64_t count() const { return count_ + (open_.empty() ? 0 : 1); }
  std::vector<std::string> lines() const {
    std::vector<std::string> all(kept_.begin(), kept_.end());
    if (!open_.empty()) all.push_back(open_);
    return all;
  }

 private:
  void close() {
    ++count_;
    if (on_line_) on_line_(open_);
    kept_.push_back(std::move(open_));
    if (kept_.size() > kLines) kept_.pop_front();
    open_.clear();
  }

  std::function<void(const std::string&)> on_line_;
  std::deque<std::string> kept_;
  std::string open_;  // the line that has not ended
  std::uint64_t count_ = 0;
};

}  // namespace omnihil
