// What a board file is read against: the radio formats that there are, and the dialects that it may name.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace omnihil::mcu {

// The radio formats that there are and the one that the bench serves; nothing: not looked at.
struct ServedRadio {
  std::vector<std::string> known = {};
  std::string served = {};
};

// The file of a dialect of [wheel_commands], by the name or path that a board file has.
struct DialectFile {
  std::string path = {}, text = {};
  std::string error = {};    // why there is none; empty: there is one
  std::string allowed = {};  // what there is
};
using FindDialect = std::function<DialectFile(const std::string& name)>;

struct BoardContext {
  ServedRadio radio = {};
  FindDialect find_dialect = {};  // none: there are no dialects
};

}  // namespace omnihil::mcu
