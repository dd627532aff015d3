// Reads the columns one asks for out of a CSV file, fast, and says everything that is wrong with them.
//
//   CsvTable t = read_csv("bench/steps.csv", {"time_s", "duty"}, problems);
//   t.columns[1];            // values, NaN where the cell is empty; no value when the file has no such column
//
// One header line, comma between cells, a point as decimal mark, LF or CRLF; a byte order mark, blanks around
// a cell and quotes are allowed. Columns nobody asks for may hold anything. A cell must be a finite number or
// empty; rows have as many cells as the header. Empty lines are left out and counted.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/model/model_file.h"

namespace omnihil {

struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::optional<std::vector<double>>> columns;  // in the order of `wanted`
  std::vector<std::uint32_t> line;                          // of each row, counted from 1
  std::size_t empty_lines = 0;                              // between rows
  bool readable = false;                                    // false: problems were added
};

CsvTable read_csv(const std::string& path, const std::vector<std::string>& wanted,
                  std::vector<ModelProblem>& problems);

// The same from a text; `shown_name` is for messages.
CsvTable parse_csv(std::string_view text, const std::string& shown_name,
                   const std::vector<std::string>& wanted, std::vector<ModelProblem>& problems);

}  // namespace omnihil
