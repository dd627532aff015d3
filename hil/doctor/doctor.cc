#include "hil/doctor/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hil/text/json_text.h"

namespace omnihil {
namespace {

constexpr const char* kGroupOfSerialPorts = "dialout";  // Debian; udev gives ttyACM* and ttyUSB* to it

}  // namespace

std::vector<Finding> examine(const DoctorOptions& options) {
  const std::vector<std::string> programs =
      options.program_path.empty() ? folders_of_programs() : options.program_path;
  const std::vector<std::string> plugins =
      options.plugin_folders.empty() ? wireshark_plugin_folders() : options.plugin_folders;
  return {look_at_ptys(),
          look_at_serial_ports(options.root, is_in_group(kGroupOfSerialPorts)),
          look_at_can(options.root),
          look_at_cores(options.root),
          look_at_clock(options.root),
          look_at_wake_up(options.sleeps),
          look_at_scheduling(),
          look_at_memory_lock(),
          look_at_open_files(),
          look_at_league_ports(options.league_ports),
          look_at_vision_port(options.vision_port),
          look_at_multicast(options.vision_group, options.vision_port),
          look_at_multicast_network(options.vision_group, options.vision_port, multicast_interfaces()),
          look_at_wireshark(programs, plugins)};
}

const char* state_word(FindingState state) {
  switch (state) {
    case FindingState::kOk:
      return "ok";
    case FindingState::kLimited:
      return "limited";
    case FindingState::kMissing:
      return "missing";
  }
  return "";
}

std::string findings_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) {
    text += fmt::format("{:<8} {:<20} {}\n", state_word(f.state), f.what, f.detail);
    if (!f.mend.empty()) text += fmt::format("{:<29} to mend: {}\n", "", f.mend);
  }
  return text;
}

std::string findings_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Finding& f : findings)
    all.push_back({{"what", f.what}, {"state", state_word(f.state)}, {"detail", f.detail}, {"mend", f.mend}});
  return json_text({{"format", "omnihil-doctor/1"}, {"findings", all}}, 2) + "\n";
}

}  // namespace omnihil
