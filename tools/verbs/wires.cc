// omnihil wires: the wires that --device, --firmware and --bus-port take, and their parameters.
#include <fmt/format.h>

#include <string>

#include "hil/wire/open_wire.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

void print_list() {
  for (const WireKind* kind : wire_kinds()) {
    fmt::print("{:<22}{} ({})\n", kind->example, kind->says,
               kind->open_bytes != nullptr ? "bytes" : "frames");
    for (const WireParameter& parameter : kind->parameters) {
      fmt::print("  ?{:<19}{}: {}; usually {}\n", fmt::format("{}=", parameter.name), parameter.says,
                 parameter.allowed(), parameter.usual);
    }
  }
}

}  // namespace

void add_verb_wires(Verb& program, VerbResult& result) {
  Verb verb = program.add_subcommand("wires", "list the wires that --device, --firmware and --bus-port take");
  verb.footer("A wire is named scheme:address?parameter=value&parameter=value.");
  verb.callback([&result] {
    print_list();
    result.exit_code = kExitOk;
  });
}

}  // namespace omnihil
