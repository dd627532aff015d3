// Writes a run to disk while it goes on: an observer of the session, in the format of hil/recording/recording.h.
//
//   std::error_code error;
//   auto writer = RecordingWriter::open("drive.omnirec", header, error);
//   session.set_observer(writer.get());
//   // … the session goes its steps …
//   writer->finish({.now_ns = session.now_ns(), .wall_s = 12.5, .counters = {{"host packets good", 120}}});
//
// A write that fails (disk full, device gone) ends the recording, not the run: it is reported once through
// `report` and kept in error(). A killed run is readable up to the last simulated second at least.
// Cost: about 6 µs per `s` line: 0.4 % of a core for six robots at 1 kHz with every 10th tick, 4 % with every one.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "hil/recording/recording.h"
#include "hil/recording/recording_decimation.h"

namespace omnihil {

class RecordingWriter : public SessionObserver {
 public:
  using Report = std::function<void(const std::string&)>;

  // Writes the header at once; columns, units and an empty `started` are filled in. Null and `error` on
  // failure.
  static std::unique_ptr<RecordingWriter> open(const std::filesystem::path& path, RecordingHeader header,
                                               std::error_code& error, Report report = {});
  ~RecordingWriter() override;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

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

  // A line that a robot's board said, at the instant that the session is at. `port` is one word, `line` printable.
  void console_line(std::int64_t now_ns, int robot_id, int board, std::string_view port,
                    std::string_view line);

  // Writes what is buffered.
  void flush();
  // The end line; nothing may follow. Without it the recording counts as cut off.
  void finish(const RecordingEnd& end);

  std::error_code error() const { return error_; }
  std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  RecordingWriter(int fd, std::filesystem::path path, RecordingHeader header, Report report);
  // robot_id below 0: none on the line.
  void input(char tag, std::int64_t now_ns, int robot_id, std::span<const double> values);
  void chunk(char tag, std::int64_t now_ns, std::span<const std::uint8_t> bytes);
  void end_line(std::int64_t now_ns);
  void fail(int error_number);

  int fd_;
  std::filesystem::path path_;
  Report report_;
  std::string buffer_;
  SampleDecimation decimation_;
  std::int64_t flushed_ns_ = 0;
  std::int64_t next_ball_ns_ = 0;
  std::size_t watched_ = 0;  // values of variables per sample
  std::uint64_t bytes_written_ = 0;
  std::error_code error_;
};

}  // namespace omnihil
