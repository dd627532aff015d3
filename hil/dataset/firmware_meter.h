// Simulations with a dataset's firmware in their loop, counted and timed, with what made it fail.
//
//   FirmwareMeter meter(dataset);                      // whose firmware is metered from here on
//   predictor->predict(candidate, 0);
//   meter.seen().simulations, meter.seen().wall_s;     // 1, …
//
// A simulation is of one run, from its firmware's first tick until it is let go; its time is all that passed then, the robot's
// and other processes' included. On several threads times add up. Bits of predictions are those without a meter.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "identify/record/dataset.h"

namespace omnihil {

struct FirmwareUse {
  std::int64_t simulations = 0, failed = 0;
  double wall_s = 0.0, simulated_s = 0.0;  // of all of them
  std::string failure;                     // the first one's
};

class FirmwareMeter {
 public:
  explicit FirmwareMeter(Dataset& dataset);
  FirmwareUse seen() const;  // nothing where the dataset has no firmware

 private:
  struct Shared;
  class Metered;
  class Source;
  std::shared_ptr<Shared> shared_;
};

}  // namespace omnihil
