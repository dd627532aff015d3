#include "tools/options/league_options.h"

#include <charconv>

namespace omnihil {
namespace {

// "224.5.23.2:10006"
bool split_address(const std::string& text, std::string& host, int& port) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return false;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data() + colon + 1, end, port);
  host = text.substr(0, colon);
  return error == std::errc{} && at == end && port > 0 && port < 65'536;
}

// "20011" or "20011,30011,30012"
bool split_ports(const std::string& text, LeagueOptions& options) {
  const char *at = text.data(), *const end = text.data() + text.size();
  const auto take = [&](int& port) {
    const auto [next, error] = std::from_chars(at, end, port);
    if (error != std::errc{} || port < 1 || port > 65'535) return false;
    at = next;
    return true;
  };
  const auto comma = [&] { return at < end && *at++ == ','; };
  if (!take(options.grsim_port)) return false;
  if (at == end) return true;
  return comma() && take(options.grsim_blue_port) && comma() && take(options.grsim_yellow_port) && at == end;
}

}  // namespace

void add_league_options(Verb& verb, LeagueWords& w) {
  verb.add_flag(
      "--league", w.on,
      "the league's ports as well: robot control (UDP 10301 blue, 10302 yellow), simulation control (10300), "
      "vision (docs/league.md)");
  verb.add_option("--league-address", w.options.address, "where commands are taken: 0.0.0.0 is everywhere")
      .capture_default_str();
  verb.add_option("--league-control-port", w.options.control_port, "UDP port of simulation control")
      .range(1, 65'535)
      .capture_default_str();
  verb.add_option("--league-robot-port", w.options.robot_port,
                  "UDP port of robot control instead of 10301 or 10302")
      .range(1, 65'535);
  verb.add_option("--league-opponents-port", w.options.opponents_port,
                  "UDP port of the other team's robot control, likewise")
      .range(1, 65'535);
  verb.add_option("--league-sync", w.sync_port,
                  "TCP port of the synchronous protocol: time goes on by a client's requests alone")
      .range(1, 65'535);
  verb.add_option(
      "--grsim", w.grsim,
      "UDP port on which grSim's packets are taken, usually 20011; with the ports that hear of the "
      "robots: 20011,30011,30012 (default: not taken)");
  verb.add_option("--vision", w.vision, "multicast GROUP:PORT instead of 224.5.23.2:10006, or off");
  verb.add_option("--vision-interface", w.options.vision_interface,
                  "address of the network interface that it leaves by")
      .capture_default_str();
  verb.add_option(
      "--mixed-vision", w.real,
      "multicast GROUP:PORT of a real game's vision: its robots and ball are on the floor among ours, and "
      "in the frames that go out (docs/field/mixed.md)");
  verb.add_option("--mixed-interface", w.options.real_interface,
                  "address of the network interface that it comes by")
      .capture_default_str();
  verb.add_option("--vision-rate", w.options.vision.rate_Hz, "frames per second of each camera")
      .range(0.1, 1000.0)
      .capture_default_str();
  verb.add_option("--cameras", w.options.vision.cameras, "cameras side by side over the field: 1, 2 or 4")
      .range(1, 4)
      .capture_default_str();
  verb.add_option("--vision-delay", w.delay_least_ms, "ms from a frame's capture to its sending, at least")
      .range(0.0, 1000.0)
      .capture_default_str();
  verb.add_option("--vision-delay-most", w.delay_most_ms, "ms, at most: uniform between the two")
      .range(0.0, 1000.0)
      .capture_default_str();
  verb.add_option("--vision-noise", w.position_sigma_mm, "standard deviation of a position in mm")
      .range(0.0, 1000.0)
      .capture_default_str();
  verb.add_option("--vision-yaw-noise", w.options.vision.yaw_sigma_rad,
                  "standard deviation of an orientation in rad")
      .range(0.0, 3.0)
      .capture_default_str();
  verb.add_option("--vision-pixel", w.options.vision.digit_mm,
                  "mm of the floor in a pixel: positions are rounded to it")
      .range(0.0, 100.0);
  verb.add_flag("--occlusion", w.options.vision.occlusion, "a ball behind a robot is not seen by a camera");
  verb.add_option("--false-balls", w.options.vision.false_ball_rate_Hz,
                  "balls that are none, per second and camera")
      .range(0.0, 1000.0);
  verb.add_option("--camera-clocks", w.clock_sigma_ms, "standard deviation of the cameras' clocks in ms")
      .range(0.0, 1e6)
      .capture_default_str();
  verb.add_option("--camera-askew", w.askew_mm, "standard deviation of each camera's offset in mm")
      .range(0.0, 1000.0)
      .capture_default_str();
}

std::optional<LeagueOptions> league_options(const LeagueWords& words, std::uint64_t seed,
                                            std::uint64_t epoch_ms, std::vector<std::string>& problems) {
  if (!words.on && words.sync_port == 0) {
    if (!words.real.empty()) problems.push_back("--mixed-vision: needs --league");
    if (!words.grsim.empty()) problems.push_back("--grsim: needs --league");
    return std::nullopt;
  }
  LeagueOptions options = words.options;
  VisionOptions& vision = options.vision;
  if (words.vision == "off") {
    options.sends_vision = false;
  } else if (!words.vision.empty() &&
             !split_address(words.vision, options.vision_group, options.vision_port)) {
    problems.push_back("--vision: found \"" + words.vision +
                       "\", allowed: GROUP:PORT such as 224.5.23.2:10006, or off");
  }
  if (!words.real.empty()) {
    if (!split_address(words.real, options.real_group, options.real_port))
      problems.push_back("--mixed-vision: found \"" + words.real +
                         "\", allowed: GROUP:PORT such as 224.5.23.2:10006");
    else if (options.sends_vision && options.real_group == options.vision_group &&
             options.real_port == options.vision_port)
      problems.push_back("--mixed-vision: " + words.real +
                         " is where our own vision goes: give it another group or port with --vision");
  }
  if (!words.grsim.empty() && !split_ports(words.grsim, options))
    problems.push_back("--grsim: found \"" + words.grsim +
                       "\", allowed: PORT or COMMANDS,BLUE,YELLOW such as 20011,30011,30012");
  if (vision.cameras == 3) problems.push_back("--cameras: found 3, allowed: 1, 2, 4");
  if (words.delay_most_ms > 0.0 && words.delay_most_ms < words.delay_least_ms)
    problems.push_back("--vision-delay-most: less than --vision-delay");
  vision.delay_least_s = words.delay_least_ms / 1e3;
  vision.delay_most_s = words.delay_most_ms / 1e3;
  vision.position_sigma_m = words.position_sigma_mm / 1e3;
  vision.clock_sigma_s = words.clock_sigma_ms / 1e3;
  vision.askew_sigma_m = words.askew_mm / 1e3;
  vision.seed = seed;
  vision.epoch_ms = epoch_ms;
  return options;
}

}  // namespace omnihil
