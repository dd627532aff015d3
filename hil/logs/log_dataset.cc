#include "hil/logs/log_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <span>

#include "hil/logs/log_rows.h"
#include "hil/text/line_chart.h"
#include "identify/record/held_readings.h"
#include "identify/record/rig.h"
#include "sim/bench/dataset_text.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// A name that a CSV header and a TOML text take as it is.
std::string plain_name(const std::string& name) {
  std::string out;
  for (const char c : name)
    out += c == ',' || c == '"' || c == '\\' || c == '\n' || c == '\r' || c == '\t' ? '_' : c;
  return out == "time_s" ? "time_s_" : out;  // the rows' own
}

std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

std::string csv_text(const LogTable& log, const LogRows& rows, std::size_t from, std::size_t to) {
  std::string out = "time_s";
  for (const ColumnMeaning* m : rows.meaning) out += "," + plain_name(log.series[m->series].name);
  out += "\n";
  const double first = rows.time_s[from];
  for (std::size_t i = from; i < to; ++i) {
    fmt::format_to(std::back_inserter(out), "{:.9g}", rows.time_s[i] - first);
    for (const std::vector<double>& column : rows.columns) {
      out += ',';
      if (std::isfinite(column[i])) fmt::format_to(std::back_inserter(out), "{}", column[i]);
    }
    out += '\n';
  }
  return out;
}

std::string picture_of(const LogRows& rows, const LogDatasetOptions& o, const std::string& title) {
  LineChart chart{
      .title = title, .x = rows.time_s, .x_label = "time in s", .panels = {}, .shade = {}, .mark = {}};
  for (std::size_t k = 0; k < rows.meaning.size(); ++k) {
    const ColumnMeaning& m = *rows.meaning[k];
    const std::string unit(signal_unit(*find_signal(*o.context.rig, m.signal), o.context.linear));
    ChartCurve curve{m.signal, {}};
    double last = std::numeric_limits<double>::quiet_NaN();
    for (const double v : rows.columns[k]) {
      if (std::isfinite(v)) last = v * m.scale.scale + m.scale.offset;
      curve.y.push_back(last);  // a slower sensor is drawn as steps
    }
    const auto panel = std::find_if(chart.panels.begin(), chart.panels.end(),
                                    [&](const ChartPanel& p) { return p.unit == unit; });
    if (panel == chart.panels.end()) {
      chart.panels.push_back({unit, {std::move(curve)}});
    } else {
      panel->curves.push_back(std::move(curve));
    }
  }
  return line_chart(chart);
}

std::pair<double, double> range_of_values(const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  return {low, high};
}

std::vector<std::string> table_of(const LogRun& run, const LogMeaning& meaning, const LogDatasetOptions& o) {
  std::size_t wide = 6;
  for (const LogSeries& s : run.table.series) wide = std::max(wide, s.name.size());
  std::vector<std::string> out = {fmt::format("{:<{}}  {:<20} {:<8} {:<8} {:>8} {:>22}  {}", "column", wide,
                                              "signal", "unit", "becomes", "samples", "values as logged",
                                              "because")};
  for (const ColumnMeaning& m : meaning.columns) {
    const LogSeries& s = run.table.series[m.series];
    const auto [low, high] = range_of_values(s.value);
    const SignalRow* row = m.signal.empty() ? nullptr : find_signal(*o.context.rig, m.signal);
    out.push_back(fmt::format("{:<{}}  {:<20} {:<8} {:<8} {:>8} {:>22}  {}", s.name, wide,
                              (m.signal.empty() ? "(left out)" : m.signal) + (m.imposed ? ", imposed" : ""),
                              m.signal.empty() ? "" : m.unit,
                              row == nullptr ? "" : signal_unit(*row, o.context.linear), s.value.size(),
                              fmt::format("{:.4g} … {:.4g}", low, high), m.because));
  }
  return out;
}

// Every channel once, as the first run that has it says.
class Channels {
 public:
  Channels(const LogDatasetOptions& o, LogDataset& out) : o_(o), out_(out) {}

  void add(const LogRun& run, const LogRows& rows) {
    for (const ColumnMeaning* m : rows.meaning) {
      const std::string column = plain_name(run.table.series[m->series].name);
      const auto [it, is_new] = lines_.try_emplace(m->signal, line_of(*m, column));
      if (is_new) {
        order_.push_back(m->signal);
      } else if (it->second != line_of(*m, column)) {
        out_.doubts.push_back(
            fmt::format("{}: {} is \"{}\" in {} there, other than in the run before; give --map for all runs",
                        run.path, m->signal, column, m->unit));
      }
    }
  }

  // Of one run's readings; a channel has that of all, rms.
  void add_sigma(const std::string& signal, const std::string& key, double sigma) {
    if (!(sigma > 0.0) || !std::isfinite(sigma)) return;
    auto& [square, count] = sigmas_[signal][key];
    square += sigma * sigma, count += 1.0;
  }

