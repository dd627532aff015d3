// Console lines in a report that machines read: [{"at_s": 0.12, "robot": 1, "board": 0, "port": "USART2", "text": "ready"}].
#pragma once
#include <nlohmann/json.hpp>
#include <span>

#include "hil/loop/console_line.h"

namespace omnihil {

inline nlohmann::ordered_json console_json(std::span<const ConsoleLine> lines) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ConsoleLine& line : lines) {
    all.push_back({{"at_s", static_cast<double>(line.at_ns) * 1e-9},
                   {"robot", line.robot_id},
                   {"board", line.board},
                   {"port", line.port},
                   {"text", line.text}});
  }
  return all;
}

}  // namespace omnihil
