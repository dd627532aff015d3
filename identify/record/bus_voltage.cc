#include "identify/record/bus_voltage.h"

#include "identify/record/dataset.h"
#include "identify/record/statistics.h"

namespace omnihil {

std::vector<double> plausible_bus_voltage(std::vector<double> measured_V) {
  // Of the run's median. A choice: between what a supply gives (a full cell 4.2 V for 3.7 V nominal) and the
  // faulty readings that were met, twice the supply; sensitivity not measured.
  constexpr double kHighest = 1.5;  // a choice
  const double median_V = median(finite_values(measured_V));
  if (median_V <= 0.0) return measured_V;
  for (double& v : measured_V) {
    if (v > kHighest * median_V) v = kMissing;
  }
  return measured_V;
}

}  // namespace omnihil
