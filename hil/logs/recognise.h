// What the columns of a log mean: signals of a dataset, with their units; or why that is not sure.
//
//   std::vector<std::string> faults;
//   const std::vector<ColumnMap> asked = {parse_map("speed=velocity:rpm", faults)};
//   LogMeaning m = recognise(log, {.rig = &rig_axis()}, asked);
//   for (const std::string& d : m.doubts) std::puts(d.c_str());     // a line each, with the flags to give
//
// In this order: what the user says; what the format's own documents say (ODrive, moteus, VESC, SimpleFOC); names that
// are usual, with the unit that stands in the name. Without a unit a column is in doubt, but for a duty within +-1,
// volts, a time whose steps are between 10 us and 0.5 s, and counts. Two columns for one signal are in doubt as well.
// Nothing is guessed beyond that.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hil/logs/log_table.h"
#include "hil/logs/units.h"
#include "identify/record/dataset.h"

namespace omnihil {

// --map COLUMN=SIGNAL:UNIT; COLUMN=- leaves the column out.
struct ColumnMap {
  std::string column, signal, unit;
};
ColumnMap parse_map(std::string_view text, std::vector<std::string>& faults);

struct ColumnMeaning {
  std::size_t series = 0;  // of the log
  std::string signal;      // empty: left out
  std::string unit;        // of the values as logged
  UnitScale scale;
  bool imposed = false;  // role = "imposed"
  std::string because;   // "ODrive's documents", "its name", "--map"; of what is left out the reason
};

struct LogMeaning {
  std::vector<ColumnMeaning> columns;  // one a series, in their order
  std::vector<std::string> doubts;     // choices to be made; nothing may be written with any
  const ColumnMeaning* of(std::string_view signal) const;
};

struct MeaningContext {
  const Rig* rig = &rig_axis();
  bool linear = false;
  double pole_pairs = 0.0;  // of the model; 0: not known
  double period_s = 0.0;    // of rows without a time column; 0: none was given
  bool si = false;          // columns whose unit is not said are in the signal's own
  // Signals that the bench set: a motor_current among them drives the model.
  std::vector<std::string> imposed{};
};

LogMeaning recognise(const LogTable& log, const MeaningContext& context, const std::vector<ColumnMap>& asked);

}  // namespace omnihil
