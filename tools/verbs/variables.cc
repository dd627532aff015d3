// omnihil variables FILE [PATTERN]: what a firmware has by name. The work is in hil/variables/.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "hil/variables/variable_value.h"
#include "hil/variables/variable_watch.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  std::string file, pattern;
};

constexpr std::size_t kMostValues = 4096;

std::string place_text(const VariablePlace& place) {
  if (!place.constant.empty()) return "a constant";
  if (place.piece.space == MemorySpace::kState) return fmt::format("state+{}", place.piece.address);
  return fmt::format("0x{:08x}", place.piece.address);
}

void print(const std::string& name, const std::string& type, const std::string& place,
           const std::string& more) {
  fmt::print("{:<36} {:<24} {:<12} {}\n", name, type, place, more);
}

// All its single values, with what the file gives them.
void print_values(const VariableNames& names, const VariablePlace& place) {
  for (const VariablePlace& value : names.values_of(place, kMostValues)) {
    const DebugType& type = names.info().type(value.type);
    std::vector<std::uint8_t> raw = value.constant;
    if (raw.empty() && value.piece.space == MemorySpace::kImage)
      raw = names.info().initial(value.piece.address, value.piece.bytes);
    std::string more = value.bits > 0 ? fmt::format("{} bits from bit {}", value.bits, value.bit_offset)
                                      : fmt::format("{} bytes", value.piece.bytes);
    if (!raw.empty()) more += ", starts as " + text_of_value(type, value, raw);
    print(value.name, type.name, place_text(value), more);
  }
}

int run(const Arguments& a) {
  const auto info = debug_info_of(a.file);
  const std::uint64_t state_bytes = state_bytes_of(*info);
  const VariableNames names(info, {1, state_bytes});
  std::string problem;
  if (const auto place = a.pattern.empty() ? std::nullopt : names.find(a.pattern, problem)) {
    print_values(names, *place);
    return kExitOk;
  }
  std::size_t shown = 0;
  for (const DebugVariable& v : info->variables()) {
    if (v.name.find(a.pattern) == std::string::npos) continue;
    ++shown;
    const std::string type = v.type >= 0 ? info->type(v.type).name : "?";
    if (!v.why_not.empty()) {
      print(v.name, type, "-", v.why_not);
      continue;
    }
    const std::string place = v.address ? fmt::format("0x{:08x}", *v.address) : "a constant";
    print(v.name, type, place, fmt::format("{} bytes, {}", info->type(v.type).bytes, v.file));
  }
  if (const auto state = names.state_type(); state && a.pattern.empty())
    print("state", info->type(*state).name, "state+0", fmt::format("{} bytes, the state block", state_bytes));
  if (shown > 0 || a.pattern.empty()) return kExitOk;
  fmt::print(stderr, "omnihil variables: {} {}\n", a.pattern, problem);
  return kExitBadInput;
}

}  // namespace

void add_verb_variables(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb =
      program.add_subcommand("variables", "the variables of a firmware by name: types, addresses, values");
  verb.add_option("FILE", a->file, "an image (ELF) or a shared object, compiled with -g").required();
  verb.add_option(
      "PATTERN", a->pattern,
      "a variable or a part of one, such as wheel[2], whose values are listed; or a part of names");
  verb.footer("docs/variables.md says how they are watched, set and checked.");
  verb.callback([a, &result] { result.exit_code = guarded("variables", [&] { return run(*a); }); });
}

}  // namespace omnihil
