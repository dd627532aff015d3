#include "hil/acquire/acquired_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hil/text/csv_table.h"
#include "identify/record/statistics.h"
#include "sim/bench/dataset_text.h"

namespace omnihil {
namespace {

constexpr double kSettled_s = 0.3;  // five time constants of a robot's speed loop of 60 ms
constexpr double kLeastShare =
    1e-6;                            // of the largest value: a signal that stands still has no noise to state
constexpr std::size_t kEnough = 30;  // third differences: sigma to 13 % then

struct Signal {
  const char* column;
  const char* signal;
};
constexpr Signal kSignals[] = {
    {"cmd_vx", "command_vx"},
    {"cmd_vy", "command_vy"},
    {"cmd_w", "command_w"},
    {"wheel_cmd_1", "command_wheel_1"},
    {"wheel_cmd_2", "command_wheel_2"},
    {"wheel_cmd_3", "command_wheel_3"},
    {"wheel_cmd_4", "command_wheel_4"},
    {"duty_1", "duty_1"},
    {"duty_2", "duty_2"},
    {"duty_3", "duty_3"},
    {"duty_4", "duty_4"},
    {"wheel_1", "wheel_speed_1"},
    {"wheel_2", "wheel_speed_2"},
    {"wheel_3", "wheel_speed_3"},
    {"wheel_4", "wheel_speed_4"},
    {"current_1", "motor_current_1"},
    {"current_2", "motor_current_2"},
    {"current_3", "motor_current_3"},
    {"current_4", "motor_current_4"},
    {"battery", "bus_voltage"},
    {"gyro_z", "gyro_z"},
    {"vision_x", "vision_x"},
    {"vision_y", "vision_y"},
    {"vision_theta", "vision_theta"},
};

// Third differences of a column's samples while nothing new has been asked for a while.
void add_differences(const RunRows& rows, const std::vector<std::string>& drive,
                     const std::vector<double>& column, std::vector<double>& sizes) {
  std::vector<double> last(drive.size(), 0.0), kept;
  double since_s = -1e9;
  for (std::size_t k = 0; k < rows.time_s.size(); ++k) {
    for (std::size_t a = 0; a < drive.size(); ++a) {
      const double asked = (*rows.column(drive[a]))[k];
      if (!std::isfinite(asked)) continue;
      if (std::abs(asked - last[a]) > 0.02 * std::max(1.0, std::abs(last[a]))) since_s = rows.time_s[k];
      last[a] = asked;
    }
    if (!std::isfinite(column[k])) continue;
    const bool moves = std::any_of(last.begin(), last.end(), [](double v) { return v != 0.0; });
    if (!moves || rows.time_s[k] - since_s < kSettled_s) {
      kept.clear();
      continue;
    }
    kept.push_back(column[k]);
    const std::size_t n = kept.size();
    if (n >= 4) sizes.push_back(std::abs(kept[n - 1] - 3.0 * kept[n - 2] + 3.0 * kept[n - 3] - kept[n - 4]));
  }
}

}  // namespace

std::string signal_of_column(std::string_view column) {
  for (const Signal& s : kSignals) {
    if (column == s.column) return s.signal;
  }
  return "";
}

std::map<std::string, double> steady_noise(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                                           double wheel_speed_step_rad_s) {
  const std::vector<std::string> drive = drive_columns(plan.drive);
  std::map<std::string, double> noise;
  for (const Signal& s : kSignals) {
    if (std::find(drive.begin(), drive.end(), s.column) != drive.end()) continue;
    std::vector<double> sizes;
    double largest = 0.0;
    for (const AcquiredRun& one : runs) {
      const std::vector<double>* column = one.rows.column(s.column);
      if (column == nullptr) continue;
      add_differences(one.rows, drive, *column, sizes);
      for (const double v : *column) largest = std::isfinite(v) ? std::max(largest, std::abs(v)) : largest;
    }
    if (sizes.size() < kEnough) continue;
    double sigma = sigma_by_mad(std::move(sizes)) / std::sqrt(20.0);
    if (std::string_view(s.column).starts_with("wheel_"))
      sigma = std::max(sigma, wheel_speed_step_rad_s / std::sqrt(12.0));
    if (sigma > kLeastShare * largest) noise[s.column] = sigma;
  }
  return noise;
}

std::string acquired_dataset_text(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                                  const std::map<std::string, double>& noise, std::string_view radio) {
  std::string text = dataset_head(plan.title.empty() ? "acquired" : plan.title, "robot", radio);
  for (const Signal& s : kSignals) {
    const bool there = std::any_of(runs.begin(), runs.end(), [&](const AcquiredRun& one) {
      return one.rows.column(s.column) != nullptr;
    });
    if (!there) continue;
    const auto sigma = noise.find(s.column);
    text += channel_line(s.signal, s.column, 0.0,
                         sigma == noise.end() ? "" : fmt::format(", sigma = {:.3g}", sigma->second));
  }
  for (const AcquiredRun& one : runs)
    text += run_lines(one.run->name + ".csv", split_name(one.run->use), one.run->excitation);
  return text;
}

RunRows rows_from_csv(std::string_view text, const std::string& shown_name) {
  std::vector<ModelProblem> problems;
  const CsvTable header = parse_csv(text, shown_name, {"time_s"}, problems);
  if (!header.readable) throw std::invalid_argument(problems.empty() ? shown_name : problems.front().text());
  RunRows rows;
  rows.columns.assign(header.header.begin() + 1, header.header.end());
  const CsvTable table = parse_csv(text, shown_name, header.header, problems);
  if (!problems.empty()) throw std::invalid_argument(problems.front().text());
  rows.time_s = *table.columns.front();
  for (std::size_t c = 1; c < table.columns.size(); ++c) rows.values.push_back(*table.columns[c]);
  return rows;
}

}  // namespace omnihil
