#include "hil/wire/socketcan_port.h"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hil/wire/can_adapter.h"

namespace omnihil {
namespace {

class SocketCanPort final : public FramePort {
 public:
  explicit SocketCanPort(std::string interface) : interface_(std::move(interface)) {}
  ~SocketCanPort() override {
    if (socket_ >= 0) ::close(socket_);
  }
  SocketCanPort(const SocketCanPort&) = delete;
  SocketCanPort& operator=(const SocketCanPort&) = delete;

  std::string open(bool fd);
  bool read(BusFrame& frame) override;
  bool write(const BusFrame& frame) override;
  std::string_view failure() const override { return failure_; }
  int handle() const override { return socket_; }

 private:
  void note(int why);

  std::string interface_, failure_;
  int socket_ = -1;
};

std::string SocketCanPort::open(bool fd) {
  const auto reason = [this](const char* step) {
    return "can:" + interface_ + ": " + step + ": " + std::strerror(errno);
  };
  socket_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (socket_ < 0) return reason("no SocketCAN in this kernel");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface_.c_str()));
  if (address.can_ifindex == 0) return reason("no such interface");
  if (fd) {
    ifreq request{};
    std::copy_n(interface_.c_str(), std::min<std::size_t>(interface_.size(), IFNAMSIZ - 1), request.ifr_name);
    if (::ioctl(socket_, SIOCGIFMTU, &request) != 0) return reason("no MTU");
    if (request.ifr_mtu != CANFD_MTU) {
      return "can:" + interface_ + ": carries no CAN FD (ip link set " + interface_ + " mtu 72)";
    }
    const int on = 1;
    if (::setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0) return reason("CAN FD");
  }
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return reason("bind");
  return {};
}

void SocketCanPort::note(int why) {
  if (why == EAGAIN || why == EINTR || why == ENOBUFS) return;
  failure_ = "can:" + interface_ + ": " + std::strerror(why);
}

bool SocketCanPort::read(BusFrame& frame) {
  canfd_frame raw{};
  const ssize_t n = ::read(socket_, &raw, sizeof raw);
  if (n < 0) note(errno);
  if (n != CAN_MTU && n != CANFD_MTU) return false;
  frame = BusFrame{};
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = n == CANFD_MTU;
  frame.bitrate_switch = frame.fd && (raw.flags & CANFD_BRS) != 0;
  frame.size = frame.remote ? std::uint8_t{0} : std::min<std::uint8_t>(raw.len, CANFD_MAX_DLEN);
  std::copy_n(raw.data, frame.size, frame.data.begin());
  return true;
}

bool SocketCanPort::write(const BusFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.len = frame.fd ? static_cast<std::uint8_t>(can_fd_length(can_fd_code(frame.size))) : frame.size;
  raw.flags = frame.bitrate_switch ? CANFD_BRS : 0;
  std::fill_n(raw.data, raw.len, frame.pad);
  std::copy_n(frame.data.begin(), frame.size, raw.data);
  const auto bytes = static_cast<ssize_t>(frame.fd ? CANFD_MTU : CAN_MTU);
  if (::write(socket_, &raw, static_cast<std::size_t>(bytes)) == bytes) return true;
  note(errno);
  return false;
}

}  // namespace

std::unique_ptr<FramePort> open_socketcan(const std::string& interface, BusCarrier carrier,
                                          std::string& problem) {
  auto port = std::make_unique<SocketCanPort>(interface);
  problem = port->open(carrier == BusCarrier::kCanFd);
  if (!problem.empty()) return nullptr;
  return port;
}

}  // namespace omnihil
