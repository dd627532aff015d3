#include "hil/logs/recognise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hil/logs/known_names.h"
#include "hil/text/toml_keys.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr const char* kNameless = "its name says nothing to me";
constexpr double kDutyWithin = 1.05;                       // a ratio, with rounding; per cent go far beyond
constexpr double kLeastStep_s = 10e-6, kMostStep_s = 0.5;  // of a clock in seconds: 2 Hz to 100 kHz
constexpr double kMostVolts = 100.0;                       // above it the unit may be millivolts

double largest_of(const std::vector<double>& values) {
  double out = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) out = std::max(out, std::abs(v));
  }
  return out;
}

std::string unit_of_signal(const std::string& signal, const MeaningContext& c) {
  const SignalRow* row = find_signal(*c.rig, signal);
  return row == nullptr ? "" : std::string(signal_unit(*row, c.linear));
}

// A unit that values without one can only have; "": in doubt.
std::string unit_by_values(const std::string& signal, const std::vector<double>& values) {
  const double largest = largest_of(values);
  if (signal.starts_with("duty") && largest <= kDutyWithin) return "1";
  if (signal.find("voltage") != std::string::npos && largest <= kMostVolts) return "V";
  if (signal.starts_with("encoder")) return "counts";
  if (signal == "enable") return "1";
  if (signal == "time") {
    std::vector<double> steps;
    for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(values[i] - values[i - 1]);
    if (steps.empty()) return "";
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    const double step = steps[steps.size() / 2];
    if (step >= kLeastStep_s && step <= kMostStep_s) return "s";
  }
  return "";
}

class Recogniser {
 public:
  Recogniser(const LogTable& log, const MeaningContext& context, const std::vector<ColumnMap>& asked)
      : log_(log), context_(context), asked_(asked) {}

  LogMeaning run() {
    check_asked();
    for (std::size_t i = 0; i < log_.series.size(); ++i) {
      ColumnMeaning& m = out_.columns.emplace_back();
      m.series = i;
      if (!by_map(m) && !by_document(m)) by_name(m);
    }
    settle_rivals();
    settle_ambiguous();
    for (ColumnMeaning& m : out_.columns) {
      set_scale(m);
      m.imposed = m.imposed || std::find(context_.imposed.begin(), context_.imposed.end(), m.signal) !=
                                   context_.imposed.end();
    }
    check_whole();
    return std::move(out_);
  }

 private:
  const std::string& name(const ColumnMeaning& m) const { return log_.series[m.series].name; }

  void check_asked() {
    std::vector<std::string_view> names, signals = signal_names(*context_.rig);
    for (const LogSeries& s : log_.series) names.push_back(s.name);
    for (const ColumnMap& a : asked_) {
      if (std::find(names.begin(), names.end(), a.column) == names.end())
        out_.doubts.push_back(fmt::format("--map {}={}: there is no such column; {}", a.column, a.signal,
                                          spelling_hint(a.column, names)));
      if (a.signal != "-" && std::find(signals.begin(), signals.end(), a.signal) == signals.end())
        out_.doubts.push_back(fmt::format("--map {}={}: there is no such signal; {}", a.column, a.signal,
                                          spelling_hint(a.signal, signals)));
    }
  }

  bool by_map(ColumnMeaning& m) {
    for (const ColumnMap& a : asked_) {
      if (a.column != name(m)) continue;
      m.because = "--map";
      if (a.signal != "-" && find_signal(*context_.rig, a.signal) != nullptr) m.signal = a.signal;
      m.unit = a.unit.empty() ? log_.series[m.series].unit : a.unit;
      ranks_[m.series] = -1;
      return true;
    }
    return false;
  }

