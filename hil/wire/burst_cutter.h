// Bytes of a UART into bursts: a burst ends where a poll brings no more bytes, or where it is as long as a
// frame.
//
//   if (cutter.poll([&](std::vector<std::uint8_t>& to, std::size_t limit) { … }, line, frame)) …
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

class BurstCutter {
 public:
  // `append(to, limit)` appends what has arrived, `limit` bytes at most.
  template <class Append>
  bool poll(Append&& append, std::uint32_t line, BusFrame& frame) {
    const std::size_t before = burst_.size();
    append(burst_, BusFrame::kCapacity - before);
    const bool idle = burst_.size() == before;
    if (burst_.empty() || (!idle && burst_.size() < BusFrame::kCapacity)) return false;
    frame = BusFrame{};
    frame.id = line;
    frame.size = static_cast<std::uint8_t>(burst_.size());
    std::copy(burst_.begin(), burst_.end(), frame.data.begin());
    burst_.clear();
    return true;
  }
  void clear() { burst_.clear(); }

 private:
  std::vector<std::uint8_t> burst_;
};

}  // namespace omnihil
