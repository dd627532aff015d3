// The options with which a verb hears SSL-Vision beside a radio.
//
//   add_vision_options(verb, words);
//   std::optional<UdpPort> vision = open_vision(words);      // none: not asked for; throws what is wrong
#pragma once
#include <optional>
#include <string>

#include "hil/league/udp_port.h"
#include "tools/command_line.h"

namespace omnihil {

struct VisionWords {
  std::string group;  // GROUP:PORT or "on"; empty: none
  std::string interface = "0.0.0.0";
};

void add_vision_options(Verb& verb, VisionWords& words);
std::optional<UdpPort> open_vision(const VisionWords& words);

}  // namespace omnihil