  bool by_document(ColumnMeaning& m) {
    const KnownName* known = known_name(log_.format, name(m));
    if (known == nullptr || (context_.rig->of_robot && known->signal != "time" && !known->signal.empty() &&
                             find_signal(*context_.rig, known->signal) == nullptr))
      return false;
    m.because =
        known->signal.empty() ? std::string(known->why) : "a known column of " + log_format_name(log_.format);
    m.signal = known->signal;
    m.unit = known->unit;
    m.imposed = known->imposed;
    ranks_[m.series] = known->rank;
    return true;
  }

  void by_name(ColumnMeaning& m) {
    const auto [base, unit] = split_unit(name(m));
    m.signal = usual_signal(base, *context_.rig);
    m.unit = !unit.empty() ? unit : log_.series[m.series].unit;
    if (m.signal.empty()) {
      std::vector<std::string> may = ambiguous_signals(base, *context_.rig);
      std::erase_if(may, [&](const std::string& signal) { return !has_unit(signal, m.unit); });
      if (may.size() == 1) m.signal = may.front();  // volts are no duty
      if (may.size() > 1) ambiguous_.emplace_back(m.series, may);
    }
    if (m.signal == "velocity" && m.unit.empty() && (base == "rpm" || base == "RPM")) m.unit = "rpm";
    m.because = m.signal.empty()                  ? kNameless
                : unit.empty() && !m.unit.empty() ? "its name; unit as the file says"
                                                  : "its name";
    ranks_[m.series] = 0;
    if (m.signal == "time" && !log_.by_rows()) {
      m.signal.clear();
      m.because = "each topic has its own time";
    }
  }

  // Whether a column in this unit may be of the signal; of no unit: it may.
  bool has_unit(const std::string& signal, const std::string& unit) const {
    if (unit.empty()) return true;
    std::string fault;
    return unit_scale(unit, unit_of_signal(signal, context_), {context_.pole_pairs}, fault).has_value();
  }

  // Of several columns for one signal the lowest rank is taken; equals are in doubt.
  void settle_rivals() {
    std::map<std::string, std::vector<ColumnMeaning*>> by_signal;
    for (ColumnMeaning& m : out_.columns) {
      if (!m.signal.empty()) by_signal[m.signal].push_back(&m);
    }
    for (auto& [signal, rivals] : by_signal) {
      std::stable_sort(rivals.begin(), rivals.end(), [&](const ColumnMeaning* a, const ColumnMeaning* b) {
        return ranks_[a->series] < ranks_[b->series];
      });
      std::size_t equals = 1;
      while (equals < rivals.size() && ranks_[rivals[equals]->series] == ranks_[rivals[0]->series]) ++equals;
      if (equals > 1) {
        std::vector<std::string> words;
        for (std::size_t i = 0; i < equals; ++i)
          words.push_back(fmt::format("--map \"{}={}\"", name(*rivals[i]), with_unit(*rivals[i])));
        out_.doubts.push_back(
            fmt::format("{} columns may be {}; give one of: {}", equals, signal, fmt::join(words, ", or ")));
        for (ColumnMeaning* m : rivals) m->signal.clear();
        continue;
      }
      for (std::size_t i = 1; i < rivals.size(); ++i) {
        rivals[i]->signal.clear();
        rivals[i]->because = fmt::format("\"{}\" is {}", name(*rivals[0]), signal);
      }
    }
  }

  // A name that two signals go by is in doubt, unless each of them has its column already.
  void settle_ambiguous() {
    for (const auto& [series, may] : ambiguous_) {
      std::vector<std::string> words;
      for (const std::string& signal : may) {
        if (out_.of(signal) == nullptr)
          words.push_back(fmt::format("--map \"{}={}:{}\"", log_.series[series].name, signal,
                                      unit_of_signal(signal, context_)));
      }
      if (words.empty()) continue;
      words.push_back(fmt::format("--map \"{}=-\" to leave it out", log_.series[series].name));
      out_.doubts.push_back(fmt::format("column \"{}\" may be {}; give one of: {}", log_.series[series].name,
                                        fmt::join(may, " or "), fmt::join(words, ", or ")));
    }
  }

