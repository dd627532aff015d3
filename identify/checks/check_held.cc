// Sensors that are slower than the rows they were logged in.
//
// A reading that stands in the rows until the next one is taken for as many measurements: of a motion that stops and
// jumps. Sound data have it empty there.
#include <fmt/format.h>

#include "identify/checks/check_list.h"
#include "identify/record/held_readings.h"
#include "identify/record/rig.h"
#include "identify/record/signal_list.h"

namespace omnihil {

std::map<std::string, double> rows_held_in(const Dataset& dataset, const Candidate& nominal) {
  const bool has_halls = nominal_value(nominal, "motor.pole_pairs").value_or(0.0) > 0.0;
  std::map<std::string, double> out;
  for (const Channel& channel : dataset.channels) {
    const SignalRow* row = find_signal(*dataset.rig, channel.signal);
    if (row == nullptr || !may_be_held(*row, channel.imposed, has_halls)) continue;
    std::vector<const std::vector<double>*> runs;
    for (const Run& run : dataset.runs) {
      const std::vector<double>* values = run.signal(channel.signal);
      if (values != nullptr && !run.steady) runs.push_back(values);
    }
    if (const double rows = rows_held(runs); rows > 0.0) out[channel.signal] = rows;
  }
  return out;
}

void check_held(const CheckContext& data, std::vector<DataFinding>& findings) {
  for (const auto& [signal, rows] : data.rows_held) {
    findings.push_back(
        {DataFinding::Grade::kDoubt, "held_readings", "", signal, rows,
         fmt::format("{} is new in one row of {:g} only and repeats its reading in the others: the repeats "
                     "are no measurements; leave their cells empty (omnihil import does)",
                     signal, rows)});
  }
}

}  // namespace omnihil
