// The option with which a verb prints what emulated boards say, as they say it.
//
//   add_console_option(verb, words);                       // --console ROBOTS
//   choice.listeners.on_line = console_listener(words);
#pragma once
#include <string>

#include "hil/firmware/board_ports.h"
#include "tools/command_line.h"

namespace omnihil {

void add_console_option(Verb& verb, std::string& robots);
// Of no robots: none. Throws std::invalid_argument where the words are no list of robots.
ConsoleListener console_listener(const std::string& robots);

}  // namespace omnihil
