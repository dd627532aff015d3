#include "tools/options/variable_options.h"

namespace omnihil {

void add_variable_options(Verb& verb, std::vector<std::string>& watch, std::vector<std::string>& set) {
  verb.add_option(
      "--watch", watch,
      "a variable of the firmware by name, such as wheel[2].integral (docs/variables.md), read after "
      "every control tick; several allowed");
  verb.add_option(
      "--set", set,
      "NAME=VALUE: a variable of the firmware is given this value when its start-up code is through; "
      "several allowed");
}

}  // namespace omnihil
