// The outcomes of `check` as one HTML file that needs nothing else: verdicts, what was changed, plots of what
// differs, and the trend over runs where a history is kept. No script, no network; prints well.
//
//   const std::string html = check_page(outcomes, history, "omnihil 0.1.0");
//
// Names of files and everything else from outside is escaped.
#pragma once
#include <span>
#include <string>

#include "hil/check/check_history.h"
#include "hil/check/check_recording.h"

namespace omnihil {

inline constexpr std::size_t kPageCharts = 6;  // per recording: CheckOptions::charts for a page

std::string check_page(std::span<const CheckOutcome> outcomes, const CheckHistory& history,
                       const std::string& program);

}  // namespace omnihil
