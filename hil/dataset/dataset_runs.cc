#include "hil/dataset/dataset_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "hil/dataset/dataset_notes.h"
#include "hil/text/csv_table.h"
#include "hil/text/toml_keys.h"
#include "identify/record/rig.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

std::size_t measured_count(const std::vector<double>& values) {
  return values.size() - static_cast<std::size_t>(std::count_if(values.begin(), values.end(),
                                                                [](double v) { return std::isnan(v); }));
}

class RunsReader {
 public:
  RunsReader(const DatasetPlan& plan, const std::string& folder, const std::string& toml_name,
             Dataset& dataset, std::vector<ModelProblem>& problems)
      : plan_(plan), folder_(folder), toml_name_(toml_name), dataset_(dataset), problems_(problems) {
    for (const Channel& channel : dataset.channels) {
      if (std::find(wanted_.begin(), wanted_.end(), channel.column) == wanted_.end())
        wanted_.push_back(channel.column);
    }
    found_.assign(wanted_.size(), false);
  }

  void read() {
    bool all_read = true;
    for (const RunPlan& run : plan_.runs) all_read = read_run(run) && all_read;
    if (all_read) report_missing_columns();
    const std::vector<std::string> lines = notes_.lines(plan_.runs.size());
    dataset_.notes.insert(dataset_.notes.end(), lines.begin(), lines.end());
  }

 private:
  void wrong(const std::string& file, std::size_t line, std::string key, std::string value, std::string what,
             std::string allowed) {
    problems_.push_back({.file = file,
                         .line = static_cast<int>(line),
                         .column = line > 0 ? 1 : 0,
                         .key = std::move(key),
                         .value = std::move(value),
                         .what = std::move(what),
                         .allowed = std::move(allowed)});
  }

  bool read_run(const RunPlan& plan) {
    const std::string path = (std::filesystem::path(folder_) / plan.run.file).lexically_normal().string();
    CsvTable table = read_csv(path, wanted_, problems_);
    if (header_.empty()) header_ = table.header;
    for (std::size_t w = 0; w < table.columns.size(); ++w) {
      if (table.columns[w]) found_[w] = true;
    }
    if (!table.readable) return false;
    Run run = plan.run;
    for (const KnownNumber& known : plan.known) run.known.emplace_back(known.path, known.value);
    if (table.empty_lines > 0) {
      notes_.add(fmt::format("{} empty lines between rows left out", table.empty_lines), run.file);
    }
    for (const Channel& channel : dataset_.channels) take_channel(channel, table, path, run);
    check_time(table, path, run);
    check_drive(plan, run);
    dataset_.runs.push_back(std::move(run));
    return true;
  }

  void take_channel(const Channel& channel, const CsvTable& table, const std::string& path, Run& run) {
    const auto at =
        static_cast<std::size_t>(std::find(wanted_.begin(), wanted_.end(), channel.column) - wanted_.begin());
    const auto& column = table.columns[at];
    if (!column) {
      if (channel.signal == "time") {
        const std::vector<std::string_view> names(table.header.begin(), table.header.end());
        wrong(path, 1, channel.column, "", "the time's column is not in this file",
              spelling_hint(channel.column, names));
        return;
      }
      const std::vector<std::string_view> names(table.header.begin(), table.header.end());
      const std::string_view near = nearest_spelling(channel.column, names);
      const bool taken = std::find(wanted_.begin(), wanted_.end(), near) != wanted_.end();
      notes_.add(fmt::format("{}: no column \"{}\"{}: taken as not measured", channel.signal, channel.column,
                             near.empty() || taken ? "" : fmt::format(" (but \"{}\")", near)),
                 run.file);
      return;
    }
    std::vector<double> values = *column;
    for (double& value : values) value = value * channel.scale + channel.offset;
    if (channel.signal == "time") {
      run.time_s = std::move(values);
      return;
    }
    const std::size_t measured = measured_count(values);
    if (measured == 0) {
      notes_.add(fmt::format("{}: column \"{}\" is empty throughout: taken as not measured", channel.signal,
                             channel.column),
                 run.file);
      return;
    }
    note_values(channel, values, measured, table, path, run);
    run.signals[channel.signal] = std::move(values);
  }

  void note_values(const Channel& channel, const std::vector<double>& values, std::size_t measured,
                   const CsvTable& table, const std::string& path, const Run& run) {
    const SignalRow* row = find_signal(*dataset_.rig, channel.signal);
    if (row->role == SignalRole::kFlag) {
      const auto bad = std::find_if(values.begin(), values.end(),
                                    [](double v) { return !std::isnan(v) && v != 0.0 && v != 1.0; });
      if (bad != values.end()) {
        wrong(path, table.line[static_cast<std::size_t>(bad - values.begin())], channel.column,
              fmt::format("{:g}", *bad), fmt::format("{} is a flag", channel.signal), "allowed: 0, 1");
      }
    }
    const bool event = channel.signal.starts_with("command_");  // holds until the next
    if (row->role == SignalRole::kDrive && !event && measured < values.size()) {
      notes_.add(fmt::format("{}: {} of {} cells are empty: no drive is known there", channel.signal,
                             values.size() - measured, values.size()),
                 run.file);
    }
    if (row->drive_group != "duty") return;
    std::size_t beyond = 0;
    double largest = 0.0;
    for (const double v : values) {
      if (std::abs(v) > 1.0) ++beyond, largest = std::max(largest, std::abs(v));
    }
    if (beyond > 0) {
      notes_.add(fmt::format("{}: {} of {} values ask for more than full duty, up to {:g}; taken as asked",
                             channel.signal, beyond, values.size(), largest),
                 run.file);
    }
  }

