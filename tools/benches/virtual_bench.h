// The virtual benches behind `omnihil sim`: a model is read, driven, and what its sensors show is written as a dataset.
//
//   std::vector<std::string> faults;
//   std::optional<VirtualBench> bench = make_axis_bench(options, faults);   // none: every fault is in `faults`
//   for (const DatasetFile& file : bench->files) folder.write(file.name, file.text);
//
// An excitation by name gives a run to fit and one held out, with a pattern of its own and 0.8 of the amplitude; of a CSV
// file the last third is held out. The model that goes with the data is the nominal one: effects added for this run are
// what the data are to show.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hil/dataset/dataset_export.h"
#include "hil/loop/model_store.h"
#include "sim/bench/excitation.h"

namespace omnihil {

struct BenchOptions {
  std::string model;
  std::vector<std::string> excitations;  // names, or CSV files of time and what is asked
  std::vector<std::string> with;         // effects added: ID, ID.parameter=value
  std::string drive;                     // drive input; empty: what the model suggests
  double amplitude = 0.6;                // of the drive input, in its unit
  double duration_s = 20.0;
  double rate_Hz = 1000.0;
  double step_s = 50e-6;
  std::uint64_t seed = 0;
  double noise_scale = 1.0;  // of the usual sensors; 0: none
};

struct VirtualBench {
  std::vector<DatasetFile> files;  // dataset.toml, model.toml, runs
  std::size_t rows = 0;
  std::size_t runs = 0;
  std::string diverged;  // which run and where; empty: none did
};

// One drive on a bench.
std::optional<VirtualBench> make_axis_bench(const BenchOptions& options, std::vector<std::string>& faults);
// A whole robot on the floor, by the plant. Duties of an excitation by name change no faster than half of the tyre's grip
// lets the robot follow; a file's (time and a duty per wheel, or time and one that is driven straight ahead) are taken as
// they are. An excitation by name drives forward, sideways and turn at once, each by a pattern of its own. Sensors have
// white noise of a known size on top; a camera frame comes 60 times a second.
std::optional<VirtualBench> make_robot_bench(const BenchOptions& options, std::vector<std::string>& faults);
// One wheel of a robot, its body moved forward and sideways by patterns of their own, no faster than half of the tyre's grip
// would; the duty is the one that rolls with it, and a push by the excitation on top: --amplitude of the duty that slips the
// tyre at standstill. The motion is the rig's own (predictor_wheel.h): what it cannot, these data do not show.
std::optional<VirtualBench> make_wheel_bench(const BenchOptions& options, std::vector<std::string>& faults);

// ---- What they share

// By name, and where its input comes from.
template <typename Input>
struct BenchRun {
  std::string name, use, excitation;
  Input input;
};

// Rows of a CSV file: a time that increases, and as many numbers as one of `widths` says; the first line may be a header.
// `needed`: the words for it.
struct BenchRow {
  double time_s = 0.0;
  std::vector<double> values;
};
std::vector<BenchRow> read_bench_rows(const std::string& path, std::span<const std::size_t> widths,
                                      const std::string& needed, std::vector<std::string>& faults);

// Names of excitations, and numbers.
void check_bench_numbers(const BenchOptions& options, std::vector<std::string>& faults);
// The robot's model of a bench of it, or of one of its wheels, nominal and with the effects of --with in it; the numbers are
// checked as well. None: every fault is in `faults`.
struct BenchRobot {
  StoredModel nominal;  // has a model
  ModelReading driven;  // has one
};
std::optional<BenchRobot> open_robot(const BenchOptions& options, std::vector<std::string>& faults);

// A line of [channels]; `more`: further keys, ", counts_per_rev = 4096".
std::string channel_line(const std::string& signal, const std::string& column, double sigma,
                         const std::string& more = "");
std::string run_lines(const std::string& name, const std::string& use, const std::string& excitation);
std::string dataset_head(const std::string& title, const std::string& rig);

// excited(kind, scale, seed), read(path), part(input, from, to), of which size(input) there are.
template <typename Input, class Excited, class Read, class Part, class Size>
std::vector<BenchRun<Input>> bench_runs(const BenchOptions& o, std::vector<std::string>& faults,
                                        Excited excited, Read read, Part part, Size size) {
  constexpr double kHoldoutRatio = 1.0 / 3.0;  // of a file's time, at its end
  constexpr double kHoldoutAmplitude = 0.8;    // of the fit run's
  std::vector<BenchRun<Input>> runs;
  for (const std::string& e : o.excitations) {
    if (const auto kind = find_excitation(e)) {
      runs.push_back({e, "fit", e, excited(*kind, 1.0, o.seed)});
      runs.push_back({e + "_holdout", "holdout", e, excited(*kind, kHoldoutAmplitude, o.seed + 1)});
    } else {
      const Input all = read(e);
      const auto cut = static_cast<std::size_t>(static_cast<double>(size(all)) * (1.0 - kHoldoutRatio));
      const std::string stem = std::filesystem::path(e).stem().string();
      runs.push_back({stem, "fit", e, part(all, 0, cut)});
      runs.push_back({stem + "_holdout", "holdout", e, part(all, cut, size(all))});
    }
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (runs[i].name == runs[j].name) faults.push_back("--excite " + runs[i].name + ": given twice");
    }
  }
  return runs;
}

}  // namespace omnihil
