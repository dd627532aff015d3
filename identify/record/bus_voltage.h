// A measured bus voltage without the readings that no supply gives.
//
//   std::vector<double> bus = plausible_bus_voltage(*run.signal("bus_voltage"));   // NaN where it cannot be
//
// In and out: n samples in V, NaN where missing.
// Law: a bus sags under load and goes off, but nothing lifts it by half: regeneration ends at the limit of
// the supply or of the bridge. A reading above 1.5 times the run's median is a fault of the sensor or of its
// transfer. Limits: a fault in more than half of a run moves the median and is not seen here (check_supply.cc
// compares it with the model's supply); readings that are too low are taken as they are.
#pragma once
#include <vector>

namespace omnihil {

std::vector<double> plausible_bus_voltage(std::vector<double> measured_V);

}  // namespace omnihil
