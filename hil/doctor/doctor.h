// What of this computer the bench can use, and what mends the rest: one finding per thing.
//
//   for (const Finding& f : examine({})) std::cout << f.what << ": " << f.detail << "\n";
//
// Looks, opens and closes again; changes nothing and needs no rights. Paths of /sys, /dev and /proc may be put elsewhere,
// for tests. Cannot: tell whether a device is the right one, or whether a computer keeps real time under another load.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace omnihil {

enum class FindingState : std::uint8_t { kOk, kLimited, kMissing };  // limited: works, but not all of it

struct Finding {
  std::string what;  // "pseudo-terminals"
  FindingState state = FindingState::kOk;
  std::string detail;  // what was seen, with units
  std::string mend;    // a command, or what to do; empty: nothing to do
};

struct NetworkInterface {
  std::string name, address;  // "eth0", "192.168.1.7"
};

struct DoctorOptions {
  std::string root;  // in front of /sys, /dev, /proc
  std::string vision_group = "224.5.23.2";
  int vision_port = 10006;
  std::vector<int> league_ports{10300, 10301, 10302};
  std::vector<std::string> program_path{}, plugin_folders{};  // of Wireshark; empty: this computer's
  int sleeps = 200;  // of a millisecond, to see how late this computer wakes
};

std::vector<Finding> examine(const DoctorOptions& options);

// One look each.
Finding look_at_ptys();
// `may_open_boards`: as root, or in the group that owns serial ports.
Finding look_at_serial_ports(const std::string& root, bool may_open_boards = true);
Finding look_at_can(const std::string& root);
Finding look_at_clock(const std::string& root);
Finding look_at_wake_up(int sleeps);
Finding look_at_scheduling();
Finding look_at_memory_lock();
Finding look_at_open_files();
Finding look_at_league_ports(const std::vector<int>& ports);
Finding look_at_vision_port(int port);
Finding look_at_multicast(const std::string& group, int port);
Finding look_at_multicast_network(const std::string& group, int port,
                                  const std::vector<NetworkInterface>& interfaces);
// Folders where tshark or wireshark may be, and folders whose *.lua Wireshark loads.
Finding look_at_wireshark(const std::vector<std::string>& program_path,
                          const std::vector<std::string>& plugin_folders);
Finding look_at_cores(const std::string& root);

std::vector<NetworkInterface> multicast_interfaces();  // up, IPv4, multicast, not loopback
std::vector<std::string> folders_of_programs();        // $PATH
std::vector<std::string> wireshark_plugin_folders();   // the user's, the system's
bool is_in_group(const char* name);                    // this program's user, or root

const char* state_word(FindingState state);  // "ok", "limited", "missing"
std::string findings_text(const std::vector<Finding>& findings);
std::string findings_json(const std::vector<Finding>& findings);

}  // namespace omnihil
