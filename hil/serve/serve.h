// The bench behind a virtual dongle: opens the device, runs the loop on its clock, records, reports.
//
//   ServeOptions options;                       // ./dongle, real time, until Ctrl-C
//   ServeEnd end = serve(config, make_firmware, header, options);
//
// stdout: "device ./dongle ready: …" as soon as a host can open it, then status lines (hil/serve/status_printer.h),
// then the final report. stderr: what went wrong. SIGINT, SIGTERM and SIGHUP end the run cleanly: the name
// of the device is removed, the recording is closed. For people: docs/serve.md.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hil/debugger/gdb_server.h"
#include "hil/league/league_host.h"
#include "hil/loop/session.h"
#include "hil/recording/recording.h"

namespace omnihil {

inline constexpr std::string_view kServeDevice = "pty";  // what a bare path is

struct StartPose {
  int key = 0;  // the robot's id; an opponent's: kOpponentKey + id
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
};

// A line that a robot's board said at a port.
using ConsoleRecorder =
    std::function<void(std::uint32_t robot_id, int board, const std::string& port, const std::string& line)>;

struct ServeOptions {
  std::string device = "./dongle";  // a wire's URL for bytes; a bare path is a pty's name
  std::string opponents_device;     // of the other team's dongle, likewise; empty: none
  bool pacing = true;
  std::optional<std::int64_t> baud;     // instead of the carrier's; 8N1
  bool real_time = true;                // false: virtual time as fast as it goes
  std::int64_t start_ns = 0;            // real time: when step 0 is due, CLOCK_MONOTONIC; 0: at once
  std::int64_t duration_ns = 0;         // simulated; 0: until a signal
  bool quiet = false;                   // the ready line and errors only
  bool strict = false;                  // real time: the first slip ends the run
  bool fifo = false;                    // SCHED_FIFO, memory locked
  std::int64_t spin_ns = 0;             // awake so long before each step is due
  std::string record;                   // file; empty: none
  std::string capture;                  // Unix socket that gives passing packets as pcap; empty: none
  std::optional<LeagueOptions> league;  // the league's ports, beside the device
  std::vector<StartPose> starts;        // before the first step; in the recording
  std::string load;                     // what is said of the load (serve_load.h); lines with ends
  GdbServer* gdb = nullptr;             // not owned; the boards of `make_firmware` have been added to it
  std::string firmware_file;            // that `watch` and `set` mean variables of
  std::vector<std::string> watch, set;  // variables by name; "NAME=VALUE" at the start
  // Filled in by serve() while it runs: whoever hears boards on their consoles tells it, for the recording.
  std::shared_ptr<ConsoleRecorder> record_console = std::make_shared<ConsoleRecorder>();
  int league_sync_port = 0;  // TCP; time then goes on by the client's requests alone; 0: no
};

enum class ServeEnd {
  kDone,      // duration reached or asked to end
  kIo,        // a device or file could not be opened, read or written
  kDiverged,  // a state was not finite, or a fault inside
  kLate,      // strict, and this computer could not keep up
  kFirmware,  // as kDone, but a robot's firmware crashed or hung on the way: its wheels coasted from then on
};

// `header` describes `config` for the recording. Throws std::invalid_argument naming every problem of
// the configuration, before anything is opened.
ServeEnd serve(SessionConfig config, const Session::FirmwareMaker& make_firmware, RecordingHeader header,
               const ServeOptions& options, const Session::FirmwareMaker& opponents_firmware = {});

}  // namespace omnihil
