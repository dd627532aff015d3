// The one program: `omnihil VERB …`.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "tools/exit_codes.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

int main(int argc, char** argv) {
  CLI::App app{"omnihil: the test bench for the low level of an omni-directional soccer robot"};
  app.set_version_flag("--version", std::string(OMNIHIL_VERSION " (") + omnihil::program_commit() + ")");
  app.require_subcommand(1);
  app.footer(omnihil::kExitCodeHelp);
  omnihil::VerbResult result;
  for (omnihil::VerbAdder* add : omnihil::all_verbs()) add(app, result);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? omnihil::kExitOk : omnihil::kExitBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "omnihil: %s\n", error.what());
    return omnihil::kExitDiverged;
  }
  return result.exit_code;
}