  void check_time(const CsvTable& table, const std::string& path, const Run& run) {
    const Channel* time = dataset_.channel("time");
    if (time == nullptr || run.time_s.empty()) return;
    std::size_t faults = 0;
    double last = -INFINITY;
    for (std::size_t i = 0; i < run.time_s.size(); ++i) {
      const double t = run.time_s[i];
      const bool good = t > last;  // false for an empty cell too
      if (!good && ++faults <= 5) {
        wrong(path, table.line[i], time->column, std::isnan(t) ? "" : fmt::format("{:.9g}", t),
              std::isnan(t) ? "the time is empty"
              : t == last   ? "time stands still"
                            : fmt::format("time goes backwards, from {:.9g}", last),
              "every row needs a time after the row before");
      }
      if (!std::isnan(t)) last = t;
    }
    if (faults > 5) wrong(path, 0, time->column, "", fmt::format("{} more rows like this", faults - 5), "");
    if (run.time_s.size() < 2 && !run.steady) {
      wrong(path, table.line.front(), "", "", "has one row only",
            "a time series needs at least two; settled points are kind = \"steady\"");
    }
  }

  // Exactly one drive must be known throughout a run; the one listed first is taken.
  void check_drive(const RunPlan& plan, Run& run) {
    std::string_view chosen;
    std::vector<std::string> incomplete;
    for (const Channel& channel : dataset_.channels) {
      const SignalRow* row = find_signal(*dataset_.rig, channel.signal);
      const bool current = channel.signal == "motor_current" && channel.imposed;
      if ((row->role != SignalRole::kDrive && !current) || run.signal(channel.signal) == nullptr) continue;
      const std::string_view group = current ? channel.signal : row->drive_group;
      if (group == chosen) continue;
      if (!complete(group, run)) {
        incomplete.emplace_back(group);
      } else if (chosen.empty()) {
        chosen = group;
      } else {
        notes_.add(
            fmt::format("{} is a second drive input and is left out; {}, listed before it, drives the model",
                        group, chosen),
            run.file);
        for (const std::string_view name : group_of(group)) run.signals.erase(std::string(name));
      }
    }
    if (!chosen.empty()) return;
    std::string what = fmt::format("\"{}\" has no drive input", run.file);
    if (!incomplete.empty()) what += fmt::format(" ({} is not complete)", incomplete.front());
    problems_.push_back({.file = toml_name_,
                         .line = plan.at.line,
                         .column = plan.at.column,
                         .key = "runs",
                         .value = "",
                         .what = std::move(what),
                         .allowed = std::string(dataset_.rig->drive_needed)});
  }

  std::vector<std::string_view> group_of(std::string_view group) const {
    if (group == "motor_current") return {group};
    std::vector<std::string_view> names = drive_group_signals(*dataset_.rig, group);
    // Of signals per wheel, up to the last that the dataset has: how many wheels there are is the model's to say.
    const auto wanted = [&](std::string_view name) { return dataset_.channel(name) != nullptr; };
    while (names.size() > kMinWheels && names.back().back() > '0' + static_cast<int>(kMinWheels) &&
           names.back().back() <= '9' && !wanted(names.back()))
      names.pop_back();
    return names;
  }
  bool complete(std::string_view group, const Run& run) const {
    const auto names = group_of(group);
    return std::all_of(names.begin(), names.end(),
                       [&](std::string_view name) { return run.signal(name) != nullptr; });
  }

  // A column that no file has is a misspelling, not something that was not measured.
  void report_missing_columns() {
    const std::vector<std::string_view> names(header_.begin(), header_.end());
    for (const Channel& channel : dataset_.channels) {
      const auto at = static_cast<std::size_t>(std::find(wanted_.begin(), wanted_.end(), channel.column) -
                                               wanted_.begin());
      if (found_[at] || channel.signal == "time") continue;
      wrong(toml_name_, static_cast<std::size_t>(channel.line), "channels." + channel.signal + ".column",
            fmt::format("\"{}\"", channel.column), "no run has this column",
            spelling_hint(channel.column, names));
    }
  }

  const DatasetPlan& plan_;
  const std::string& folder_;
  const std::string& toml_name_;
  Dataset& dataset_;
  std::vector<ModelProblem>& problems_;
  std::vector<std::string> wanted_;  // columns
  std::vector<bool> found_;          // in some run
  std::vector<std::string> header_;  // of the first run that could be opened
  RunNotes notes_;
};

}  // namespace

void add_runs(const DatasetPlan& plan, const std::string& folder, const std::string& toml_name,
              Dataset& dataset, std::vector<ModelProblem>& problems) {
  RunsReader(plan, folder, toml_name, dataset, problems).read();
}

}  // namespace omnihil
