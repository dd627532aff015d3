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
  std::string file;
  bool wireshark = false;
  bool c_header = false;
  bool toml = false;
  bool dbc = false;
};

void print_list() {
  for (const RadioFormat* format : radio_formats()) {
    std::printf("%-18s %s, %zu packets\n", std::string(format->id).c_str(),
                std::string(format->title).c_str(), format->messages.size());
  }
}

int run(const Arguments& arguments) {
  if (arguments.id.empty() && arguments.file.empty()) {
    if (arguments.wireshark || arguments.c_header || arguments.toml || arguments.dbc) {
      std::fprintf(
          stderr,
          "omnihil formats: --wireshark, --c-header, --toml and --dbc need a format ID or --format FILE\n");
      return kExitBadInput;
    }
    print_list();
    return kExitOk;
  }
  const RadioFormat* format = format_or_complain(arguments.id, arguments.file);
  if (format == nullptr) return kExitBadInput;
  const std::string reason = arguments.toml ? no_toml_reason(*format) : "";
  if (!reason.empty()) {
    std::fprintf(stderr, "omnihil formats: tables alone cannot say %s: %s\n", arguments.id.c_str(),
                 reason.c_str());
    return kExitBadInput;
  }
  if (arguments.dbc && format->carrier.kind != Carrier::Kind::kCan) {
    std::fprintf(stderr, "omnihil formats: --dbc is of CAN formats; %s is none\n",
                 std::string(format->id).c_str());
    return kExitBadInput;
  }
  const std::string text = arguments.wireshark  ? emit_wireshark(*format)
                           : arguments.c_header ? emit_c_header(*format)
                           : arguments.toml     ? emit_toml(*format)
                           : arguments.dbc      ? emit_dbc(*format)
                                                : emit_markdown(*format);
  std::fputs(text.c_str(), stdout);
  return kExitOk;
}

}  // namespace

void add_verb_formats(Verb& program, VerbResult& result) {
  auto arguments = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("formats", "list the radio formats, or describe one");
  const Option id = verb.add_option("ID", arguments->id, "print the documentation of this format (Markdown)");
  verb.add_option("--format", arguments->file,
                  "the same of the format in this file (docs/radio/own-format.md)")
      .excludes(id);
  const Option wireshark =
      verb.add_flag("--wireshark", arguments->wireshark, "print a Wireshark dissector (Lua)");
  const Option c_header =
      verb.add_flag("--c-header", arguments->c_header, "print the places of all fields as C macros")
          .excludes(wireshark);
  const Option dbc =
      verb.add_flag("--dbc", arguments->dbc, "print the messages of a CAN format as a DBC file")
          .excludes(wireshark)
          .excludes(c_header);
  verb.add_flag("--toml", arguments->toml, "print its packet tables as a file that --format takes")
      .excludes(wireshark)
      .excludes(c_header)
      .excludes(dbc);
  verb.callback([arguments, &result] { result.exit_code = run(*arguments); });
}

}  // namespace omnihil
