// CSV files of a measurement.
#include <cmath>

#include "hil/text/csv_table.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  std::vector<ModelProblem> problems;
  const CsvTable table =
      parse_csv(text_of(bytes), "fuzz.csv", {"time_s", "duty_ratio", "omega_rad_s"}, problems);
  demand(table.readable == problems.empty(), "a table or a problem");
  for (const ModelProblem& problem : problems) demand(!problem.text().empty(), "a problem has words");
  if (!table.readable) return;
  demand(table.columns.size() == 3, "a place for each column asked for");
  for (const auto& column : table.columns) {
    if (!column) continue;
    demand(column->size() == table.line.size(), "a value for each row");
    for (const double value : *column) demand(!std::isinf(value), "a number or nothing");
  }
}
