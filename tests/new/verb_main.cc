// The verb that `./dev new verb` wrote, alone in a program.
#include <CLI/CLI.hpp>

#include "tools/command_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
VerbAdder add_verb_fresh_verb;
}

int main(int argc, char** argv) {
  CLI::App app{"a verb"};
  omnihil::VerbResult result;
  omnihil::Verb program(&app);
  omnihil::add_verb_fresh_verb(program, result);
  CLI11_PARSE(app, argc, argv);
  return result.exit_code;
}
