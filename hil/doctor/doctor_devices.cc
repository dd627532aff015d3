// Devices: pseudo-terminals, serial ports, CAN interfaces.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <grp.h>
#include <net/if.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "hil/doctor/doctor.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
constexpr int kArpHardwareCan = 280;  // ARPHRD_CAN, linux/if_arp.h

constexpr const char* kJoinDialout = "sudo usermod -aG dialout $USER, then log in again";

std::vector<std::string> entries_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    names.push_back(at->path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::string first_word(const fs::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

}  // namespace

Finding look_at_ptys() {
  const Descriptor pty(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (pty.get() < 0 || ::grantpt(pty.get()) != 0 || ::unlockpt(pty.get()) != 0) {
    return {"pseudo-terminals", FindingState::kMissing,
            std::string("none can be made: ") + std::strerror(errno), "sudo mount -t devpts devpts /dev/pts"};
  }
  return {"pseudo-terminals", FindingState::kOk, "can be made: --device ./dongle", ""};
}

bool is_in_group(const char* name) {
  if (::geteuid() == 0) return true;
  const group* entry = ::getgrnam(name);
  if (entry == nullptr) return false;
  if (::getegid() == entry->gr_gid) return true;
  std::vector<gid_t> mine(static_cast<std::size_t>(std::max(::getgroups(0, nullptr), 0)));
  const int count = ::getgroups(static_cast<int>(mine.size()), mine.data());
  mine.resize(static_cast<std::size_t>(std::max(count, 0)));
  return std::ranges::find(mine, entry->gr_gid) != mine.end();
}

Finding look_at_serial_ports(const std::string& root, bool may_open_boards) {
  std::vector<std::string> usable, refused;
  for (const std::string& name : entries_of(root + "/dev")) {
    if (!name.starts_with("ttyACM") && !name.starts_with("ttyUSB") && !name.starts_with("ttyAMA")) continue;
    const std::string path = root + "/dev/" + name;
    (::access(path.c_str(), R_OK | W_OK) == 0 ? usable : refused).push_back("/dev/" + name);
  }
  if (!refused.empty()) {
    return {"serial ports", usable.empty() ? FindingState::kMissing : FindingState::kLimited,
            fmt::format("may not be opened: {}", fmt::join(refused, ", ")), kJoinDialout};
  }
  if (usable.empty() && !may_open_boards) {
    return {"serial ports", FindingState::kLimited,
            "no board is plugged in, and you are not in the group dialout that may open one", kJoinDialout};
  }
  if (usable.empty()) return {"serial ports", FindingState::kOk, "no board is plugged in", ""};
  return {"serial ports", FindingState::kOk, fmt::format("{}", fmt::join(usable, ", ")), ""};
}

Finding look_at_can(const std::string& root) {
  std::vector<std::string> up, down;
  for (const std::string& name : entries_of(root + "/sys/class/net")) {
    const std::string interface = root + "/sys/class/net/" + name;
    if (first_word(interface + "/type") != std::to_string(kArpHardwareCan)) continue;
    const std::string flags = first_word(interface + "/flags");  // "0x40080"; up is bit 0
    const bool is_up = !flags.empty() && (std::strtoul(flags.c_str(), nullptr, 16) & IFF_UP) != 0;
    (is_up ? up : down).push_back(name);
  }
  if (!up.empty()) {
    std::string all = fmt::format("{}", fmt::join(up, ", "));
    if (!down.empty()) all += fmt::format("; down: {}", fmt::join(down, ", "));
    return {"SocketCAN", FindingState::kOk, all, ""};
  }
  if (!down.empty()) {
    const bool is_virtual = down[0].starts_with("vcan");
    return {"SocketCAN", FindingState::kLimited, fmt::format("down: {}", fmt::join(down, ", ")),
            fmt::format("sudo ip link set {} up{}", down[0], is_virtual ? "" : " type can bitrate 1000000")};
  }
  if (fs::exists(root + "/proc/net/can")) {
    return {"SocketCAN", FindingState::kLimited, "in the kernel, but there is no interface",
            "sudo modprobe vcan && sudo ip link add dev vcan0 type vcan && sudo ip link set vcan0 up"};
  }
  return {"SocketCAN", FindingState::kMissing,
          "not in this kernel; slcan:, fdcanusb: and tcp: work without it",
          "sudo modprobe -a can can_raw vcan slcan"};
}

}  // namespace omnihil
