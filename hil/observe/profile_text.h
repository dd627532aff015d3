// A profile for people and for other programs.
//
//   lcov_text(profile, read_lines(bytes));        // .info: lcov, genhtml, editors
//   callgrind_text(profile, lines);               // kcachegrind, callgrind_annotate
//   profile_table(profile);                       // a screen of it
//
// A line has run as often as its statement that ran most often.
#pragma once
#include <span>
#include <string>

#include "hil/observe/image_profile.h"
#include "hil/variables/debug_lines.h"

namespace omnihil {

std::string lcov_text(const ImageProfile& profile, std::span<const DebugLine> lines);
std::string callgrind_text(const ImageProfile& profile, std::span<const DebugLine> lines);
std::string profile_table(const ImageProfile& profile);

}  // namespace omnihil