  std::string text() const {
    std::string out;
    for (const std::string& signal : order_) {
      std::string line = lines_.at(signal);
      if (const auto it = sigmas_.find(signal); it != sigmas_.end()) {
        for (const auto& [key, sum] : it->second)
          line.insert(line.size() - 2, fmt::format(", {} = {:.3g}", key, std::sqrt(sum.first / sum.second)));
      }
      out += line + "\n";
    }
    return out;
  }

 private:
  std::string line_of(const ColumnMeaning& m, const std::string& column) {
    std::string line = fmt::format("{} = {{ column = {}", m.signal, toml_text(column));
    if (m.scale.scale != 1.0) line += fmt::format(", scale = {}", m.scale.scale);
    if (m.scale.offset != 0.0) line += fmt::format(", offset = {}", m.scale.offset);
    if (find_signal(*o_.context.rig, m.signal)->role == SignalRole::kCounts) {
      if (!(o_.counts_per_rev > 0.0) && !said_)
        out_.doubts.push_back(
            "an encoder's counts per turn are not known; give --counts-per-rev N (after quadrature), and "
            "--shaft output where "
            "it is not on the rotor");
      said_ = said_ || !(o_.counts_per_rev > 0.0);
      line += fmt::format(", counts_per_rev = {}", o_.counts_per_rev);
      if (o_.on_output) line += ", shaft = \"output\"";
    }
    if (m.imposed) line += ", role = \"imposed\"";
    return line + " }";
  }

  const LogDatasetOptions& o_;
  LogDataset& out_;
  std::map<std::string, std::string> lines_;
  std::vector<std::string> order_;
  // By signal, then by key: sum of squares, count.
  std::map<std::string, std::map<std::string, std::pair<double, double>>> sigmas_;
  bool said_ = false;
};

std::string readme_of(const std::vector<LogRun>& runs, const LogDataset& made) {
  std::string out = "# Imported by omnihil\n\n- Source: ";
  for (const LogRun& run : runs)
    out += fmt::format("{}{} ({}, sha256:{})", &run == &runs.front() ? "" : ", ", run.file.name,
                       log_format_name(run.table.format), run.file.sha256.substr(0, 12));
  out += "\n- Values are as logged; the scales are in dataset.toml.\n\n```\n";
  for (const std::string& line : made.table) out += line + "\n";
  out += "```\n";
  for (const std::string& note : made.notes) out += "- " + note + "\n";
  return out;
}

// The answer to a doubt goes for all runs: what the first has asked is not asked again of the others.
void add_doubts(const std::string& path, const std::vector<std::string>& doubts, LogDataset& made) {
  for (const std::string& doubt : doubts) {
    const std::string about = doubt.substr(0, doubt.find(" (largest"));
    const bool asked = std::any_of(made.doubts.begin(), made.doubts.end(),
                                   [&](const std::string& d) { return d.find(about) != std::string::npos; });
    if (!asked) made.doubts.push_back(path + ": " + doubt);
  }
}

// What was asked of columns that this run has, or that no log has: logs of one import may differ in their columns, and of a
// pose's columns runs without one know nothing.
std::vector<ColumnMap> asked_here(const LogRun& run, const std::vector<LogRun>& all,
                                  const std::vector<ColumnMap>& asked) {
  const auto has = [](const LogTable& table, const ColumnMap& a) {
    return std::any_of(table.series.begin(), table.series.end(),
                       [&](const LogSeries& s) { return s.name == a.column; });
  };
  std::vector<ColumnMap> out;
  for (const ColumnMap& a : asked) {
    const bool elsewhere = std::any_of(all.begin(), all.end(),
                                       [&](const LogRun& r) { return has(r.table, a) || has(r.pose, a); });
    if (has(run.table, a) || !elsewhere) out.push_back(a);
  }
  return out;
}

// "walk.wpilog" -> "walk"; of two of one name the second is walk_2.
std::string stem_of(const std::string& path, std::map<std::string, int>& used) {
  std::string stem = plain_name(fs::path(path).stem().string());
  const int n = ++used[stem];
  return n == 1 ? stem : fmt::format("{}_{}", stem, n);
}

// A note begins with its file. What is said of many files is said once, with how many more there are.
std::vector<std::string> merged(const std::vector<std::string>& notes) {
  std::vector<std::pair<std::string, std::size_t>> out;  // a note, and how many more have its words
  const auto words = [](const std::string& note) {
    return note.substr(std::min(note.find(": "), note.size()));
  };
  for (const std::string& note : notes) {
    const auto same = std::ranges::find(out, words(note), [&](const auto& n) { return words(n.first); });
    if (same != out.end()) {
      ++same->second;
    } else {
      out.emplace_back(note, 0);
    }
  }
  std::vector<std::string> texts;
  for (const auto& [note, more] : out)
    texts.push_back(more == 0 ? note : fmt::format("{} (and in {} more)", note, more));
  return texts;
}

// A run with what its columns are taken for.
struct ReadRun {
  LogRun run;
  LogMeaning meaning;
  LogRows rows;
};

