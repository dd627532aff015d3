// The virtual bench behind `omnihil sim`: reads the model, drives it, gives the files of a dataset.
//
//   std::vector<std::string> faults;
//   std::optional<AxisBench> bench = make_bench(options, faults);      // none: every fault is in `faults`
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/bench/axis_dataset.h"

namespace omnihil {

struct BenchOptions {
  std::string model;
  std::vector<std::string> excitations;  // names, or CSV files of time and command
  std::vector<std::string> with;         // effects added: ID, ID.parameter=value
  std::string drive;                     // drive input; empty: what the model suggests
  double amplitude = 0.6;                // of the drive input, in its unit
  double duration_s = 20.0;
  double rate_Hz = 1000.0;
  double step_s = 50e-6;
  std::uint64_t seed = 0;
  double noise_scale = 1.0;  // of the usual sensors; 0: none
};

std::optional<AxisBench> make_bench(const BenchOptions& options, std::vector<std::string>& faults);

}  // namespace omnihil
