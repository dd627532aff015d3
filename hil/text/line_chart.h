// Curves over one axis as a self-contained SVG: panels below each other, one per unit.
//
//   LineChart chart{.title = "wheel 1", .x = time_s, .x_label = "time in s", .panels = {}, .shade = {}, .mark = {}};
//   chart.panels.push_back({"rad/s", {{"recorded", recorded}, {"replayed", replayed}}});
//   std::string svg = line_chart(chart);
//
// Long curves keep the least and the greatest value of every interval, so a peak stays a peak.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace omnihil {

struct ChartCurve {
  std::string name;
  std::vector<double> y;  // as long as x; what is not finite is a gap
};

struct ChartPanel {
  std::string unit;
  std::vector<ChartCurve> curves;
};

struct LineChart {
  std::string title;
  std::vector<double> x;  // ascending
  std::string x_label;
  std::vector<ChartPanel> panels;
  std::optional<std::pair<double, double>> shade;  // a window of x
  std::optional<double> mark;                      // one x, a dashed line
};

std::string line_chart(const LineChart& chart);

}  // namespace omnihil
