#include "hil/scenario/scenario_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hil/scenario/scenario_rows.h"
#include "hil/scenario/wheel_order.h"

namespace omnihil {
namespace {

constexpr double kRisen = 0.9, kLastPart = 0.2, kHalf = 0.5;
constexpr double kTick_s = 0.0015;  // the last control period begins before the window's end
constexpr double kSmallest = 1e-9;  // of a step's height: below it there is none

// One signal of one wheel over the window.
struct Window {
  std::span<const double> t, y, target;
  std::size_t size() const { return t.size(); }
};

double sign_of(double x) { return x < 0.0 ? -1.0 : 1.0; }

Window window_of(const ScenarioTrace& trace, std::string_view signal, std::size_t wheel, double from_s,
                 double to_s) {
  constexpr double kHalfTick_s = 1e-7;
  const std::span<const double> t = trace.time_s();
  const auto first = std::ranges::lower_bound(t, from_s - kHalfTick_s) - t.begin();
  const auto last = std::ranges::lower_bound(t, to_s - kHalfTick_s) - t.begin();
  const auto at = static_cast<std::size_t>(first), count = static_cast<std::size_t>(last - first);
  const std::string_view target = find_scenario_signal(signal)->target;
  Window w{t.subspan(at, count), trace.column(signal, wheel).subspan(at, count), {}};
  if (!target.empty()) w.target = trace.column(target, wheel).subspan(at, count);
  return w;
}

struct Found {
  std::optional<double> value;  // none: never
  double at_s = 0.0;
  std::string note;
};

// The largest of f(i) over the window.
template <class F>
Found largest(const Window& w, F&& f) {
  Found found;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double value = f(i);
    if (!found.value || value > *found.value) found = {value, w.t[i], {}};
  }
  return found;
}

double mean_from(const Window& w, double part, std::span<const double> y) {
  const std::size_t first =
      w.size() -
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(part * static_cast<double>(w.size()))));
  double sum = 0.0;
  for (std::size_t i = first; i < w.size(); ++i) sum += y[i];
  return sum / static_cast<double>(w.size() - first);
}

Found of_step(const ScenarioCheck& c, const Window& w) {
  const double r = w.target.back(), start = w.y.front(), height = r - start;
  if (std::abs(height) < kSmallest) return {{}, c.from_s, "the command asks for no change in this window"};
  const double size = std::abs(height), up = sign_of(height);
  switch (c.kind) {
    case CheckKind::kRiseTime:
      for (std::size_t i = 0; i < w.size(); ++i) {
        if ((w.y[i] - start) / height >= kRisen) return {w.t[i] - c.from_s, w.t[i], {}};
      }
      return {{}, w.t.back(), fmt::format("at the window's end it is at {:.4g} of {:.4g}", w.y.back(), r)};
    case CheckKind::kOvershoot: {
      Found f = largest(w, [&](std::size_t i) { return (w.y[i] - r) * up / size; });
      f.value = std::max(0.0, *f.value);
      return f;
    }
    case CheckKind::kSettlingTime: {
      std::size_t i = w.size();
      while (i > 0 && std::abs(w.y[i - 1] - r) <= c.band_ratio * size) --i;
      if (i == w.size()) {
        return {{}, w.t.back(), fmt::format("at the window's end it is at {:.4g} of {:.4g}", w.y.back(), r)};
      }
      return {w.t[i] - c.from_s, w.t[i], {}};
    }
    default: {
      const double error = std::abs(mean_from(w, kLastPart, w.y) - r);
      return {error / (std::abs(r) < kSmallest ? size : std::abs(r)), w.t.back(), {}};
    }
  }
}

class Checker {
 public:
  Checker(const Scenario& scenario, const ScenarioRun& run) : scenario_(scenario), run_(run) {}

  std::vector<CheckResult> all() {
    if (!run_.failure.empty()) add_failure();
    for (const ScenarioCheck& c : scenario_.checks) {
      for (std::size_t w = 0; w < kWheels; ++w) {
        if (c.wheels[w]) one(c, w);
        if (!row_of(c.kind).of_wheels) break;
      }
    }
    return std::move(results_);
  }

 private:
  void add_failure() {
    CheckResult r;
    r.name = "runs_to_the_end";
    r.at_s = run_.trace.time_s().empty() ? 0.0 : run_.trace.time_s().back();
    r.to_s = scenario_.duration_s;
    r.note = run_.failure;
    results_.push_back(r);
  }

