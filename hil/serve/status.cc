#include "hil/serve/status.h"

#include <fmt/format.h>

#include <numbers>

namespace omnihil {
namespace {

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string clock_words(const ServeStatus& s) {
  if (!s.real_time) {
    const double ratio = s.wall_ns > 0 ? static_cast<double>(s.now_ns) / static_cast<double>(s.wall_ns) : 0.0;
    return fmt::format("free-running, {:.1f} x real time", ratio);
  }
  std::string words = fmt::format("late p50 {} p99 {}", short_time(s.late_p50_ns), short_time(s.late_p99_ns));
  if (s.slipped_ns > 0) words += fmt::format(", OVERLOADED: slipped {}", short_time(s.slipped_ns));
  return words;
}

std::string port_lines(const ServeStatus& s) {
  std::string text =
      fmt::format("  device           opened {} time{}, {} bytes in, {} bytes out\n", s.port.hosts,
                  s.port.hosts == 1 ? "" : "s", s.port.bytes_from_host, s.port.bytes_to_host);
  if (s.port.answers_dropped > 0) {
    text += fmt::format("  host not reading {} answers ({} bytes) dropped, its queue was full\n",
                        s.port.answers_dropped, s.port.bytes_dropped);
  }
  return text;
}

std::string lateness_lines(const ServeStatus& s) {
  if (!s.real_time) return fmt::format("  clock            {}\n", clock_words(s));
  std::string text = fmt::format(
      "  lateness         p50 {}, p99 {}, max {}; {} of {} steps late by a step or more\n",
      short_time(s.late_p50_ns), short_time(s.late_p99_ns), short_time(s.late_max_ns), s.late_steps, s.steps);
  if (s.slipped_ns > 0) {
    text += fmt::format(
        "  OVERLOADED       this computer could not keep up: simulated time slipped {} against wall time, in "
        "{} "
        "place{}\n",
        short_time(s.slipped_ns), s.slips, s.slips == 1 ? "" : "s");
  } else {
    text += "  slip             none: simulated time kept up with wall time\n";
  }
  return text;
}

std::string packet_line(std::string_view who, const PacketCounts& counts) {
  const std::string causes = refused_by_cause(counts);
  return fmt::format("  {:<16} {} packets good, {} refused{}\n", who, counts.good, counts.refused(),
                     causes.empty() ? "" : " (" + causes + ")");
}

}  // namespace

void take_clock(const ClockReport& report, ServeStatus& status) {
  status.real_time = report.real_time;
  status.late_p50_ns = report.lateness.quantile_ns(0.5);
  status.late_p99_ns = report.lateness.quantile_ns(0.99);
  status.late_max_ns = report.lateness.max_ns();
  status.late_steps = report.late_steps;
  status.slipped_ns = report.slipped_ns;
  status.slips = report.slips;
}

std::string short_time(std::int64_t ns) {
  if (ns < 1'000'000) return fmt::format("{} us", ns / 1000);
  if (ns < 1'000'000'000) return fmt::format("{:.1f} ms", static_cast<double>(ns) * 1e-6);
  return fmt::format("{:.1f} s", seconds(ns));
}

std::string refused_by_cause(const PacketCounts& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.bad.size(); ++i) {
    if (counts.bad[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", to_string(static_cast<PacketError>(i)),
                        counts.bad[i]);
  }
  return text;
}

std::string status_line(const ServeStatus& s, std::size_t width) {
  const std::string causes = refused_by_cause(s.from_host);
  const std::int64_t ms = s.now_ns / 1'000'000;
  std::string line = fmt::format(
      "{}:{:02}.{:01} {} | in {} ok, {} refused{} | out {} | {} | #{} wheels {:.1f} {:.1f} {:.1f} {:.1f} "
      "rad/s, "
      "at {:.2f} {:.2f} m, {:.0f} deg",
      ms / 60'000, ms / 1000 % 60, ms / 100 % 10, s.host_present ? "host here" : "no host", s.from_host.good,
      s.from_host.refused(), causes.empty() ? "" : " (" + causes + ")", s.from_robots.good, clock_words(s),
      s.robot_id, s.omega_wheel_rad_s[0], s.omega_wheel_rad_s[1], s.omega_wheel_rad_s[2],
      s.omega_wheel_rad_s[3], s.x_m, s.y_m, s.yaw_rad * 180.0 / std::numbers::pi);
  if (!s.variables.empty()) line += " | " + s.variables;
  if (width > 0 && line.size() > width) line.resize(width);
  return line;
}

std::string final_report(const ServeStatus& s) {
  std::string text = fmt::format("served {:.3f} s of simulated time ({} steps) in {:.3f} s of wall time\n",
                                 seconds(s.now_ns), s.steps, seconds(s.wall_ns));
  text += packet_line("from the host", s.from_host);
  text += packet_line("from the robots", s.from_robots);
  if (s.air.to_robot + s.air.to_host > 0) {
    text += fmt::format("  lost on the air  {} of {} to robots, {} of {} from them\n", s.air.to_robot,
                        s.air.sent_to_robot, s.air.to_host, s.air.sent_to_host);
  }
  const AirCounts& air = s.air;
  if (air.twice + air.held + air.overtaken > 0) {
    text += fmt::format("  out of turn      {} arrived twice, {} held back, {} after a later one\n",
                        air.twice, air.held, air.overtaken);
  }
  const std::uint64_t damaged = air.refused[0] + air.refused[1] + air.slipped[0] + air.slipped[1];
  if (damaged > 0) {
    text += fmt::format(
        "  wrong bits       {} packets to robots, {} of them not seen; {} from them, {} not seen\n",
        air.refused[0] + air.slipped[0], air.slipped[0], air.refused[1] + air.slipped[1], air.slipped[1]);
  }
  if (air.crowded[0] + air.crowded[1] > 0) {
    text += fmt::format("  crowded out      {} packets: too many were under way at once\n",
                        air.crowded[0] + air.crowded[1]);
  }
  if (s.gains_refused > 0) {
    text += fmt::format("  gains            {} sets refused by the firmware\n", s.gains_refused);
  }
  if (s.firmware_faults > 0) {
    text += fmt::format("  firmware         {} requests that no hardware could take, refused\n",
                        s.firmware_faults);
  }
  return text + port_lines(s) + lateness_lines(s);
}

}  // namespace omnihil
