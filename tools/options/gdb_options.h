// The options with which a verb lets GDB attach to its emulated boards.
//
//   add_gdb_options(verb, words);                          // --gdb, --gdb-robot, --gdb-run
//   std::unique_ptr<GdbServer> gdb = open_gdb(words, stop);        // null: not asked for
//   choice.listeners.on_board = gdb_listener(gdb.get());
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <system_error>

#include "hil/debugger/gdb_server.h"
#include "hil/firmware/image_firmware.h"
#include "tools/command_line.h"

namespace omnihil {

class GdbUnreachable : public std::system_error {
  using std::system_error::system_error;
};

struct GdbWords {
  std::string at;     // a port of this computer, or a wire's URL; empty: no debugger
  std::string robot;  // "3", "3.1": this one alone
  bool run = false;
};

void add_gdb_options(Verb& verb, GdbWords& words);
// Throws std::invalid_argument: the words; GdbUnreachable: the port cannot be had.
std::unique_ptr<GdbServer> open_gdb(const GdbWords& words, std::function<bool()> asked_to_end);
BoardListener gdb_listener(GdbServer* server);  // of null: none

}  // namespace omnihil
