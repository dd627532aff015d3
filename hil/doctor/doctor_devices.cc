// Devices: pseudo-terminals, serial ports, CAN interfaces.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "hil/doctor/doctor.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;
constexpr int kArpHardwareCan = 280;  // ARPHRD_CAN, linux/if_arp.h

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

Finding look_at_serial_ports(const std::string& root) {
  std::vector<std::string> usable, refused;
  for (const std::string& name : entries_of(root + "/dev")) {
    if (!name.starts_with("ttyACM") && !name.starts_with("ttyUSB") && !name.starts_with("ttyAMA")) continue;
    const std::string path = root + "/dev/" + name;
    (::access(path.c_str(), R_OK | W_OK) == 0 ? usable : refused).push_back("/dev/" + name);
  }
  if (!refused.empty()) {
    return {"serial ports", usable.empty() ? FindingState::kMissing : FindingState::kLimited,
            fmt::format("may not be opened: {}", fmt::join(refused, ", ")),
            "sudo usermod -aG dialout $USER, then log in again"};
  }
  if (usable.empty()) return {"serial ports", FindingState::kOk, "no board is plugged in", ""};
  return {"serial ports", FindingState::kOk, fmt::format("{}", fmt::join(usable, ", ")), ""};
}

Finding look_at_can(const std::string& root) {
  std::vector<std::string> interfaces;
  for (const std::string& name : entries_of(root + "/sys/class/net")) {
    if (first_word(root + "/sys/class/net/" + name + "/type") == std::to_string(kArpHardwareCan))
      interfaces.push_back(name);
  }
  if (!interfaces.empty())
    return {"SocketCAN", FindingState::kOk, fmt::format("{}", fmt::join(interfaces, ", ")), ""};
  if (fs::exists(root + "/proc/net/can")) {
    return {"SocketCAN", FindingState::kLimited, "in the kernel, but there is no interface",
            "sudo ip link add dev vcan0 type vcan && sudo ip link set up vcan0"};
  }
  return {"SocketCAN", FindingState::kMissing,
          "not in this kernel; slcan:, fdcanusb: and tcp: work without it",
          "sudo modprobe -a can can_raw vcan"};
}

}  // namespace omnihil
