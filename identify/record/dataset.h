// A measurement as the identification sees it: runs of named signals on their own clocks, in the units of the
// format "omnihil-dataset/1". Read from files by hil/dataset/dataset_reader.h; nothing here touches a file.
//
//   const Run& run = dataset.runs[0];
//   const std::vector<double>* w = run.signal("velocity");      // null: not measured in this run
//
// Values are as measured: scaled by the channel, neither filtered nor repaired.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();  // a sample that there is not

struct Rig;  // what is driven: identify/record/rig.h
const Rig& rig_axis();

// Which part a run plays in cross-validation. The file format calls them "fit", "holdout", "extrapolation".
// Unscoped on purpose: a split is also the index of arrays that hold one thing per split.
enum Split : std::uint8_t {
  kTraining,       // to estimate parameters and to choose effects
  kValidation,     // same kind of motion, never estimated on: decides whether an effect stays
  kExtrapolation,  // another kind of motion: an effect that makes this worse is rejected
};
inline constexpr int kSplits = 3;          // of the enum above
std::string_view split_name(Split split);  // as the file format has it: "fit", "holdout", "extrapolation"

struct Channel {
  std::string signal;  // "velocity", "encoder_2"
  std::string column;
  std::string unit;            // of the signal, on this rig: "rad/s", on a linear axis "m/s"
  double sigma = 0.0;          // 1-sigma sensor noise; 0: not stated
  double clock_sigma_s = 0.0;  // of a clock of its own, by which it is off in each run; 0: the run's clock
  double scale = 1.0;
  double offset = 0.0;
  double counts_per_rev = 0.0;  // encoders
  bool on_output = false;       // the encoder's shaft
  bool imposed = false;         // set by the bench: taken as given, not predicted
  int line = 0;                 // in dataset.toml
};

struct Run {
  std::string file;
  Split split = Split::kTraining;
  std::string excitation;
  bool steady = false;                                // independent settled points instead of a time series
  std::vector<std::pair<std::string, double>> known;  // model parameters by path, for this run alone
  std::vector<double> time_s;                         // increasing; n samples
  std::map<std::string, std::vector<double>, std::less<>> signals;  // n samples each, in Channel::unit

  const std::vector<double>* signal(std::string_view name) const;
  double duration_s() const { return time_s.empty() ? 0.0 : time_s.back() - time_s.front(); }
};

// Median of the n - 1 differences of n time stamps; 0: fewer than two.
double median_period_s(const std::vector<double>& time_s);

class FirmwareSource;  // identify/predict/firmware_source.h

struct Dataset {
  std::string name;  // as it was asked for
  std::string title;
  const Rig* rig = &rig_axis();
  bool linear = false;  // of its model
  std::vector<Channel> channels;
  std::vector<Run> runs;
  bool heard = false;  // commands are those that the robot heard, not those that were sent (heard_commands.h)
  std::vector<std::string> notes;  // what was left out, counted; what a reader should know
  // What made duties of the commands that a robot was driven by; null: the model's [controller].
  std::shared_ptr<const FirmwareSource> firmware;

  const Channel* channel(std::string_view signal) const;
  bool has(Split split) const;
};

}  // namespace omnihil
