// The checks of data quality: each looks for one kind of fault and reports it in a sentence.
//
//   void check_clock(const CheckContext& data, std::vector<DataFinding>& findings);
//
// A check is one function in a file check_NAME.cc; kChecks in check_data.cc lists them. Grades: a fault is
// something that would be taken for physics; a doubt may be; a note is worth knowing. On sound data, with or
// without effects hidden in them, no check reports a fault.
//
// Thresholds. "tuned" at a threshold of a check means: set so that the sound simulated records of
// tests/identify/checks/check_data_test.cc (every drive, every hidden effect) and the published recordings of
// docs/measurements.md bring no fault, and that each spoilt record of the same test is named. How far one may
// move before that fails was measured for none of them, nor was a rate of false alarms beyond those records.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "identify/checks/check_data.h"
#include "identify/record/statistics.h"

namespace omnihil {

// One drive in one run: its input and its sensors' signals, n samples each. Null: not measured.
struct DriveView {
  std::string suffix;      // "": an axis; "_1", "_2" …: a robot's wheels
  std::string drive_name;  // "duty_1", "motor_torque"; empty: not driven by a signal of its own
  const std::vector<double>* drive = nullptr;
  std::string position_name;  // "encoder_1", "position"
  const std::vector<double>* position = nullptr;
  double rad_per_position = 1.0;  // to rad (m) of the output shaft
  double quantum = 0.0;  // of the position, in its own unit: counts, or the step that it shows; 0: none
  const std::vector<double>* velocity = nullptr;  // of the output
  const std::vector<double>* current = nullptr;
};

struct RunView {
  const Run* run = nullptr;
  double period_s = 0.0;  // median
  std::vector<DriveView> drives;
};

struct CheckContext {
  const Dataset& dataset;
  const Candidate& nominal;
  std::vector<RunView> runs;
  std::map<std::string, double> rows_held;  // of signals that repeat their readings: rows that each stands in
};

CheckContext check_context(const Dataset& dataset, const Candidate& nominal);

using CheckFunction = void (*)(const CheckContext&, std::vector<DataFinding>&);

void check_clock(const CheckContext&, std::vector<DataFinding>&);
void check_length(const CheckContext&, std::vector<DataFinding>&);
void check_constant(const CheckContext&, std::vector<DataFinding>&);
void check_held(const CheckContext&, std::vector<DataFinding>&);
void check_glitches(const CheckContext&, std::vector<DataFinding>&);
void check_counter(const CheckContext&, std::vector<DataFinding>&);
void check_standing_counts(const CheckContext&, std::vector<DataFinding>&);
void check_position_against_speed(const CheckContext&, std::vector<DataFinding>&);
void check_electrics(const CheckContext&, std::vector<DataFinding>&);
void check_direction(const CheckContext&, std::vector<DataFinding>&);
void check_supply(const CheckContext&, std::vector<DataFinding>&);
void check_command(const CheckContext&, std::vector<DataFinding>&);
void check_stall(const CheckContext&, std::vector<DataFinding>&);
void check_closed_loop(const CheckContext&, std::vector<DataFinding>&);
void check_duplicates(const CheckContext&, std::vector<DataFinding>&);
void check_flags(const CheckContext&, std::vector<DataFinding>&);
void check_silent(const CheckContext&, std::vector<DataFinding>&);
void check_splits(const CheckContext&, std::vector<DataFinding>&);

// Of all runs that are series (held_readings.h).
std::map<std::string, double> rows_held_in(const Dataset& dataset, const Candidate& nominal);

// Helpers of the checks. Order statistics as in identify/record/statistics.h (QuantileRank::kNearest).
double median_of(std::vector<double> values);                  // NaN left out; 0 of none
double quantile_of(std::vector<double> values, double share);  // likewise
std::optional<double> nominal_value(const Candidate& nominal, std::string_view path);
double tolerance_of(const Candidate& nominal, std::string_view path);  // relative; 0: known exactly

// Voltage at the bridge in V, one per row of the run; empty where the drive is not by duty or voltage.
std::vector<double> asked_voltage(const CheckContext& data, const RunView& view, const DriveView& drive);

// Means over windows of `window_s` of drive voltage (or whatever `drive` holds), rotor speed and current.
// A window with gaps or missing samples is left out.
struct WindowMeans {                          // each vector: one value per window
  std::vector<double> drive, speed, current;  // input's unit; output, rad/s or m/s; A, NaN: not measured
  std::vector<double> time_s;                 // of the window's beginning
};
WindowMeans window_means(const RunView& view, const DriveView& drive, const std::vector<double>& input,
                         double window_s);

// Least squares y = sum_j c_j x_j: m coefficients with standard errors (in y's unit over x_j's), and the
// share of y's squares explained. x: m columns of n samples each; y: n samples.
struct LineFit {
  std::vector<double> coefficient, sigma;
  double explained = 0.0;
  std::size_t samples = 0;
};
LineFit fit_line(const std::vector<std::vector<double>>& x, const std::vector<double>& y);

}  // namespace omnihil
