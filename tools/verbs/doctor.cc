// omnihil doctor: what of this computer the bench can use, and what mends the rest.
#include "hil/doctor/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct DoctorWords {
  bool json = false, strict = false;
};

int run_doctor(const DoctorWords& words) {
  const std::vector<Finding> findings = examine({});
  fmt::print("{}", words.json ? findings_json(findings) : findings_text(findings));
  const bool missing =
      std::ranges::any_of(findings, [](const Finding& f) { return f.state == FindingState::kMissing; });
  return words.strict && missing ? kExitDiffers : kExitOk;
}

}  // namespace

void add_verb_doctor(Verb& program, VerbResult& result) {
  auto words = std::make_shared<DoctorWords>();
  Verb verb =
      program.add_subcommand("doctor", "what of this computer the bench can use, and what mends the rest");
  verb.add_flag("--json", words->json, "as JSON");
  verb.add_flag("--strict", words->strict, "exit code 1 when something is missing");
  verb.footer(
      "ok; limited: works, but not all of it; missing. Each with what was seen, and the command that mends "
      "it.\n"
      "Nothing is changed, and no rights are needed.");
  verb.callback(
      [words, &result] { result.exit_code = guarded("doctor", [&] { return run_doctor(*words); }); });
}

}  // namespace omnihil
