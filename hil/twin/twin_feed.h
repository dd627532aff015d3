// What passes between a host and its dongle, as pieces of a run for the twin: one robot's commands and what it tells, by time.
//
//   TwinFeed feed(format, {.robot_ids = {3}, .robot = 3});
//   feed.host_bytes(now_ns, bytes);  feed.dongle_bytes(now_ns, bytes);          // as a tap's observer
//   while (std::optional<Run> piece = feed.next(now_ns)) twin.advance(*piece);
//
// Rows are those of a tapped dataset (hil/acquire/run_log.h), so that live and afterwards the same rows come out. A piece begins with
// the last row of the one before, and is given out kLag_s late: velocities in the field's frame are turned by a heading that is told
// after them. Commands of other kinds than the first that can be told are left out and counted.
#pragma once
#include <optional>

#include "hil/acquire/tapped_dataset.h"
#include "hil/loop/session.h"
#include "hil/recording/stream_frames.h"
#include "identify/record/dataset.h"

namespace omnihil {

struct TwinFeedOptions {
  std::vector<int> robot_ids;  // that are on the field
  Team team = Team::kBlue;
  int robot = 0;
  std::int64_t step_ns = 1'000'000;
  double piece_s = 0.5;
};

class TwinFeed : public SessionObserver {
 public:
  TwinFeed(const RadioFormat& format, const TwinFeedOptions& options);
  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  std::optional<Run> next(std::int64_t now_ns);

  std::uint64_t left_out() const { return left_out_; }
  std::uint64_t commands() const { return commands_; }
  std::uint64_t told() const { return told_; }

 private:
  void hear(std::int64_t now_ns);
  void forget(double before_s);

  const RadioFormat& format_;
  TwinFeedOptions options_;
  CommandListener listener_;
  FrameCutter cutter_;
  RunLog log_;
  std::optional<PlanDrive> drive_;
  std::optional<double> from_s_;  // of the next piece: the last row of the one before
  std::int64_t heard_ns_ = 0;
  std::uint64_t left_out_ = 0, commands_ = 0, told_ = 0;
};

// Rows as a run with a dataset's signals, on the log's own clock.
Run run_of_rows(const RunRows& rows);

}  // namespace omnihil
