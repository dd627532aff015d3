// A map of validity as a picture inside a page: where data were, and how large the error is in each cell.
//
//   std::string svg = validity_picture(map);            // SVG, coloured by the page's style (web/report/report.css)
//
// A number is the error of runs that were not fitted to, in per cent of the signal's spread; a darker cell is worse.
// A dashed frame: fit runs alone were there. A dot: too few samples to say. Nothing: no data.
#pragma once
#include <string>

#include "identify/compare/validity_map.h"

namespace omnihil {

std::string validity_picture(const ValidityMap& map);

// "64 % of the cells between the axes' limits have data, 51 % were tested on runs that were not fitted to; worst …"
std::string validity_sentence(const ValidityMap& map);

}  // namespace omnihil
