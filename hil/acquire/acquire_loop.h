// Runs of a plan on the wall clock: packets out through a wire, answers and camera frames in, the stop packet whatever happens.
//
//   Acquirer acquirer({.wire = *dongle, .format = format, .to = {.robot_id = 3}, .vision = &group}, plan);
//   RunEnd end = acquirer.run(plan.runs[0], [] { return StopSignals::requested(); });
//   end.problem;                                  // empty: it ran to its end
//   rows_csv(run_rows(end.log, plan.drive));
//
// All runs of an Acquirer have one clock, from when it was made, and one line per camera. A run that is left by an exception sends
// its stop packets on the way out. A format whose commands are in the field's frame alone is asked for the body's velocity
// turned by the newest heading: told by the robot, else seen. Cannot: formats that want a handshake first (A-Team's).
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "hil/acquire/run_driver.h"
#include "hil/acquire/run_log.h"
#include "hil/league/udp_port.h"
#include "hil/recording/stream_frames.h"
#include "hil/wire/byte_wire.h"
#include "hil/wire/send_queue.h"

namespace omnihil {

struct AcquireEnds {
  ByteWire& wire;
  const RadioFormat& format;
  CommandTo to;
  UdpPort* vision = nullptr;  // not owned; null: no cameras
};

struct RunEnd {
  RunLog log;
  std::string problem;  // why it was stopped; empty: at its end
  bool wire_lost = false;
  std::string packets;               // "TIME_S > HEX" and "<": as `omnihil import` reads it
  std::uint64_t not_understood = 0;  // bytes
  int left_out = 0;                  // packets of the plan that were too late
  double latest_s = 0.0;             // the most that a packet was written after its time
};

// Frames that ask a robot for this; false: the format cannot say it, in the robot's frame or turned by `yaw_rad`.
struct SaidCommand {
  std::vector<std::uint8_t> bytes;
  SentCommand sent;
};
bool say_planned(const RadioFormat& format, const CommandTo& to, PlanDrive drive,
                 const std::array<double, kWheels>& value, double yaw_rad, SaidCommand& out);

// What of a plan the format cannot say, a line each; empty: all of it.
std::vector<std::string> plan_problems(const AcquirePlan& plan, const RadioFormat& format,
                                       const CommandTo& to);

class Acquirer {
 public:
  Acquirer(const AcquireEnds& ends, const AcquirePlan& plan);
  RunEnd run(const PlanRun& run, const std::function<bool()>& stop);
  const std::map<unsigned, ClockLine>& cameras() const { return cameras_; }
  // Unix time by this computer's clock when ours was 0.
  double unix_start_s() const { return unix_start_s_; }

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t now_ns() const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
  }
  void read_wire(std::int64_t now, RunEnd& end, LimitWatch& watch);
  void read_vision(std::int64_t now, RunEnd& end, LimitWatch& watch);
  void send(const PlannedPacket& packet, std::int64_t due_ns, RunEnd& end, RunDriver& driver,
            const LimitWatch& watch);
  void flush(RunEnd& end, RunDriver& driver);
  void wait_until(std::int64_t until_ns) const;

  AcquireEnds ends_;
  const AcquirePlan& plan_;
  Clock::time_point start_ = Clock::now();
  double unix_start_s_ = 1e-9 * static_cast<double>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                                        std::chrono::system_clock::now().time_since_epoch())
                                                        .count());
  std::map<unsigned, ClockLine> cameras_;
  FrameCutter cutter_;
  SendQueue waiting_;
  double told_yaw_rad_ = TelemetryReading::kNotTold;
  bool hears_ = false;
};

}  // namespace omnihil
