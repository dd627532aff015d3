// What the charts of a report draw, as JSON that can stand inside a page (no "<" in it).
//
//   std::string json = chart_data(input);
//   // {"ladder": …, "drift": …, "maps": […], "overlays": […], "spectra": […]}
//
// Bounded: overlays share a fixed number of points, residual maps and their bins are cut to the most telling
// ones; what was left out is counted in the JSON and said on the page.
#pragma once
#include <string>

#include "hil/report/report_html.h"

namespace omnihil {

std::string chart_data(const ReportInput& input);

}  // namespace omnihil
