// A CAN interface of this computer (SocketCAN): can0 of an adapter, vcan0 between programs.
//
// Bit rates are the interface's own business (ip link set can0 type can bitrate ...). A full send queue
// (ENOBUFS, EAGAIN) counts the frame as not taken; an interface that goes down or away ends the wire.
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "hil/wire/can_adapter.h"
#include "hil/wire/descriptor.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {
namespace {

class SocketCanWire final : public FrameWire {
 public:
  explicit SocketCanWire(std::string interface)
      : interface_(std::move(interface)), name_("can:" + interface_) {}

  WireProblem open(bool fd);
  std::string_view name() const override { return name_; }
  bool read(BusFrame& frame) override;
  bool write(const BusFrame& frame) override;
  std::error_code error() const override { return error_; }
  int handle() const override { return socket_.get(); }

 private:
  void note(std::error_code why);

  std::string interface_, name_;
  Descriptor socket_;
  std::error_code error_;
};

WireProblem SocketCanWire::open(bool fd) {
  const auto reason = [this](const char* step) { return WireProblem{name_ + ": " + step, last_error()}; };
  socket_.reset(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket_) return reason("no SocketCAN in this kernel");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface_.c_str()));
  if (address.can_ifindex == 0) return reason("no such interface");
  if (fd) {
    ifreq request{};
    std::copy_n(interface_.c_str(), std::min<std::size_t>(interface_.size(), IFNAMSIZ - 1), request.ifr_name);
    if (::ioctl(socket_.get(), SIOCGIFMTU, &request) != 0) return reason("no MTU");
    if (request.ifr_mtu != CANFD_MTU) {
      return {name_ + ": carries no CAN FD (ip link set " + interface_ + " mtu 72)", {}};
    }
    const int on = 1;
    if (::setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0)
      return reason("CAN FD");
  }
  if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return reason("bind");
  return {};
}

void SocketCanWire::note(std::error_code why) {
  if (why.value() == EAGAIN || why.value() == EINTR || why.value() == ENOBUFS) return;
  error_ = why;
}

bool SocketCanWire::read(BusFrame& frame) {
  canfd_frame raw{};
  const ssize_t n = ::read(socket_.get(), &raw, sizeof raw);
  if (n < 0) note(last_error());
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

bool SocketCanWire::write(const BusFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.len = frame.fd ? static_cast<std::uint8_t>(can_fd_length(can_fd_code(frame.size))) : frame.size;
  raw.flags = frame.bitrate_switch ? CANFD_BRS : 0;
  std::fill_n(raw.data, raw.len, frame.pad);
  std::copy_n(frame.data.begin(), frame.size, raw.data);
  const auto bytes = static_cast<ssize_t>(frame.fd ? CANFD_MTU : CAN_MTU);
  if (::write(socket_.get(), &raw, static_cast<std::size_t>(bytes)) == bytes) return true;
  note(last_error());
  return false;
}

std::unique_ptr<FrameWire> open(const WireUrl& url, WireProblem& problem) {
  auto wire = std::make_unique<SocketCanWire>(url.address);
  problem = wire->open(url.number("fd") == 1);
  if (!problem.what.empty()) return nullptr;
  return wire;
}

}  // namespace

const WireKind& wire_can() {
  static constexpr WireParameter kParameters[] = {
      {.name = "fd", .says = "CAN FD", .usual = "0", .words = kWireNoYes},
  };
  static constexpr WireKind kKind{.scheme = "can",
                                  .says = "a CAN interface of this computer (SocketCAN); CAN FD wants MTU 72",
                                  .address = "interface",
                                  .example = "can:can0",
                                  .parameters = kParameters,
                                  .open_frames = open};
  return kKind;
}

}  // namespace omnihil
