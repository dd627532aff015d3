// The option with which a verb prints what emulated boards say, as they say it, and gives them what is typed.
//
//   add_console_option(verb, words);                       // --console ROBOTS
//   choice.listeners.on_line = console_listener(words);
//   choice.listeners.typed = console_input(words);         // of verbs that run beside somebody
#pragma once
#include <string>

#include "hil/firmware/board_ports.h"
#include "tools/command_line.h"

namespace omnihil {

void add_console_option(Verb& verb, std::string& robots);
// Of no robots: none. Throws std::invalid_argument where the words are no list of robots.
ConsoleListener console_listener(const std::string& robots);
// What comes in by the standard input, to every console of these robots; a terminal's only while it is ours to read.
ConsoleInput console_input(const std::string& robots);

}  // namespace omnihil
