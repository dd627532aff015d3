#include "hil/logs/log_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/record/signal_list.h"

namespace omnihil {
namespace {

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();

bool is_held(const ColumnMeaning& m, const Rig& rig) {
  const SignalRole role = find_signal(rig, m.signal)->role;
  return role == SignalRole::kDrive || role == SignalRole::kFlag || m.imposed;
}

LogRows rows_of_table(const LogTable& log, const LogMeaning& meaning, const MeaningContext& context,
                      const std::string& name) {
  LogRows out;
  const ColumnMeaning* clock = meaning.of("time");
  for (const ColumnMeaning& m : meaning.columns) {
    if (!m.signal.empty() && &m != clock) out.meaning.push_back(&m);
  }
  out.columns.resize(out.meaning.size());
  const std::size_t rows = log.series.front().value.size();
  std::size_t untimed = 0, repeated = 0;
  double first = kEmpty, last = -INFINITY;
  for (std::size_t i = 0; i < rows; ++i) {
    double at = context.period_s * static_cast<double>(i);
    if (clock != nullptr) {
      const double raw = log.series[clock->series].value[i];
      if (std::isnan(raw)) {
        ++untimed;
        continue;
      }
      if (std::isnan(first)) first = raw;
      at = (raw - first) * clock->scale.scale;
    }
    if (at < last)
      throw BadLog(fmt::format(
          "{}: row {}: time goes backwards, from {:.6g} s to {:.6g} s; allowed: rows in order of time", name,
          i + 1, last, at));
    if (at == last) {
      ++repeated;
      continue;
    }
    last = at;
    out.time_s.push_back(at);
    for (std::size_t k = 0; k < out.meaning.size(); ++k)
      out.columns[k].push_back(log.series[out.meaning[k]->series].value[i]);
  }
  if (untimed > 0) out.notes.push_back(fmt::format("{}: {} rows without a time left out", name, untimed));
  if (repeated > 0)
    out.notes.push_back(fmt::format("{}: {} rows at the time of the row before left out", name, repeated));
  return out;
}

// The motion with the most samples.
const LogSeries& clock_of(const LogTable& log, const LogMeaning& meaning, const Rig& rig) {
  const LogSeries* best = nullptr;
  for (const ColumnMeaning& m : meaning.columns) {
    if (m.signal.empty()) continue;
    const SignalRole role = find_signal(rig, m.signal)->role;
    const LogSeries& s = log.series[m.series];
    if (role != SignalRole::kMotion && role != SignalRole::kCounts) continue;
    if (best == nullptr || s.value.size() > best->value.size()) best = &s;
  }
  return *best;  // recognise() has seen one
}

// The last value at or before each instant; `late_s`: by how much one that changed stands later than it was logged.
std::vector<double> held_at(const std::vector<double>& time_s, const LogSeries& s, double& late_s) {
  std::vector<double> out(time_s.size(), kEmpty);
  std::size_t next = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const std::size_t before = next;
    while (next < s.value.size() && (*s.time_s)[next] <= time_s[i]) ++next;
    if (next == 0) continue;
    out[i] = s.value[next - 1];
    if (next > before) late_s = std::max(late_s, time_s[i] - (*s.time_s)[before]);
  }
  return out;
}

// Each value at its nearest instant, at most half a period away; of two the nearer one.
std::vector<double> nearest_at(const std::vector<double>& time_s, const LogSeries& s, std::size_t& lost) {
  std::vector<double> out(time_s.size(), kEmpty), distance(time_s.size(), INFINITY);
  const double half_s = 0.5 * median_period_s(time_s);
  for (std::size_t j = 0; j < s.value.size(); ++j) {
    const double t = (*s.time_s)[j];
    auto it = std::lower_bound(time_s.begin(), time_s.end(), t);
    if (it == time_s.end() || (it != time_s.begin() && t - *(it - 1) <= *it - t)) --it;
    const auto at = static_cast<std::size_t>(it - time_s.begin());
    const double off = std::abs(*it - t);
    if (off > half_s || off >= distance[at]) {
      ++lost;
      continue;
    }
    if (std::isfinite(distance[at])) ++lost;
    distance[at] = off;
    out[at] = s.value[j];
  }
  return out;
}

LogRows rows_of_topics(const LogTable& log, const LogMeaning& meaning, const MeaningContext& context,
                       const std::string& name) {
  LogRows out;
  const LogSeries& clock = clock_of(log, meaning, *context.rig);
  std::size_t repeated = 0;
  for (const double t : *clock.time_s) {
    if (!out.time_s.empty() && t < out.time_s.back())
      throw BadLog(fmt::format("{}: {}: time goes backwards, from {:.6g} s to {:.6g} s", name, clock.name,
                               out.time_s.back(), t));
    if (!out.time_s.empty() && t == out.time_s.back()) {
      ++repeated;
    } else {
      out.time_s.push_back(t);
    }
  }
  if (repeated > 0)
    out.notes.push_back(
        fmt::format("{}: {}: {} samples at the time of the one before left out", name, clock.name, repeated));
  out.notes.push_back(
      fmt::format("{}: rows are at the {} instants of {}", name, out.time_s.size(), clock.name));
  for (const ColumnMeaning& m : meaning.columns) {
    if (m.signal.empty()) continue;
    const LogSeries& s = log.series[m.series];
    out.meaning.push_back(&m);
    if (!std::is_sorted(s.time_s->begin(), s.time_s->end()))
      throw BadLog(fmt::format("{}: {}: time goes backwards", name, s.name));
    if (is_held(m, *context.rig)) {
      double late_s = 0.0;
      out.columns.push_back(held_at(out.time_s, s, late_s));
      if (late_s > 0.0)
        out.notes.push_back(
            fmt::format("{}: {} holds its last value; it stands up to {:.3g} ms later than it was logged",
                        name, s.name, 1e3 * late_s));
    } else {
      std::size_t lost = 0;
      out.columns.push_back(nearest_at(out.time_s, s, lost));
      if (lost > 0)
        out.notes.push_back(fmt::format("{}: {} of {} samples of {} are at no instant of the rows: left out",
                                        name, lost, s.value.size(), s.name));
    }
  }
  const double first = out.time_s.empty() ? 0.0 : out.time_s.front();
  for (double& t : out.time_s) t -= first;
  return out;
}

}  // namespace

LogRows log_rows(const LogTable& log, const LogMeaning& meaning, const MeaningContext& context,
                 const std::string& name) {
  return log.by_rows() ? rows_of_table(log, meaning, context, name)
                       : rows_of_topics(log, meaning, context, name);
}

}  // namespace omnihil