  CheckResult blank(const ScenarioCheck& c, std::size_t w) const {
    const CheckRow& row = row_of(c.kind);
    CheckResult r;
    r.name = c.kind == CheckKind::kSignal ? std::string(c.signal) : std::string(row.word);
    if (row.follows_step && c.signal != "omega_wheel_rad_s") r.name += " of " + std::string(c.signal);
    r.line = c.line;
    const bool of_wheels = c.signal.empty() ? row.of_wheels : find_scenario_signal(c.signal)->of_wheels;
    r.wheel = of_wheels ? static_cast<int>(w) : -1;
    r.unit = c.kind == CheckKind::kSignal ? find_scenario_signal(c.signal)->unit : row.unit;
    r.from_s = c.from_s;
    r.to_s = c.to_s;
    r.allowed = c.at_most;
    return r;
  }

  void one(const ScenarioCheck& c, std::size_t w) {
    CheckResult r = blank(c, w);
    if (of_console(c.kind)) return console(c, r);
    const std::string_view signal = signal_of(c);
    r.signals = {std::string(signal)};
    const ScenarioSignal& row = *find_scenario_signal(signal);
    if (!row.target.empty()) r.signals.emplace_back(row.target);
    if (signal != "duty_ratio" && row.of_wheels) r.signals.push_back("duty_ratio");
    const Window window = window_of(run_.trace, signal, w, c.from_s, c.to_s);
    const std::span<const double> t = run_.trace.time_s();
    r.reached = window.size() >= 2 && (run_.failure.empty() || t.back() > c.to_s - kTick_s);
    if (!r.reached) {
      r.note = "the run did not get to the end of this window";
      results_.push_back(r);
      return;
    }
    if (c.kind == CheckKind::kSignal) return bounds(c, window, r);
    if (c.kind == CheckKind::kCommandedSign) return sign(window, r);
    if (c.kind == CheckKind::kWheelOrder) return order(c, r);
    const Found found = measure(c, window, w);
    r.measured = found.value;
    r.at_s = found.at_s;
    r.note = found.note;
    r.passed = found.value && *found.value <= *c.at_most && found.note.empty();
    results_.push_back(r);
  }

  static std::string_view signal_of(const ScenarioCheck& c) {
    if (!c.signal.empty()) return c.signal;
    if (c.kind == CheckKind::kCurrentLimit) return "motor_current_A";
    if (c.kind == CheckKind::kDutyLimit) return "duty_ratio";
    if (c.kind == CheckKind::kControlPeriods) return "missed_periods_count";
    return "omega_wheel_rad_s";
  }

  Found measure(const ScenarioCheck& c, const Window& w, std::size_t wheel) const {
    switch (c.kind) {
      case CheckKind::kCurrentLimit:
        return largest(w, [&](std::size_t i) { return std::abs(w.y[i]); });
      case CheckKind::kDutyLimit: {
        Found f = largest(w, [&](std::size_t i) { return std::abs(w.y[i]); });
        const Window refused = window_of(run_.trace, "refused_requests_count", wheel, c.from_s, c.to_s);
        const double count = refused.y.back() - refused.y.front();
        if (count > 0.0) f.note = fmt::format("{:g} requests that no bridge can take", count);
        return f;
      }
      case CheckKind::kControlPeriods: {
        const double before = w.y.front();
        Found f{w.y.back() - before, w.t.back(), {}};
        const auto first = std::ranges::find_if(w.y, [&](double n) { return n > before; });
        if (first != w.y.end()) f.at_s = w.t[static_cast<std::size_t>(first - w.y.begin())];
        return f;
      }
      case CheckKind::kStopsAfterSilence:
        return standstill(c, w);
      case CheckKind::kStopsSafely:
        return safe_from(c, w, window_of(run_.trace, "driven_count", wheel, c.from_s, c.to_s));
      case CheckKind::kWindUp: {
        const double r = w.target.back();
        if (std::abs(r) < kSmallest) return {{}, c.from_s, "no speed is commanded after the release"};
        Found f = largest(w, [&](std::size_t i) { return (w.y[i] - r) * sign_of(r) / std::abs(r); });
        f.value = std::max(0.0, *f.value);
        return f;
      }
      default:
        return of_step(c, w);
    }
  }

  static Found standstill(const ScenarioCheck& c, const Window& w) {
    std::size_t i = w.size();
    while (i > 0 && std::abs(w.y[i - 1]) < c.standstill_rad_s) --i;
    if (i == w.size()) {
      return {{}, w.t.back(), fmt::format("it still turns at {:.4g} rad/s", w.y.back())};
    }
    return {w.t[i] - c.from_s, w.t[i], {}};
  }

  static Found safe_from(const ScenarioCheck& c, const Window& w, const Window& driven) {
    std::size_t i = w.size();
    while (i > 0 && (std::abs(w.y[i - 1]) < c.standstill_rad_s || driven.y[i - 1] == 0.0)) --i;
    if (i == w.size())
      return {{}, w.t.back(), fmt::format("it is still driven, at {:.4g} rad/s", w.y.back())};
    return {w.t[i] - c.from_s, w.t[i], {}};
  }

