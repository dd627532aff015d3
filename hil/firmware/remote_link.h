// The bench's end of the line to a board: frames of remote_frame.h out and in, and how long answers took.
//
//   RemoteLink link({std::move(wire), 4096});
//   RemoteHello answer;
//   if (!link.hello(robot_config, answer, problem)) …                         // what came instead
//   link.send_sensors(sensors);
//   link.poll();  link.drive();                  // the newest drive that came, and which sensors it answers
//
// Times are of this computer's clock: from the call that sends sensors to the poll that finds their answer.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/remote_shim/remote_frame.h"
#include "firmware_iface/robot_io.h"
#include "hil/loop/clock_lateness.h"
#include "hil/wire/buffered_wire.h"

namespace omnihil {

struct RemoteHello {
  std::string name, radio_format;
  std::int64_t control_period_ns = 0;
};

struct RemoteCounts {
  std::uint64_t sensors_sent = 0, line_full = 0;
  std::uint64_t drives = 0;        // answers to sensors that still waited for one
  std::uint64_t out_of_order = 0;  // drives for sensors that were answered, or given up, before
  std::uint64_t bad_payload = 0;   // good checksum, wrong size or value: not acted on
  std::uint64_t unknown_type = 0;
};

class RemoteLink {
 public:
  static constexpr int kWindow = 256;  // sensors that may wait for an answer; older ones count as lost
  explicit RemoteLink(BufferedWire line) : line_(std::move(line)) {}

  // Asks until the board answers, 3 s at most. False: `problem` says what came instead.
  bool hello(const RobotConfig& config, RemoteHello& answer, std::string& problem);
  void send_sensors(const RobotSensors& sensors);
  void send_command(const RobotCommand& command);
  void send_radio(std::span<const std::uint8_t> frame);
  void poll();
  void wait(std::int64_t at_most_ns) { line_.wait(at_most_ns); }

  const RobotDrive& drive() const { return drive_; }
  std::uint64_t drive_answers() const { return drive_answers_; }  // number of the sensors, from 1; 0: none
  std::int64_t drive_at_ns() const { return drive_at_ns_; }       // of this computer's clock
  std::uint64_t sensors_number() const { return counts_.sensors_sent; }
  std::vector<std::vector<std::uint8_t>>& radio() { return radio_; }

  const RemoteCounts& counts() const { return counts_; }
  const omnihil_remote_decoder& decoder() const { return decoder_; }
  const LatenessHistogram& round_trip() const { return round_trip_; }
  const LatenessHistogram& board_time() const { return board_time_; }
  std::string_view failure() const { return line_.failure(); }

 private:
  void send(std::uint8_t type, std::uint16_t sequence, std::span<const std::uint8_t> payload);
  void take(const omnihil_remote_frame& frame);
  void take_hello(const omnihil_remote_frame& frame);
  void take_drive(const omnihil_remote_frame& frame);

  BufferedWire line_;
  std::vector<std::uint8_t> bytes_;  // of one read
  omnihil_remote_decoder decoder_{};
  std::array<std::int64_t, kWindow> sent_ns_{};  // by number; 0: nothing waits
  RobotDrive drive_{};
  std::uint64_t drive_answers_ = 0;
  std::int64_t drive_at_ns_ = 0;
  std::vector<std::vector<std::uint8_t>> radio_;
  RemoteHello hello_;
  bool greeted_ = false;
  RemoteCounts counts_;
  LatenessHistogram round_trip_, board_time_;
};

}  // namespace omnihil
