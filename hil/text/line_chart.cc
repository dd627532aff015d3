#include "hil/text/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr double kWidth = 860, kLeft = 70, kRight = 20, kTop = 44, kPanel = 190, kGap = 46;
constexpr std::size_t kIntervals = 1000;  // more than the picture has pixels
constexpr std::array<std::string_view, 4> kColours{"#1f6fb4", "#d1701a", "#00795a", "#9b4f86"};

struct Range {
  double low = 0.0, high = 1.0;
  double place(double value, double from, double to) const {
    return from + (value - low) / (high - low) * (to - from);
  }
};

// Of all curves of a panel, with zero in it.
Range range_of(const ChartPanel& panel) {
  Range range{0.0, 0.0};
  for (const ChartCurve& curve : panel.curves) {
    for (const double y : curve.y) {
      if (!std::isfinite(y)) continue;
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

std::string axes(const Range& x, const Range& y, double top, const std::string& unit) {
  std::string out;
  const double bottom = top + kPanel, right = kWidth - kRight;
  for (double v = std::ceil(y.low / tick_of(y)) * tick_of(y); v <= y.high; v += tick_of(y)) {
    const double at = y.place(v, bottom, top);
    out += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>\n",
        kLeft, at, right, kLeft - 6, at + 4, std::abs(v) < 1e-12 ? 0.0 : v);
  }
  for (double v = std::ceil(x.low / tick_of(x)) * tick_of(x); v <= x.high; v += tick_of(x)) {
    const double at = x.place(v, kLeft, right);
    out += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.4g}</text>\n",
        at, top, bottom, at, bottom + 15, v);
  }
  return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", 8.0, top - 6, escaped(unit));
}

// Places of the values that are drawn: all, or of every interval the least and the greatest, in their order.
std::vector<std::size_t> drawn(const std::vector<double>& y) {
  std::vector<std::size_t> places;
  const std::size_t stride = std::max<std::size_t>(1, y.size() / kIntervals);
  for (std::size_t from = 0; from < y.size(); from += stride) {
    const auto begin = y.begin() + static_cast<std::ptrdiff_t>(from);
    const auto end = y.begin() + static_cast<std::ptrdiff_t>(std::min(y.size(), from + stride));
    const auto [least, greatest] = std::minmax_element(begin, end);
    const auto [first, second] = std::minmax({least - y.begin(), greatest - y.begin()});
    places.push_back(static_cast<std::size_t>(first));
    if (second != first) places.push_back(static_cast<std::size_t>(second));
  }
  return places;
}

std::string curve_of(const LineChart& chart, const ChartCurve& curve, const Range& x, const Range& y,
                     double top, std::string_view colour) {
  std::string out, points;
  const auto end_line = [&] {
    if (!points.empty())
      out += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" points=\"{}\"/>\n",
                         colour, points);
    points.clear();
  };
  for (const std::size_t i : drawn(curve.y)) {
    if (i >= chart.x.size()) break;
    if (!std::isfinite(curve.y[i])) {
      end_line();
      continue;
    }
    points += fmt::format("{:.1f},{:.1f} ", x.place(chart.x[i], kLeft, kWidth - kRight),
                          y.place(curve.y[i], top + kPanel, top));
  }
  end_line();
  return out;
}

std::string panel_of(const LineChart& chart, const ChartPanel& panel, const Range& x, double top) {
  const Range y = range_of(panel);
  std::string out;
  if (chart.shade) {
    const double from = x.place(std::max(chart.shade->first, x.low), kLeft, kWidth - kRight);
    const double to = x.place(std::min(chart.shade->second, x.high), kLeft, kWidth - kRight);
    if (to > from) {
      out +=
          fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\" fill=\"#f5efdc\"/>\n",
                      from, top, to - from, kPanel);
    }
  }
  out += axes(x, y, top, panel.unit);
  for (std::size_t n = 0; n < panel.curves.size(); ++n) {
    const std::string_view colour = kColours[n % kColours.size()];
    out += curve_of(chart, panel.curves[n], x, y, top, colour);
    out +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" style=\"fill:{}\">{}</text>\n",
                    kLeft + 200.0 * static_cast<double>(n), top - 6, colour, escaped(panel.curves[n].name));
  }
  if (chart.mark) {
    const double at = x.place(*chart.mark, kLeft, kWidth - kRight);
    out += fmt::format("<path stroke=\"#c22\" stroke-dasharray=\"4 3\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", at,
                       top, top + kPanel);
  }
  return out;
}

}  // namespace

std::string line_chart(const LineChart& chart) {
  const double height = kTop + static_cast<double>(chart.panels.size()) * (kPanel + kGap);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} "
      "{1:g}\">\n"
      "<style>text{{font:12px sans-serif;fill:#333}} .grid{{stroke:#ddd;fill:none}} .head{{font-weight:bold}}"
      "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text class=\"head\" x=\"8\" y=\"18\">{2}</text>\n",
      kWidth, height, escaped(chart.title));
  if (chart.x.empty()) return out + "</svg>\n";
  const Range x{std::min(0.0, chart.x.front()), std::max(chart.x.back(), chart.x.front() + 1e-3)};
  double top = kTop;
  for (const ChartPanel& panel : chart.panels) {
    out += panel_of(chart, panel, x, top);
    top += kPanel + kGap;
  }
  return out + fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"end\">{}</text>\n</svg>\n",
                           kWidth - kRight, height - 8, escaped(chart.x_label));
}

}  // namespace omnihil