  void sign(const Window& w, CheckResult& r) {
    const double mean = mean_from(w, kHalf, w.y), wanted = mean_from(w, kHalf, w.target);
    if (std::abs(wanted) < kSmallest) return;  // this wheel is not asked to turn
    r.measured = mean;
    r.at_s = w.t.back();
    r.passed = mean * wanted > 0.0;
    r.note = fmt::format("commanded {:.4g} rad/s", wanted);
    results_.push_back(r);
  }

  // By size: a wheel that turns the wrong way is commanded_sign's.
  void order(const ScenarioCheck& c, CheckResult& r) {
    std::array<double, kWheels> speed{}, wanted{};
    for (std::size_t w = 0; w < kWheels; ++w) {
      const Window window = window_of(run_.trace, "omega_wheel_rad_s", w, c.from_s, c.to_s);
      speed[w] = std::abs(mean_from(window, kHalf, window.y));
      wanted[w] = std::abs(mean_from(window, kHalf, window.target));
      r.at_s = window.t.back();
    }
    const WheelOrder found = wheel_order(speed, wanted);
    r.measured = found.out_of_place;
    r.allowed = 0.0;
    r.note = found.verdict;
    r.passed = found.verdict.empty();
    results_.push_back(r);
  }

  // A run that broke off before the window's end has not shown that nothing more would be said.
  void console(const ScenarioCheck& c, CheckResult& r) {
    r.name += fmt::format(" \"{}\"", c.text);
    const auto fits = [&c](const ConsoleLine& line) {
      const double at_s = static_cast<double>(line.at_ns) * 1e-9;
      return at_s >= c.from_s && at_s <= c.to_s && (c.port.empty() || line.port == c.port) &&
             (c.board < 0 || line.board == c.board) && line.text.find(c.text) != std::string::npos;
    };
    const auto said = std::ranges::find_if(run_.console, fits);
    const bool is_said = said != run_.console.end();
    if (is_said) {
      r.at_s = static_cast<double>(said->at_ns) * 1e-9;
      r.note = said->words();
    }
    const std::span<const double> t = run_.trace.time_s();
    r.reached = is_said || run_.failure.empty() || (!t.empty() && t.back() > c.to_s - kTick_s);
    if (!r.reached) r.note = "the run did not get to the end of this window";
    if (c.kind == CheckKind::kConsoleSays) {
      if (!r.allowed) r.allowed = c.to_s - c.from_s;
      if (is_said) r.measured = r.at_s - c.from_s;
      if (!is_said && r.reached) r.at_s = c.to_s;
      r.passed = r.measured && *r.measured <= *r.allowed;
    } else {
      r.allowed = 0.0;
      if (r.reached) r.measured = static_cast<double>(std::ranges::count_if(run_.console, fits));
      r.passed = r.measured && *r.measured == 0.0;
    }
    results_.push_back(r);
  }

  void bounds(const ScenarioCheck& c, const Window& w, CheckResult r) {
    const auto value = [&](std::size_t i) { return c.magnitude ? std::abs(w.y[i]) : w.y[i]; };
    const auto judge = [&](const Found& found, double limit, bool at_least) {
      r.measured = found.value;
      r.at_s = found.at_s;
      r.allowed = limit;
      r.at_least = at_least;
      r.passed = at_least ? *found.value >= limit : *found.value <= limit;
      results_.push_back(r);
    };
    const auto no_number = std::ranges::find_if(w.y, [](double y) { return std::isnan(y); });
    if (no_number != w.y.end()) {
      r.measured = *no_number;
      r.at_s = w.t[static_cast<std::size_t>(no_number - w.y.begin())];
      results_.push_back(r);
      return;
    }
    if (c.at_most) judge(largest(w, value), *c.at_most, false);
    if (!c.at_least) return;
    Found least = largest(w, [&](std::size_t i) { return -value(i); });
    least.value = -*least.value;
    judge(least, *c.at_least, true);
  }

  const Scenario& scenario_;
  const ScenarioRun& run_;
  std::vector<CheckResult> results_;
};

std::string number_text(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

}  // namespace

std::string CheckResult::measured_text() const { return measured ? number_text(*measured, unit) : "never"; }

std::string CheckResult::allowed_text() const {
  if (!allowed) return name == "commanded_sign" ? "the commanded sign" : "";
  return (at_least ? "at least " : "at most ") + number_text(*allowed, unit);
}

std::vector<CheckResult> check_scenario(const Scenario& scenario, const ScenarioRun& run) {
  return Checker(scenario, run).all();
}

}  // namespace omnihil
