// A board for the tests: the shim and the reference wheel controller in a process of their own, at a pty.
//
//   emulated_board [--corrupt N] [--cut N] [--skip N] [--silent-after N] [--exit-after N] [--mute] [--can
//   INTERFACE]
//
// Prints the path of the pty that the bench opens. Every N-th frame it sends has a flipped bit (corrupt),
// lacks its last three bytes (cut) or is not sent (skip); after N frames it says nothing more (silent-after)
// or is gone, as if unplugged (exit-after); it never says anything (mute). It ends when the bench closes the
// line. With --can it sits on a CAN interface instead, and ends when nothing comes for 5 s.
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "firmware_iface/omnihil_firmware.h"
#include "firmware_iface/remote_shim/remote_shim.h"

namespace {

struct Faults {
  long corrupt = 0, cut = 0, skip = 0, silent_after = 0, exit_after = 0;
  bool mute = false;
};

struct Port {
  int fd = -1;
  bool can = false;
  Faults faults;
  long frames = 0;
};

bool every(long n, long count) { return n > 0 && count % n == 0; }

constexpr canid_t kFromBench = 0x7E0, kToBench = 0x7E8;

// As many CAN frames as the bytes need. A full queue is waited for: the loop has nothing else to do.
void write_can(int fd, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += CAN_MAX_DLEN) {
    can_frame frame{};
    frame.can_id = kToBench;
    frame.can_dlc = static_cast<std::uint8_t>(std::min<std::size_t>(CAN_MAX_DLEN, bytes.size() - at));
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), frame.can_dlc, frame.data);
    while (::write(fd, &frame, sizeof frame) < 0 && errno == ENOBUFS) ::usleep(100);
  }
}

ssize_t read_can(int fd, std::uint8_t* out) {
  pollfd watched{.fd = fd, .events = POLLIN, .revents = 0};
  can_frame frame{};
  do {
    if (::poll(&watched, 1, 5000) <= 0 || ::read(fd, &frame, sizeof frame) < 0) return -1;
  } while (frame.can_id != kFromBench);
  std::copy_n(frame.data, frame.can_dlc, out);
  return frame.can_dlc;
}

int open_can(const char* interface) {
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface));
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return -1;
  return fd;
}

void write_port(void* context, const std::uint8_t* bytes, std::size_t count) {
  Port& port = *static_cast<Port*>(context);
  const long n = ++port.frames;
  const Faults& f = port.faults;
  if (f.mute || every(f.skip, n) || (f.silent_after > 0 && n > f.silent_after)) return;
  std::vector<std::uint8_t> out(bytes, bytes + count);
  if (every(f.corrupt, n)) out[count / 2] ^= 0x10;
  if (every(f.cut, n)) out.resize(count - 3);
  if (f.exit_after > 0 && n > f.exit_after) std::exit(0);
  if (port.can) return write_can(port.fd, out);
  if (::write(port.fd, out.data(), out.size()) < 0) std::perror("emulated_board: write");
}

omnihil_robot_config config_of(const omnihil_remote_robot& r) {
  omnihil_robot_config c{};
  c.robot_id = r.robot_id;
  for (int i = 0; i < OMNIHIL_WHEELS; ++i) c.wheel_angle_rad[i] = r.wheel_angle_rad[i];
  c.wheel_radius_m = r.wheel_radius_m;
  c.wheel_center_radius_m = r.wheel_center_radius_m;
  c.gear_ratio = r.gear_ratio;
  c.encoder_counts_per_rotor_turn = r.encoder_counts_per_rotor_turn;
  c.bus_voltage_nominal_V = r.bus_voltage_nominal_V;
  c.motor_resistance_ohm = r.motor_resistance_ohm;
  c.motor_torque_constant_Nm_per_A = r.motor_torque_constant_Nm_per_A;
  c.command_timeout_s = r.command_timeout_s;
  return c;
}

struct Board {
  omnihil_remote remote{};
  const omnihil_firmware_api* api = omnihil_firmware_get(OMNIHIL_FIRMWARE_ABI);
  std::vector<std::max_align_t> state;
  bool started = false;