  std::string with_unit(const ColumnMeaning& m) const {
    return m.signal + ":" + (m.unit.empty() ? unit_of_signal(m.signal, context_) : m.unit);
  }

  void set_scale(ColumnMeaning& m) {
    if (m.signal.empty()) return;
    const std::string to = unit_of_signal(m.signal, context_);
    if (m.unit.empty()) {
      m.unit = unit_by_values(m.signal, log_.series[m.series].value);
      if (!m.unit.empty()) m.because += fmt::format("; no unit, by its values {}", m.unit);
    }
    if (m.unit.empty() && context_.si) {
      m.unit = to;
      m.because += "; unit by --si";
    }
    if (m.unit.empty()) {
      doubt_unit(m, to);
      return;
    }
    std::string fault;
    if (const auto scale = unit_scale(m.unit, to, {context_.pole_pairs}, fault)) {
      m.scale = *scale;
    } else {
      out_.doubts.push_back(fmt::format("column \"{}\" as {}: {}", name(m), m.signal, fault));
    }
  }

  // Which units it may be in, each as a flag. A duty that goes beyond one is in none by which it still does, and in parts
  // of whatever its timer counts to.
  void doubt_unit(const ColumnMeaning& m, const std::string& to) {
    constexpr std::size_t kMost = 3;  // flags in one message; a choice
    const double largest = largest_of(log_.series[m.series].value);
    const bool is_duty = m.signal.starts_with("duty");
    std::vector<std::string> words;
    for (const std::string& unit : units_for(to)) {
      std::string fault;
      const auto scale = unit_scale(unit, to, {context_.pole_pairs}, fault);
      if (is_duty && scale && largest * scale->scale > kDutyWithin) continue;
      if (words.size() < kMost) words.push_back(fmt::format("--map \"{}={}:{}\"", name(m), m.signal, unit));
    }
    if (is_duty)
      words.push_back(
          fmt::format("--map \"{}={}:{:.3g}*1\" with 1 over its value at full duty in place of {:.3g}",
                      name(m), m.signal, 1.0 / largest, 1.0 / largest));
    out_.doubts.push_back(
        fmt::format("column \"{}\" is {}, but nothing says in which unit (largest value {:.4g}); give one "
                    "of: {}{}",
                    name(m), m.signal, largest, fmt::join(words, ", or "), is_duty ? "" : "; or --si"));
  }

  // The motion, else the drive input, of an axis that a unit fits; null: neither.
  const SignalRow* row_by_unit(const std::string& unit) const {
    for (const bool motion : {true, false}) {
      for (const SignalRow& row : context_.rig->signals) {
        const bool moves = row.role == SignalRole::kMotion || row.role == SignalRole::kCounts;
        if ((motion ? moves : row.role == SignalRole::kDrive) && has_unit(std::string(row.name), unit))
          return &row;
      }
    }
    return nullptr;
  }

  // Of an axis' columns whose names say nothing, those that are in a unit of a drive input, or of a motion: a flag each.
  std::string flags_by_unit(bool of_drive) const {
    constexpr std::size_t kMost = 4;  // flags in one message; a choice
    std::vector<std::string> flags;
    for (const ColumnMeaning& m : out_.columns) {
      if (context_.rig->of_robot || m.because != kNameless || m.unit.empty() || flags.size() == kMost)
        continue;
      const SignalRow* row = row_by_unit(m.unit);
      if (row == nullptr || (row->role == SignalRole::kDrive) != of_drive) continue;
      flags.push_back(fmt::format("--map \"{}={}:{}\"", name(m), row->name, m.unit));
    }
    return flags.empty() ? "" : fmt::format("; by their units may be: {}", fmt::join(flags, ", or "));
  }

