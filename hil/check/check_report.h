// What `check` says of its outcomes: text for people, JUnit XML and JSON for CI, Markdown for a step summary.
//
//   std::cout << check_text(outcome, true);
//   const std::string xml = check_junit(outcomes);
#pragma once
#include <span>
#include <string>

#include "hil/check/check_recording.h"

namespace omnihil {

// The whole of one recording, its verdict last: "agrees", "differs    first at …" or what went wrong.
std::string check_text(const CheckOutcome& outcome, bool table);
// A line: "ok    drive.omnirec  8.000 s, 51 200 values" or "FAIL  …" with the first difference.
std::string check_line(const CheckOutcome& outcome);
// "12 recordings, 1 differs, 0 without a verdict"
std::string check_summary(std::span<const CheckOutcome> outcomes);

std::string check_junit(std::span<const CheckOutcome> outcomes);
// One object: program, recordings with verdict, changes, first difference, signals with their largest difference.
std::string check_json(std::span<const CheckOutcome> outcomes, const std::string& program);
std::string check_markdown(std::span<const CheckOutcome> outcomes);

}  // namespace omnihil
