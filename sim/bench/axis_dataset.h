// A simulated bench's afternoon as text in the measurement format "omnihil-dataset/1", rig "axis".
//
//   AxisBench bench{.title = "…", .model = model, .runs = {{"steps", "fit", "steps", input, samples}}};
//   dataset_text(bench); axis_model_text(bench.model); run_csv(bench, bench.runs[0]);
//
// Columns: what was asked, bus voltage and current with noise, encoder counts rounded down (or position and
// velocity with noise where there is no encoder), winding temperature where the model has one.
// The model that goes with it is the nominal one: effects added for this run are what the data are to show.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "sim/bench/axis_sim.h"
#include "sim/model/axis_model.h"

namespace omnihil {

struct AxisBenchRun {
  std::string name;        // of the CSV, without .csv
  std::string use;         // "fit", "holdout", "extrapolation"
  std::string excitation;  // free text
  AxisInput input;
  std::vector<AxisSample<double>> samples;
  std::uint64_t seed = 0;  // of its noise
};

struct AxisBench {
  std::string title;
  AxisModel model;
  std::vector<AxisBenchRun> runs;
  double noise_scale = 1.0;      // of the usual sensors; 0: none
  bool has_temperature = false;  // some effect models the winding's temperature
};

std::string dataset_text(const AxisBench& bench);
std::string run_csv(const AxisBench& bench, const AxisBenchRun& run);
// The base parameters and the effects of the model's own file, flattened into one text.
std::string axis_model_text(const AxisModel& model);

}  // namespace omnihil
