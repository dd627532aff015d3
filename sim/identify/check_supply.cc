// The measured bus voltage against the supply that the model names.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/identify/check_list.h"

namespace omnihil {

void check_supply(const CheckContext& data, std::vector<DataFinding>& findings) {
  constexpr double kLeast = 0.10;  // relative: a battery's state of charge moves it by less
  const auto nominal_V = nominal_value(data.nominal, "supply.voltage_V");
  if (!nominal_V) return;
  const double allowed = std::max(kLeast, 4.0 * tolerance_of(data.nominal, "supply.voltage_V"));
  for (const RunView& view : data.runs) {
    const std::vector<double>* bus = view.run->signal("bus_voltage");
    if (bus == nullptr) continue;
    const double highest_V = quantile_of(*bus, 0.9);  // unloaded moments: the supply itself
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