  void check_whole() {
    if (!out_.doubts.empty()) return;
    if (log_.by_rows() && out_.of("time") == nullptr && !(context_.period_s > 0.0))
      out_.doubts.push_back(
          "no column is the time; give --map \"COLUMN=time:s\" (or ms, us), or --period SECONDS for rows of "
          "equal spacing");
    const auto role = [&](const ColumnMeaning& m) { return find_signal(*context_.rig, m.signal)->role; };
    const auto any = [&](auto want) {
      return std::any_of(out_.columns.begin(), out_.columns.end(),
                         [&](const ColumnMeaning& m) { return !m.signal.empty() && want(m); });
    };
    if (!any([&](const ColumnMeaning& m) { return role(m) == SignalRole::kDrive || m.imposed; }))
      out_.doubts.push_back(
          context_.rig->of_robot
              ? "no column is what was asked of the robot; give --map \"COLUMN=duty_1:1\" to duty_4, or "
                "command_vx, _vy, _w"
              : "no column is what was asked of the drive; give --map \"COLUMN=duty:1\" (or motor_voltage:V, "
                "motor_torque:Nm, "
                "position_target:rad), or --imposed motor_current where the current was set" +
                    flags_by_unit(true));
    check_drives();
    if (!any([&](const ColumnMeaning& m) {
          return role(m) == SignalRole::kMotion || role(m) == SignalRole::kCounts;
        }))
      out_.doubts.push_back(
          "no column is a motion; give --map \"COLUMN=velocity:rad/s\" (or rpm), \"COLUMN=position:rad\" or "
          "\"COLUMN=encoder:counts\"" +
          flags_by_unit(false));
  }

  // A model is driven by one thing: of two that were logged the user says which.
  void check_drives() {
    std::map<std::string_view, const ColumnMeaning*> groups;
    for (const ColumnMeaning& m : out_.columns) {
      if (m.signal.empty()) continue;
      const SignalRow* row = find_signal(*context_.rig, m.signal);
      if (row->role == SignalRole::kDrive) groups.try_emplace(row->drive_group, &m);
    }
    if (groups.size() < 2) return;
    std::vector<std::string> words;
    for (const auto& [group, m] : groups) words.push_back(fmt::format("--map \"{}=-\"", name(*m)));
    out_.doubts.push_back(
        fmt::format("{} columns may be what was asked of the drive; leave all but one out: {}", groups.size(),
                    fmt::join(words, ", or ")));
  }

  const LogTable& log_;
  const MeaningContext& context_;
  const std::vector<ColumnMap>& asked_;
  std::map<std::size_t, int> ranks_;
  std::vector<std::pair<std::size_t, std::vector<std::string>>> ambiguous_;  // series, and what it may be
  LogMeaning out_;
};

}  // namespace

const ColumnMeaning* LogMeaning::of(std::string_view signal) const {
  const auto it = std::find_if(columns.begin(), columns.end(),
                               [&](const ColumnMeaning& m) { return m.signal == signal; });
  return it == columns.end() ? nullptr : &*it;
}

ColumnMap parse_map(std::string_view text, std::vector<std::string>& faults) {
  ColumnMap out;
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    faults.push_back(
        fmt::format("--map {}: allowed: COLUMN=SIGNAL:UNIT, COLUMN=SIGNAL or COLUMN=- (left out)", text));
    return out;
  }
  out.column = text.substr(0, equals);
  const std::string_view rest = text.substr(equals + 1);
  const std::size_t colon = rest.find(':');
  out.signal = rest.substr(0, colon);
  if (colon != std::string_view::npos) out.unit = rest.substr(colon + 1);
  if (!out.unit.empty() && !is_unit(out.unit))
    faults.push_back(fmt::format("--map {}: unit \"{}\" is not known", text, out.unit));
  return out;
}

LogMeaning recognise(const LogTable& log, const MeaningContext& context,
                     const std::vector<ColumnMap>& asked) {
  return Recogniser(log, context, asked).run();
}

}  // namespace omnihil
