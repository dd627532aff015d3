// The options with which `serve` loses, delays, repeats and damages packets on the air.
//
//   add_air_options(verb, words);
//   understand_air(words, air, problems);
#pragma once
#include <string>
#include <vector>

#include "hil/loop/air_options.h"
#include "tools/command_line.h"

namespace omnihil {

struct AirWords {
  double loss_percent = 0.0, others_load = 0.0, duplicates_percent = 0.0, bit_errors = 0.0;
  std::string transmitter, burst, latency, reorder;
  bool in_order = false;
};

void add_air_options(Verb& verb, AirWords& words);

// Per cent and lists, as a user says them, to the air's numbers. What is wrong goes to `problems`, a line each.
void understand_air(const AirWords& words, AirOptions& air, std::vector<std::string>& problems);

}  // namespace omnihil
