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
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hil/dataset/dataset_export.h"
#include "hil/loop/model_store.h"
#include "identify/record/rig.h"
#include "sim/bench/dataset_text.h"
#include "sim/bench/excitation.h"
#include "sim/model/axis_model.h"

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
// Any rig whose table has a bench (identify/record/rig.h).
std::optional<VirtualBench> make_rig_bench(const Rig& rig, const BenchOptions& options,
                                           std::vector<std::string>& faults);

// ---- What they share

// What is asked of a bench at a time: of an axis its drive input, of a robot its duties.
struct BenchRow {
  double time_s = 0.0;
  std::vector<double> values;
};
// By name, and where its input comes from.
struct BenchRun {
  std::string name, use, excitation;
  std::vector<BenchRow> input;
};

// Rows of a CSV file: a time that increases, and as many numbers as one of `widths` says; the first line may be a header.
// `needed`: the words for it.
std::vector<BenchRow> read_bench_rows(const std::string& path, std::span<const std::size_t> widths,
                                      const std::string& needed, std::vector<std::string>& faults);
// Rows at the bench's rate, values(t) each.
std::vector<BenchRow> bench_rows(const BenchOptions& options,
                                 const std::function<std::vector<double>(double)>& values);
// excited(kind, scale, seed), read(path).
std::vector<BenchRun> bench_runs(
    const BenchOptions& options, std::vector<std::string>& faults,
    const std::function<std::vector<BenchRow>(Excitation, double, std::uint64_t)>& excited,
    const std::function<std::vector<BenchRow>(const std::string&)>& read);

// Names of excitations, and numbers.
void check_bench_numbers(const BenchOptions& options, std::vector<std::string>& faults);
// The robot's model of a bench of it, or of one of its wheels, nominal and with the effects of --with in it; the numbers are
// checked as well. None: every fault is in `faults`.
struct BenchRobot {
  StoredModel nominal;  // has a model
  ModelReading driven;  // has one
};
std::optional<BenchRobot> open_robot(const BenchOptions& options, std::vector<std::string>& faults);

// An axis' model, nominal, and the effects that drive it: its own and those of --with. None, or faults: as above.
struct BenchAxis {
  AxisModel nominal;
  std::vector<EffectUse> driven;
};
std::optional<BenchAxis> open_axis(const BenchOptions& options, std::vector<std::string>& faults);

std::string bench_dataset(const std::string& title, const std::string& rig,
                          const std::vector<BenchColumn>& columns, const std::vector<BenchRun>& runs);

}  // namespace omnihil
