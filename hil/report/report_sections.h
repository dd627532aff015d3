// The parts of a report that are text and tables, as HTML. They say everything that the charts show, so that
// a reader without charts (print, screen reader, a program built without them) misses no result.
//
//   page += ranking_section(diagnosis);      // "<section id=\"ranking\">…</section>"
#pragma once
#include <string>

#include "hil/report/report_html.h"

namespace omnihil {

std::string verdict_section(const ReportInput& input);
std::string ladder_section(const Diagnosis& diagnosis);
std::string errors_table(const Diagnosis& diagnosis);
std::string ranking_section(const Diagnosis& diagnosis);
std::string parameters_section(const Diagnosis& diagnosis);
std::string data_section(const ReportInput& input);
std::string invisible_section(const Diagnosis& diagnosis);
std::string next_section(const Diagnosis& diagnosis);
std::string unknown_section(const Diagnosis& diagnosis);

}  // namespace omnihil
