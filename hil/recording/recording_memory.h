// Keeps a run in memory, as RecordingWriter keeps it on disk: what a replay gives back for comparison.
//
//   RecordingMemory memory(header);
//   session.set_observer(&memory);
//   // … the session goes its steps …
//   Recording answer = memory.take(session.now_ns());
//
// About 670 bytes per kept sample: 0.4 MB per simulated second for six robots at 1 kHz, every 10th kept.
#pragma once
#include "hil/recording/recording.h"
#include "hil/recording/recording_decimation.h"

namespace omnihil {

class RecordingMemory : public SessionObserver {
 public:
  explicit RecordingMemory(RecordingHeader header);

  void host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void robot_tick(std::int64_t now_ns, const RobotSample& sample) override;
  void host_closed(std::int64_t now_ns) override;
  void command(std::int64_t now_ns, int robot_id, const RobotCommand& command) override;
  void placed(std::int64_t now_ns, int robot_id, double x_m, double y_m, double yaw_rad) override;
  void field_input(std::int64_t now_ns, FieldInput kind, int robot_id,
                   std::span<const double> values) override;
  void opponents_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) override;
  void world(std::int64_t now_ns, const World& world) override;

  Recording take(std::int64_t end_ns);  // complete; this object is empty afterwards

 private:
  RecordedChunk& add(RecordedChunk::Kind kind, std::int64_t now_ns);

  SampleDecimation decimation_;
  std::int64_t next_ball_ns_ = 0;
  Recording recording_;
};

// The header with the columns and units that samples get here.
RecordingHeader with_sample_columns(RecordingHeader header);

}  // namespace omnihil
