#include "hil/scenario/scenario_plot.h"

#include <algorithm>

#include "hil/text/line_chart.h"

namespace omnihil {

std::string scenario_plot(const std::string& title, const ScenarioTrace& trace, const CheckResult& r) {
  const std::span<const double> time_s = trace.time_s();
  LineChart chart{.title = title,
                  .x = {time_s.begin(), time_s.end()},
                  .x_label = "time in s; shaded: the check's window; dashed: the measured instant",
                  .panels = {},
                  .shade = std::pair(r.from_s, r.to_s),
                  .mark = r.at_s};
  const std::size_t wheel = r.wheel < 0 ? 0 : static_cast<std::size_t>(r.wheel);
  for (const std::string_view name : r.signals) {
    std::string unit(find_scenario_signal(name)->unit);
    if (name.starts_with(kVariablePrefix)) unit = name;  // of variables nobody knows which share one
    if (unit.empty()) unit = "ratio";
    const std::span<const double> y = trace.column(name, wheel);
    // Signals of one unit share a panel: what was and what was commanded lie over each other.
    auto panel = std::ranges::find(chart.panels, unit, &ChartPanel::unit);
    if (panel == chart.panels.end()) panel = chart.panels.insert(panel, {unit, {}});
    panel->curves.push_back({std::string(name), {y.begin(), y.end()}});
  }
  return line_chart(chart);
}

}  // namespace omnihil
