// The measured bus voltage: readings that no supply gives, and the level against the supply that the model
// names.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/checks/check_list.h"
#include "identify/record/bus_voltage.h"

namespace omnihil {
namespace {

void find_impossible(const RunView& view, const std::vector<double>& measured_V,
                     const std::vector<double>& plausible_V, std::vector<DataFinding>& findings) {
  std::size_t count = 0, first = 0;
  double highest_V = 0.0;
  for (std::size_t k = 0; k < measured_V.size(); ++k) {
    if (!std::isfinite(measured_V[k]) || std::isfinite(plausible_V[k])) continue;
    if (count++ == 0) first = k;
    highest_V = std::max(highest_V, measured_V[k]);
  }
  if (count == 0) return;
  findings.push_back(
      {DataFinding::Grade::kDoubt, "glitch", view.run->file, "bus_voltage", highest_V,
       fmt::format("bus_voltage reads up to {:.4g} V in {} rows (first at {:.4f} s), {:.3g} times "
                   "its median: no supply rises so; the last value before stands there",
                   highest_V, count, view.run->time_s[first], highest_V / median_of(measured_V))});
}

}  // namespace

void check_supply(const CheckContext& data, std::vector<DataFinding>& findings) {
  // Relative to nominal. A choice: a cell of 3.7 V stays within from 3.4 V to 4.0 V; freshly charged, at 4.2
  // V, it is worth a sentence. Or 4 prior deviations (p = 6e-5 of a normal), where the model's tolerance is
  // wider.
  constexpr double kLeast = 0.10;  // a choice
  const auto nominal_V = nominal_value(data.nominal, "supply.voltage_V");
  const double allowed = std::max(kLeast, 4.0 * tolerance_of(data.nominal, "supply.voltage_V"));
  for (const RunView& view : data.runs) {
    const std::vector<double>* bus = view.run->signal("bus_voltage");
    if (bus == nullptr) continue;
    const std::vector<double> plausible_V = plausible_bus_voltage(*bus);
    find_impossible(view, *bus, plausible_V, findings);
    const double highest_V = quantile_of(plausible_V, 0.9);  // unloaded moments: the supply itself
    if (!nominal_V) continue;
    const double off = highest_V / *nominal_V - 1.0;
    if (std::abs(off) < allowed) continue;
    findings.push_back(
        {DataFinding::Grade::kDoubt, "wrong_supply", view.run->file, "bus_voltage", highest_V,
         fmt::format("bus_voltage is {:.4g} V, the model's supply.voltage_V says {:.4g}: one of them "
                     "is wrong; where both are there the measured one holds",
                     highest_V, *nominal_V)});
  }
}

}  // namespace omnihil