// Of a sensor that is slower than its rows one row a reading is left, and that is said.
void empty_held(std::deque<ReadRun>& read, const MeaningContext& context, LogDataset& made) {
  std::map<std::string, std::vector<std::vector<double>*>> by_signal;
  for (ReadRun& r : read) {
    if (!r.run.table.by_rows()) continue;
    for (std::size_t k = 0; k < r.rows.meaning.size(); ++k) {
      const ColumnMeaning& m = *r.rows.meaning[k];
      if (may_be_held(*find_signal(*context.rig, m.signal), m.imposed, context.pole_pairs > 0.0))
        by_signal[m.signal].push_back(&r.rows.columns[k]);
    }
  }
  for (const auto& [signal, runs] : by_signal) {
    const double rows = rows_held({runs.begin(), runs.end()});
    if (!(rows > 0.0)) continue;
    for (std::vector<double>* values : runs) empty_repeats(*values);
    made.notes.push_back(fmt::format(
        "logs: {} is new in one row of {:g} only, about every {:.3g} ms, and repeated in the others, whose "
        "cells are left empty",
        signal, rows, 1e3 * rows * median_period_s(read.front().rows.time_s)));
  }
}

// The files of one run: a fit run may have a part that is held out.
void write_run(const ReadRun& r, const std::string& stem, const LogDatasetOptions& o,
               std::vector<DatasetFile>& csv, std::string& run_text) {
  const std::vector<double>& time_s = r.rows.time_s;
  std::size_t cut = time_s.size();
  if (r.run.use == kTraining && o.fit_share < 1.0) {
    const double end = time_s.back() * o.fit_share;
    cut = static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), end) - time_s.begin());
    if (cut < 2 || time_s.size() - cut < 2)
      throw BadLog(
          fmt::format("{}: --split {:g} leaves a part with less than two rows", r.run.path, o.fit_share));
  }
  csv.push_back({stem + ".csv", csv_text(r.run.table, r.rows, 0, cut)});
  run_text += run_lines(csv.back().name, split_name(r.run.use));
  if (cut == time_s.size()) return;
  csv.push_back({stem + "_holdout.csv", csv_text(r.run.table, r.rows, cut, time_s.size())});
  run_text += run_lines(csv.back().name, split_name(kValidation));
}

}  // namespace

LogDataset make_log_dataset(const std::vector<LogRun>& given, const LogDatasetOptions& o) {
  LogDataset made;
  Channels channels(o, made);
  std::deque<ReadRun> read;  // rows point at the meanings beside them
  for (const LogRun& one : given) {
    LogRun run = one;
    std::vector<ColumnMap> asked = asked_here(run, given, o.asked);
    if (!run.pose_path.empty()) {
      JoinedPose joined =
          join_pose(run.table, run.pose, o.asked, o.geometry, o.context, run.path, run.pose_path);
      run.table = std::move(joined.table);
      asked = std::move(joined.asked);
      made.notes.push_back(joined.note);
      for (const ColumnMap& seen : std::span(asked).last(joined.columns.size())) {
        if (seen.signal != "vision_theta") channels.add_sigma(seen.signal, "sigma", joined.place_sigma_m);
        channels.add_sigma(seen.signal, "clock_sigma_s", joined.clock_sigma_s);
      }
    }
    LogMeaning meaning = recognise(run.table, o.context, asked);
    if (&one == &given.front()) made.table = table_of(run, meaning, o);
    for (const std::string& note : run.table.notes) made.notes.push_back(note);
    add_doubts(run.path, meaning.doubts, made);
    if (!meaning.doubts.empty()) continue;
    ReadRun& r = read.emplace_back(std::move(run), std::move(meaning));
    r.rows = log_rows(r.run.table, r.meaning, o.context, r.run.path);
    if (r.rows.time_s.size() < 2)
      throw BadLog(
          fmt::format("{}: {} rows are left; allowed: at least two", r.run.path, r.rows.time_s.size()));
    for (const std::string& note : r.rows.notes) made.notes.push_back(note);
    channels.add(r.run, r.rows);
  }
  empty_held(read, o.context, made);
  std::vector<DatasetFile> csv;
  std::map<std::string, int> used;
  std::string run_text;
  for (const ReadRun& r : read) write_run(r, stem_of(r.run.path, used), o, csv, run_text);
  made.notes = merged(made.notes);
  if (!made.doubts.empty()) return made;
  std::string toml = dataset_head(o.title, std::string(o.context.rig->name)) + channels.text() + run_text;
  if (!made.doubts.empty()) return made;
  made.files = {{"dataset.toml", std::move(toml)},
                {"model.toml", o.model_text},
                {"README.md", readme_of(given, made)},
                {"import.svg", picture_of(read.front().rows, o, read.front().run.file.name)}};
  for (DatasetFile& f : csv) made.files.push_back(std::move(f));
  return made;
}

}  // namespace omnihil
