// What is wrong with a board file: place, key, value as written, and what is allowed.
#pragma once
#include <string>

namespace omnihil::mcu {

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
