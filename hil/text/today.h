// The day it is, in UTC, for what is written into a file: "2026-11-23".
//
// SOURCE_DATE_EPOCH (seconds since 1970), where it is set, is taken for the time: then a file that is made
// again is the same (reproducible-builds.org/specs/source-date-epoch).
#pragma once
#include <string>

namespace omnihil {

std::string today_utc();

}  // namespace omnihil
