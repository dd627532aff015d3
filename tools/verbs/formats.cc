// omnihil formats [ID]: lists the radio formats; documentation, dissector or C header of one.
#include <cstdio>
#include <string>

#include "protocols/emit/emit.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/format_argument.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string id;
  bool wireshark = false;
  bool c_header = false;
};

void print_list() {
  for (const RadioFormat* format : radio_formats()) {
    std::printf("%-18s %s, %zu packets\n", std::string(format->id).c_str(),
                std::string(format->title).c_str(), format->messages.size());
  }
}

int run(const Arguments& arguments) {
  if (arguments.id.empty()) {
    if (arguments.wireshark || arguments.c_header) {
      std::fprintf(stderr, "omnihil formats: --wireshark and --c-header need a format ID\n");
      return kExitBadInput;
    }
    print_list();
    return kExitOk;
  }
  const RadioFormat* format = format_or_complain(arguments.id);
  if (format == nullptr) return kExitBadInput;
  const std::string text = arguments.wireshark  ? emit_wireshark(*format)
                           : arguments.c_header ? emit_c_header(*format)
                                                : emit_markdown(*format);
  std::fputs(text.c_str(), stdout);
  return kExitOk;
}

}  // namespace

void add_verb_formats(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("formats", "list the radio formats, or describe one");
  verb.add_option("ID", arguments->id, "print the documentation of this format (Markdown)");
  const Option wireshark =
      verb.add_flag("--wireshark", arguments->wireshark, "print a Wireshark dissector (Lua)");
  verb.add_flag("--c-header", arguments->c_header, "print the places of all fields as C macros")
      .excludes(wireshark);
  verb.callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace omnihil
