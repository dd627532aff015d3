// The chosen series of a log on one clock.
//
//   LogRows rows = log_rows(log, meaning, {.rig = &rig_axis()}, "run.csv");
//   rows.time_s[i];  rows.columns[k][i];               // of meaning.columns that are signals, time apart, in their order
//
// How topics come on one clock: log_dataset.h.
#pragma once
#include <string>
#include <vector>

#include "hil/logs/recognise.h"

namespace omnihil {

struct LogRows {
  std::vector<double> time_s;  // from 0 on, increasing
  std::vector<const ColumnMeaning*> meaning;
  std::vector<std::vector<double>> columns;  // as logged; NaN: missing
  std::vector<std::string> notes;
};

LogRows log_rows(const LogTable& log, const LogMeaning& meaning, const MeaningContext& context,
                 const std::string& name);

}  // namespace omnihil
