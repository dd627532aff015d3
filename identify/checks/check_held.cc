// Sensors that are slower than the rows they were logged in.
//
// A reading that stands in the rows until the next one is taken for as many measurements: of a motion that stops and
// jumps. Sound data have it empty there. The speed of a motor with Hall sensors is not looked at: a window of theirs
// that is held is known by its repeats (counted_speed.h).
#include <fmt/format.h>

#include "identify/checks/check_list.h"
#include "identify/record/held_readings.h"
#include "identify/record/rig.h"
#include "identify/record/signal_list.h"

namespace omnihil {

double rows_held_of(const CheckContext& data, const std::string& signal) {
  std::vector<const std::vector<double>*> runs;
  for (const RunView& view : data.runs) {
    const std::vector<double>* values = view.run->signal(signal);
    if (values != nullptr && !view.run->steady) runs.push_back(values);
  }
  return rows_held(runs);
}

void check_held(const CheckContext& data, std::vector<DataFinding>& findings) {
  const bool has_halls = nominal_value(data.nominal, "motor.pole_pairs").value_or(0.0) > 0.0;
  for (const Channel& channel : data.dataset.channels) {
    const SignalRow* row = find_signal(*data.dataset.rig, channel.signal);
    if (row == nullptr || channel.imposed || (channel.signal == "velocity" && has_halls)) continue;
    if (row->role != SignalRole::kMotion && row->role != SignalRole::kCounts &&
        !channel.signal.starts_with("motor_current"))
      continue;
    const double rows = rows_held_of(data, channel.signal);
    if (!(rows > 0.0)) continue;
    findings.push_back(
        {DataFinding::Grade::kDoubt, "held_readings", "", channel.signal, rows,
         fmt::format("{} is new in one row of {:g} only and repeats its reading in the others: the repeats "
                     "are no measurements; leave their cells empty (omnihil import does)",
                     channel.signal, rows)});
  }
}

}  // namespace omnihil
