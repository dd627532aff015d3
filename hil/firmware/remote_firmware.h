// A real board on the desk as the firmware of a robot: sensors go out over a serial line or CAN, the
// drive comes back.
//
//   Session session(config, remote_firmware({.url = "serial:/dev/ttyACM0?baud=921600"}, config));
//
// Real time (serve): the loop never waits. A drive that has come by the next control period is in force from
// then on, so the board adds at least one period of delay, as its own sampling would. Lock-step (virtual
// time: scenario, serve --clock free): each period waits for its answer; the run is as repeatable as the
// board. Time-out: no answer for 50 ms (real time), or none to a period within 100 ms (lock-step): the wheels
// coast and it is counted; with the next answer they drive again. A device that goes away, or 20 periods in a
// row without an answer in lock-step, end the firmware (failure()). Three-phase bridges are driven by duty.
// Frames and their bytes: docs/remote-mcu.md.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/firmware/remote_link.h"
#include "hil/loop/session.h"

namespace omnihil {

struct RemoteChoice {
  std::string url;         // of any wire (hil/wire/wire_url.h); {id}: the robot's number
  bool lock_step = false;  // virtual time
};

// Throws std::invalid_argument naming every problem; the maker does when a board does not answer.
Session::FirmwareMaker remote_firmware(const RemoteChoice& choice, const SessionConfig& session);

class RemoteFirmware final : public Firmware {
 public:
  RemoteFirmware(RemoteLink link, RemoteHello hello, bool lock_step);

  std::string_view name() const override { return hello_.name; }
  std::string_view radio_format() const override { return hello_.radio_format; }
  std::int64_t control_period_ns() const override { return hello_.control_period_ns; }
  void command(const RobotCommand& command, std::int64_t) override { link_.send_command(command); }
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t) override { link_.send_radio(frame); }
  std::size_t radio_transmit(std::span<std::uint8_t> out) override;
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override { return feedback_; }
  std::string_view failure() const override { return failure_; }
  std::uint64_t missed_control_periods() const override { return missed_; }
  std::vector<std::string> report() const override;

  const RemoteLink& link() const { return link_; }
  std::uint64_t timeouts() const { return timeouts_; }

 private:
  bool fresh();

  RemoteLink link_;
  RemoteHello hello_;
  bool lock_step_;
  std::string failure_;
  RobotFeedback feedback_{};
  std::uint64_t kicked_for_ = 0;  // the drive whose kick has been passed on
  std::uint64_t missed_ = 0;      // periods that ran on an older drive, or on none
  std::uint64_t timeouts_ = 0;    // times the wheels were let go
  bool timed_out_ = true;         // nothing is in force; at the start, too
  int missed_in_a_row_ = 0;
};

}  // namespace omnihil