  void start() {
    state.assign(api->state_bytes / sizeof(std::max_align_t) + 1, {});
    const omnihil_robot_config config = config_of(remote.robot);
    started = api->init(state.data(), &config) == 0;
  }

  void command(std::uint64_t now_us) {
    omnihil_remote_command c;
    if (omnihil_remote_take_command(&remote, &c) == 0) return;
    omnihil_command full{};
    full.mode = c.mode;
    full.flags = c.flags;
    full.v_forward_m_s = c.v_forward_m_s;
    full.v_left_m_s = c.v_left_m_s;
    full.omega_body_rad_s = c.omega_body_rad_s;
    for (int i = 0; i < OMNIHIL_WHEELS; ++i) {
      full.omega_wheel_rad_s[i] = c.omega_wheel_rad_s[i];
      full.duty_ratio[i] = c.duty_ratio[i];
    }
    full.yaw_target_rad = c.yaw_target_rad;
    api->command(state.data(), &full, now_us);
  }

  // What the timer interrupt of a real board does.
  void control_period() {
    const omnihil_remote_sensors& s = remote.sensors;
    omnihil_sensors sensors{};
    sensors.now_us = s.now_us;
    for (int i = 0; i < OMNIHIL_WHEELS; ++i) {
      sensors.encoder_counts[i] = omnihil_remote_encoder(&remote, i);
      sensors.motor_current_A[i] = 1e-3 * s.motor_current_mA[i];
    }
    sensors.bus_voltage_V = 1e-3 * s.bus_voltage_mV;
    sensors.gyro_z_rad_s = 1e-3 * s.gyro_z_mrad_s;
    command(sensors.now_us);
    omnihil_drive drive{};
    api->tick(state.data(), &sensors, &drive);
    for (int i = 0; i < OMNIHIL_WHEELS; ++i) {
      if (drive.mode[i] == OMNIHIL_DRIVE_DUTY) {
        omnihil_remote_set_duty(&remote, i, static_cast<float>(drive.duty_ratio[i]));
      } else {
        omnihil_remote_coast(&remote, i);
      }
    }
    omnihil_remote_done(&remote, 12);
  }
};

int open_pty() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) return -1;
  const int slave = ::open(::ptsname(master), O_RDWR | O_NOCTTY);
  termios mode{};
  ::tcgetattr(slave, &mode);
  ::cfmakeraw(&mode);
  ::tcsetattr(slave, TCSANOW, &mode);
  ::close(slave);
  return master;
}

}  // namespace

int main(int argc, char** argv) {
  Port port;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--mute") {
      port.faults.mute = true;
      continue;
    }
    const long value = i + 1 < argc ? std::strtol(argv[++i], nullptr, 10) : 0;
    if (word == "--corrupt") port.faults.corrupt = value;
    if (word == "--cut") port.faults.cut = value;
    if (word == "--skip") port.faults.skip = value;
    if (word == "--can") {
      port.fd = open_can(argv[i]);
      port.can = true;
    }
    if (word == "--exit-after") port.faults.exit_after = value;
    if (word == "--silent-after") port.faults.silent_after = value;
  }
  if (!port.can) port.fd = open_pty();
  if (port.fd < 0) return 3;
  if (!port.can) std::printf("%s\n", ::ptsname(port.fd));
  std::fflush(stdout);
  Board board;
  omnihil_remote_init(&board.remote, "emulated board", "", 1000, write_port, &port);
  bool seen = false;
  std::uint8_t bytes[512];
  while (true) {
    const ssize_t n = port.can ? read_can(port.fd, bytes) : ::read(port.fd, bytes, sizeof bytes);
    if (n <= 0) {  // EIO: nobody has it open, yet or any more
      if (seen || port.can) return 0;
      ::usleep(1000);
      continue;
    }
    seen = true;
    for (ssize_t i = 0; i < n; ++i) {
      omnihil_remote_receive(&board.remote, bytes[i]);
      if (board.remote.configured != 0 && !board.started) board.start();
      if (board.started && omnihil_remote_tick(&board.remote) != 0) board.control_period();
    }
  }
}
