// What `serve` says while it runs and when it ends: pure text from a snapshot of numbers.
//
//   1:02.345  host here | 12400 ok, 3 refused (2 checksum, 1 framing) | late p50 36 us p99 198 us | #0 wheels …
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "hil/loop/air.h"
#include "hil/loop/clock.h"
#include "hil/serve/serve_port.h"
#include "protocols/packet_error.h"

namespace omnihil {

struct ServeStatus {
  std::int64_t now_ns = 0;   // simulated
  std::int64_t wall_ns = 0;  // since the start
  bool host_present = false;
  PacketCounts from_host;
  PacketCounts from_robots;
  AirCounts air;                      // what the radio lost
  std::uint64_t gains_refused = 0;    // sets that came over the air
  std::uint64_t firmware_faults = 0;  // requests of the firmware that no hardware could take
  HostPortCounts port;
  // Of the clock; the histogram itself stays where it is.
  bool real_time = false;
  std::int64_t late_p50_ns = 0;
  std::int64_t late_p99_ns = 0;
  std::int64_t late_max_ns = 0;
  std::uint64_t late_steps = 0;
  std::uint64_t steps = 0;
  std::int64_t slipped_ns = 0;
  std::uint64_t slips = 0;
  // First robot, true state.
  int robot_id = 0;
  std::array<double, kWheels> omega_wheel_rad_s{};
  double x_m = 0, y_m = 0, yaw_rad = 0;
  std::string variables;  // of its firmware, "ticks 120, mode kDriving"; empty: none is watched
};

void take_clock(const ClockReport& report, ServeStatus& status);

// One line, ASCII, at most `width` characters (0: not limited), without line end.
std::string status_line(const ServeStatus& status, std::size_t width);
// The final report: lines with ends.
std::string final_report(const ServeStatus& status);

// "checksum 2, framing 1"; empty when none was refused.
std::string refused_by_cause(const PacketCounts& counts);
// "36 us", "7.40 ms", "1.2 s"
std::string short_time(std::int64_t ns);

}  // namespace omnihil
