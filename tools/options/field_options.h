// The options with which `serve` puts a field, a ball and another team on the floor.
//
//   add_field_options(verb, words);
//   understand_field(words, setup, problems);
#pragma once
#include <string>
#include <vector>

#include "hil/recording/session_setup.h"
#include "tools/command_line.h"

namespace omnihil {

struct FieldWords {
  std::string size, ball, opponents;
  bool ghosts = false;
  double spread = 0.0;
};

void add_field_options(Verb& verb, FieldWords& words);

// What is wrong goes to `problems`, a line each.
void understand_field(const FieldWords& words, SessionSetup& setup, std::vector<std::string>& problems);

}  // namespace omnihil
