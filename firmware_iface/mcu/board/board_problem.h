// What is wrong with a board file: place, key, value as written, and what is allowed.
#pragma once
#include <string>
#include <vector>

namespace omnihil::mcu {

// The radio formats that there are and the one that the bench serves; nothing: not looked at.
struct ServedRadio {
  std::vector<std::string> known = {};
  std::string served = {};
};

struct BoardProblem {
  std::string file;
  unsigned line = 0;
  std::string key;    // "motor[2].pwm"
  std::string value;  // as written; empty where something is missing
  std::string what;
  std::string allowed;
  std::string text() const;
};

}  // namespace omnihil::mcu
