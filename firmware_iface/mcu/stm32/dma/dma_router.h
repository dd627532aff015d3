// DMA request lines of a chip, by the names of its reference manual.
//
//   const int line = router.line("USART1_TX");
//   router.set(line, true);            // stays until the transfer's access takes the reason away
//   router.pulse(line);                // one item (timers)
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace omnihil::mcu {

class DmaSink {
 public:
  virtual ~DmaSink() = default;
  virtual void requested(int line) = 0;  // while it is high; moves items until it falls or nothing is armed
};

class DmaRouter {
 public:
  int line(std::string_view name) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == name) return static_cast<int>(i);
    }
    names_.emplace_back(name);
    high_.push_back(0);
    return static_cast<int>(names_.size() - 1);
  }
  void add(DmaSink& sink) { sinks_.push_back(&sink); }
  bool high(int line) const { return high_[static_cast<std::size_t>(line)] != 0; }
  void set(int line, bool level) {
    char& high = high_[static_cast<std::size_t>(line)];
    if ((high != 0) == level) return;
    high = level ? 1 : 0;
    if (level) ask(line);
  }
  void pulse(int line) {  // the controller drops it with the first item it moves
    high_[static_cast<std::size_t>(line)] = 2;
    ask(line);
    high_[static_cast<std::size_t>(line)] = 0;
  }
  // Called by a controller that moves one item for a line.
  void taken(int line) {
    char& high = high_[static_cast<std::size_t>(line)];
    if (high == 2) high = 0;
  }

 private:
  void ask(int line) {
    for (DmaSink* sink : sinks_) sink->requested(line);
  }
  std::vector<std::string> names_;
  std::vector<char> high_;  // 0 low, 1 high, 2 one item
  std::vector<DmaSink*> sinks_;
};

}  // namespace omnihil::mcu
