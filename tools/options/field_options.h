// The options with which `serve` puts a field, a ball and another team on the floor.
//
//   add_field_options(verb, words);
//   understand_field(words, {}, setup, problems);
#pragma once
#include <string>
#include <vector>

#include "hil/recording/session_setup.h"
#include "tools/command_line.h"

namespace omnihil {

struct FieldWords {
  std::string size, ball, opponents, opponents_robot, from;
  std::vector<std::string> robot_of;  // "3,4=ulaval_2024"
  std::vector<std::string> patches;   // "X1,X2,Y1,Y2,SLIDING,ROLLING"
  bool ghosts = false;
  double spread = 0.0;
  double nap_deg = 0.0;
  FieldSetup floor;
};

void add_field_options(Verb& verb, FieldWords& words);

// What is wrong goes to `problems`, a line each. setup.robot_ids are known; `effects` go to every model.
void understand_field(const FieldWords& words, const std::vector<std::string>& effects, SessionSetup& setup,
                      std::vector<std::string>& problems);

}  // namespace omnihil
