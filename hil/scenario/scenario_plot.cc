#include "hil/scenario/scenario_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kWidth = 860, kLeft = 70, kRight = 20, kTop = 44, kPanel = 190, kGap = 46;
constexpr std::size_t kMostPoints = 2000;
constexpr std::string_view kColours[] = {"#1f6fb4", "#d1701a"};

struct Panel {
  std::vector<std::string_view> signals;
  std::string unit;
};

// Signals of one unit share a panel: what was and what was commanded lie over each other.
std::vector<Panel> panels_of(const CheckResult& r) {
  std::vector<Panel> panels;
  for (const std::string_view name : r.signals) {
    const std::string unit(find_scenario_signal(name)->unit);
    const auto same = std::ranges::find(panels, unit, &Panel::unit);
    if (same == panels.end()) {
      panels.push_back({{name}, unit});
    } else {
      same->signals.push_back(name);
    }
  }
  return panels;
}

struct Range {
  double low = 0.0, high = 1.0;
  double place(double value, double from, double to) const {
    return from + (value - low) / (high - low) * (to - from);
  }
};

Range range_of(const ScenarioTrace& trace, const Panel& panel, std::size_t wheel) {
  Range range{0.0, 0.0};
  for (const std::string_view name : panel.signals) {
    for (const double y : trace.column(name, wheel)) {
      range.low = std::min(range.low, y);
      range.high = std::max(range.high, y);
    }
  }
  const double margin = std::max(1e-6, 0.06 * (range.high - range.low));
  return {range.low - margin, range.high + margin};
}

// 1, 2 or 5 times a power of ten: about five ticks.
double tick_of(const Range& range) {
  const double raw = (range.high - range.low) / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= raw) return step * power;
  }
  return 10.0 * power;
}

std::string axes(const Range& time, const Range& y, double top, const std::string& unit) {
  std::string out;
  const double bottom = top + kPanel, right = kWidth - kRight;
  for (double v = std::ceil(y.low / tick_of(y)) * tick_of(y); v <= y.high; v += tick_of(y)) {
    const double at = y.place(v, bottom, top);
    out += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>\n",
        kLeft, at, right, kLeft - 6, at + 4, std::abs(v) < 1e-12 ? 0.0 : v);
  }
  for (double v = std::ceil(time.low / tick_of(time)) * tick_of(time); v <= time.high; v += tick_of(time)) {
    const double at = time.place(v, kLeft, right);
    out += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.4g}</text>\n",
        at, top, bottom, at, bottom + 15, v);
  }
  return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", 8.0, top - 6, unit);
}

std::string curve(const ScenarioTrace& trace, std::span<const double> y, const Range& time,
                  const Range& range, double top, std::string_view colour) {
  std::string points;
  const std::span<const double> t = trace.time_s();
  const std::size_t stride = std::max<std::size_t>(1, t.size() / kMostPoints);
  for (std::size_t i = 0; i < t.size(); i += stride) {
    points += fmt::format("{:.1f},{:.1f} ", time.place(t[i], kLeft, kWidth - kRight),
                          range.place(y[i], top + kPanel, top));
  }
  return fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" points=\"{}\"/>\n", colour,
                     points);
}

}  // namespace

std::string scenario_plot(const std::string& title, const ScenarioTrace& trace, const CheckResult& r) {
  const std::vector<Panel> panels = panels_of(r);
  const double height = kTop + static_cast<double>(panels.size()) * (kPanel + kGap);
  const std::size_t wheel = r.wheel < 0 ? 0 : static_cast<std::size_t>(r.wheel);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} "
      "{1:g}\">\n"
      "<style>text{{font:12px sans-serif;fill:#333}} .grid{{stroke:#ddd;fill:none}} .head{{font-weight:bold}}"
      "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text class=\"head\" x=\"8\" y=\"18\">{2}</text>\n",
      kWidth, height, title);
  if (trace.time_s().empty()) return out + "</svg>\n";
  const Range time{0.0, std::max(1e-3, trace.time_s().back())};
  double top = kTop;
  for (const Panel& panel : panels) {
    const Range range = range_of(trace, panel, wheel);
    const double from = time.place(std::max(r.from_s, time.low), kLeft, kWidth - kRight);
    const double to = time.place(std::min(r.to_s, time.high), kLeft, kWidth - kRight);
    if (to > from) {
      out +=
          fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\" fill=\"#f5efdc\"/>\n",
                      from, top, to - from, kPanel);
    }
    out += axes(time, range, top, panel.unit.empty() ? "ratio" : panel.unit);
    for (std::size_t n = 0; n < panel.signals.size(); ++n) {
      const std::string_view colour = kColours[n % std::size(kColours)];
      out += curve(trace, trace.column(panel.signals[n], wheel), time, range, top, colour);
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"fill:{}\">{}</text>\n",
                         kLeft + 200.0 * static_cast<double>(n), top - 6, colour, panel.signals[n]);
    }
    const double at = time.place(r.at_s, kLeft, kWidth - kRight);
    out += fmt::format("<path stroke=\"#c22\" stroke-dasharray=\"4 3\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", at,
                       top, top + kPanel);
    top += kPanel + kGap;
  }
  return out + fmt::format(
                   "<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\">time in s; shaded: the check's window;"
                   " dashed: the measured instant</text>\n</svg>\n",
                   kWidth - kRight, height - 8);
}

}  // namespace omnihil
