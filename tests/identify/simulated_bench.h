// A simulated afternoon at the bench, read back as a dataset: what a sound measurement looks like.
//
//   Bench bench = simulated_bench({.drive = CommandKind::kDuty, .with = {"cogging"}});
//   check_data(bench.dataset, bench.nominal);
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sim/bench/axis_dataset.h"
#include "sim/bench/excitation.h"
#include "sim/model/effect_reader.h"
#include "tests/identify/dataset_folder.h"

namespace omnihil {

struct BenchRecipe {
  CommandKind drive = CommandKind::kDuty;
  std::string drive_name = "duty";
  double amplitude = 0.6;
  std::vector<std::string> with;  // effects hidden in it
  std::vector<Excitation> excitations{Excitation::kSteps, Excitation::kChirp, Excitation::kPrbs};
  double duration_s = 8.0;
  double counts_per_turn = 4096.0;
  std::uint64_t seed = 1;
  std::string model;  // empty: a drive of the size of a robot's wheel
};

inline constexpr const char* kWheelModel =
    "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\n"
    "resistance_ohm = { value = 0.464, tolerance = 0.1 }\ninductance_H = { value = 0.000322, tolerance = 0.2 "
    "}\n"
    "torque_constant_Nm_per_A = { value = 0.0335, tolerance = 0.05 }\npole_pairs = 8\nslots = 12\n"
    "rotor_inertia_kg_m2 = { value = 1.35e-5, tolerance = 0.1 }\n"
    "viscous_friction_Nm_s_per_rad = { value = 2e-6, tolerance = 1.0 }\n[gear]\nratio = 3.0\n"
    "[load]\ninertia_kg_m2 = { value = 4.6e-5, tolerance = 0.1 }\n[supply]\n"
    "voltage_V = { value = 24.0, tolerance = 0.01 }\n[effects.coulomb_friction]\n"
    "torque_Nm = { value = 2.5e-3, tolerance = 0.5 }\n";

struct Bench {
  Dataset dataset;
  Candidate nominal;
};

inline Bench simulated_bench(const BenchRecipe& recipe) {
  const std::string text = recipe.model.empty() ? kWheelModel : recipe.model;
  AxisReading reading = read_axis_model(text, "model.toml", {});
  EXPECT_TRUE(reading.model) << all_text(reading.problems);
  AxisModel model = *reading.model;
  model.encoder_counts_per_turn = recipe.counts_per_turn;
  std::vector<EffectUse> effects = model.effects;
  for (const std::string& with : recipe.with) {
    EXPECT_EQ(add_override(with, {.drive = &model.drive, .linear = model.drive.linear}, effects), "") << with;
  }
  AxisBench bench{.title = "simulated", .model = model, .runs = {}};
  for (std::size_t r = 0; r < recipe.excitations.size(); ++r) {
    AxisInput in;
    in.kind = recipe.drive;
    in.encoder_counts_per_turn = recipe.counts_per_turn;
    in.noise_seed = recipe.seed + r;
    const ExcitationOptions options{.duration_s = recipe.duration_s, .seed = recipe.seed + r};
    for (double t = 0.0; t < recipe.duration_s; t += 1e-3) {
      in.time_s.push_back(t);
      in.command.push_back(recipe.amplitude * excitation_at(recipe.excitations[r], t, options));
    }
    auto samples = run_axis<double>(model.drive, EffectSet<double>(effects), in, {.step_s = 1e-4});
    const bool last = r + 1 == recipe.excitations.size();
    bench.runs.push_back({"run_" + std::to_string(r), last ? "holdout" : "fit", "simulated", in,
                          std::move(samples), recipe.seed + 10 * r});
  }
  DatasetFolder folder;
  folder.write("dataset.toml", dataset_text(bench));
  folder.write("model.toml", text);
  for (const AxisBenchRun& run : bench.runs) folder.write(run.name + ".csv", run_csv(bench, run));
  DatasetReading read = read_dataset(folder.path());
  EXPECT_TRUE(read.dataset) << all_text(read.problems);
  return {std::move(*read.dataset), std::move(*read.nominal)};
}

}  // namespace omnihil
