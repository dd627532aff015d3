// omnihil svd CHIP: the registers of an emulated chip by name, for debuggers. The work is in hil/debugger/svd.h.
#include "hil/debugger/svd.h"

#include <cstdio>
#include <memory>
#include <string>

#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

int run(const std::string& name) {
  const mcu::ChipSpec* spec = mcu::find_chip(name);
  if (spec != nullptr) {
    std::fputs(svd_text(*spec, mcu::chip_name(name)).c_str(), stdout);
    return kExitOk;
  }
  std::string known;
  for (const mcu::ChipSpec* chip : mcu::all_chips()) {
    known += (known.empty() ? "" : ", ") + std::string(chip->name);
    for (const std::string_view variant : chip->variants) known += ", " + std::string(variant);
  }
  std::fprintf(stderr, "omnihil svd: chip: found \"%s\", allowed: %s\n", name.c_str(), known.c_str());
  return kExitBadInput;
}

}  // namespace

void add_verb_svd(Verb& program, VerbResult& result) {
  Verb verb =
      program.add_subcommand("svd", "the registers of an emulated chip by name (CMSIS-SVD), for debuggers");
  auto chip = std::make_shared<std::string>();
  verb.add_option("CHIP", *chip, "as a board file names it, such as stm32f405").required();
  verb.footer("omnihil svd stm32f405 > stm32f405.svd; docs/debugger.md says where debuggers want it.");
  verb.callback([chip, &result] { result.exit_code = guarded("svd", [&] { return run(*chip); }); });
}

}  // namespace omnihil
