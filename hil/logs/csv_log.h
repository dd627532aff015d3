// Tables of numbers as text: what loggers, spreadsheets and motor controllers write.
//
//   LogTable log = parse_csv_log("time_ms;rpm\n0;10,5\n", "run.csv", {});       // two series of one row
//
// Comma, semicolon, tab or blanks between cells, told by the first lines; with semicolons also a decimal comma. One
// header line, or none (then the names come from `columns`, or from SimpleFOC's monitor, whose columns are known by
// their number). Lines that begin with #, // or MOT: are left out and counted, like columns that hold no number. Every
// line has as many cells as the header, one empty one at the end apart. Throws BadLog with line and column.
#pragma once
#include <string_view>

#include "hil/logs/log_table.h"

namespace omnihil {

LogTable parse_csv_log(std::string_view text, const std::string& name, const LogOptions& options);

// Whether these first lines are a table of numbers at all.
bool looks_like_table(std::string_view head);

}  // namespace omnihil
