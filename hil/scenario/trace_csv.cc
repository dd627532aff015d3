#include "hil/scenario/trace_csv.h"

#include <fmt/format.h>

namespace omnihil {

std::string trace_csv(const ScenarioTrace& trace) {
  std::string text = "time_s";
  std::vector<std::span<const double>> columns;
  for (const ScenarioSignal& signal : scenario_signals()) {
    for (std::size_t w = 0; w < (signal.of_wheels ? kWheels : 1); ++w) {
      text += signal.of_wheels ? fmt::format(",{}_{}", signal.name, w) : fmt::format(",{}", signal.name);
      columns.push_back(trace.column(signal.name, w));
    }
  }
  for (const std::string& variable : trace.variables()) {
    const std::string name = std::string(kVariablePrefix) + variable;
    text += name.find_first_of(",\"") == std::string::npos ? "," + name : ",\"" + name + "\"";
    columns.push_back(trace.column(name));
  }
  const std::span<const double> time_s = trace.time_s();
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    text += fmt::format("\n{}", time_s[i]);
    for (const auto& column : columns) text += fmt::format(",{}", column[i]);
  }
  return text + "\n";
}

}  // namespace omnihil
