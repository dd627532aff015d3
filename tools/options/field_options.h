// The options with which `serve` puts a field, a ball and another team on the floor.
//
//   add_field_options(verb, words);
//   understand_field(words, {}, setup, problems);
#pragma once
#include <string>
#include <vector>

#include "hil/recording/session_setup.h"
#include "hil/serve/serve.h"
#include "tools/command_line.h"

namespace omnihil {

struct FieldWords {
  std::string size, ball, opponents, opponents_robot, from;
  std::vector<std::string> robot_of;  // "3,4=ulaval_2024"
  std::vector<std::string> with_of;   // "3,4=battery_sag"
  std::vector<std::string> start;     // "3=1.5,-0.5,90"
  std::vector<std::string> fault;     // "3,4: at_s = 1.0, do = \"brown_out\", supply_ratio = 0.6"
  std::string opponents_radio;
  std::vector<std::string> patches;  // "X1,X2,Y1,Y2,SLIDING,ROLLING"
  bool ghosts = false;
  double spread = 0.0;
  double nap_deg = 0.0;
  FieldSetup floor;
};

void add_field_options(Verb& verb, FieldWords& words);

// What is wrong goes to `problems`, a line each. setup.robot_ids are known; `effects` go to every model.
void understand_field(const FieldWords& words, const std::vector<std::string>& effects, SessionSetup& setup,
                      std::vector<std::string>& problems);
std::vector<StartPose> start_poses(const FieldWords& words, const SessionSetup& setup,
                                   std::vector<std::string>& problems);

}  // namespace omnihil
