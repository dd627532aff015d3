// A tapped evening as a measurement: what the host asked one robot, what the robot told, and what the cameras saw beside it.
//
//   DatasetExport made = tapped_dataset(recording, format, {.robot = 3, .model_text = text, .vision_csv = csv});
//
// `vision_csv`: the table that `tap --vision` writes (hil/tap/tap_vision.h), its times on the recording's clock; empty: none.
// Velocities in the field's frame are turned back by the heading that the robot tells, else the cameras' (run_log.h).
// Commands to a heading, of duties, and of another kind than most are left out and counted. The last third is held out.
// Throws std::invalid_argument when no command of the robot can be told by a dataset. Cannot: leave out what is no driving
// (the robot carried, or in a scrum): cut the recording before.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "hil/acquire/run_log.h"
#include "hil/dataset/dataset_export.h"
#include "hil/recording/heard_commands.h"

namespace omnihil {

struct TappedOptions {
  int robot = 0;
  std::string model_text;
  std::string vision_csv{};
  double holdout_ratio = 1.0 / 3.0;
};

// A command as a dataset tells it; none: it cannot (to a heading, of duties).
std::optional<std::pair<PlanDrive, SentCommand>> told_by_dataset(const HeardCommand& heard);

// False: a bench's recording, with samples of its own.
bool is_tapped(const Recording& recording);

DatasetExport tapped_dataset(const Recording& recording, const RadioFormat& format,
                             const TappedOptions& options);

}  // namespace omnihil
