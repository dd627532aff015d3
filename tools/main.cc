// The one program: `omnihil VERB …`.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/command_line.h"
#include "tools/command_tree.h"
#include "tools/exit_codes.h"
#include "tools/manual.h"
#include "tools/misspelt.h"
#include "tools/options/bench_expansion.h"
#include "tools/program_commit.h"
#include "tools/verbs/verbs.h"

namespace {

// A fit makes and drops the samples of a record some thousand times. What the allocator hands back to the system in between is
// mapped and zeroed page by page at each of them: a tenth to a fifth of the time on a robot's record.
void keep_freed_memory() {
  constexpr int kLargestMapped =
      32 << 20;  // bytes; the most that glibc takes (mallopt(3), DEFAULT_MMAP_THRESHOLD_MAX)
  constexpr int kKept = 512 << 20;  // bytes; more than any shared recording's diagnosis has at once; a choice
  mallopt(M_MMAP_THRESHOLD, kLargestMapped);
  mallopt(M_TRIM_THRESHOLD, kKept);
}

// Not shown by --help: installations call it. It is of the program, not of a verb: it writes what all of them say.
void add_manual(CLI::App& app, omnihil::VerbResult& result) {
  auto folder = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("manual", "write manual pages and shell completion below FOLDER/share");
  verb->group("");
  verb->add_option("FOLDER", *folder, "made where it is missing")->required();
  verb->callback([&app, &result, folder] {
    try {
      omnihil::write_manual(omnihil::command_tree(app), OMNIHIL_VERSION, *folder);
    } catch (const std::system_error& error) {
      std::fprintf(stderr, "omnihil manual: %s\n", error.what());
      result.exit_code = omnihil::kExitIo;
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  CLI::App app{"omnihil: the test bench for the low level of an omni-directional soccer robot"};
  app.set_version_flag("--version", std::string(OMNIHIL_VERSION " (") + omnihil::program_commit() + ")");
  app.require_subcommand(1);
  app.footer(omnihil::kExitCodeHelp);
  omnihil::VerbResult result;
  omnihil::Verb program(&app);
  for (omnihil::VerbAdder* add : omnihil::all_verbs()) add(program, result);
  add_manual(app, result);
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (const std::string wrong = omnihil::expand_bench(arguments, app); !wrong.empty()) {
    std::fprintf(stderr, "omnihil %s:\n%s\n", arguments.front().c_str(), wrong.c_str());
    return omnihil::kExitBadInput;
  }
  try {
    std::ranges::reverse(arguments);  // as this parser takes them
    app.name(argv[0]);
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    const std::string misspelt =
        error.get_exit_code() == 0 ? "" : omnihil::misspelt_words(omnihil::command_tree(app));
    if (misspelt.empty()) return app.exit(error) == 0 ? omnihil::kExitOk : omnihil::kExitBadInput;
    std::fputs(misspelt.c_str(), stderr);
    return omnihil::kExitBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "omnihil: %s\n", error.what());
    return omnihil::kExitDiverged;
  }
  return result.exit_code;
}
