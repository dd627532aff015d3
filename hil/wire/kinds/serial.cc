// A serial port of this computer: 8 data bits, 1 stop bit, no flow control.
//
// Real ports go through libserialport. It refuses pseudo-terminals (emulated boards, socat relays, a dongle of
// our own) and a terminal that the kernel lists in no usual place: these are opened by termios. On a
// pseudo-terminal baud rate and parity mean nothing.
#include <fcntl.h>
#include <libserialport.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>

#include <cerrno>

#include "hil/wire/descriptor.h"
#include "hil/wire/terminal.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {
namespace {

constexpr unsigned kPtySlaveFirst = 136, kPtySlaveLast = 143;  // major numbers, kernel's devices.txt

bool is_pty(const struct stat& device) {
  return major(device.st_rdev) >= kPtySlaveFirst && major(device.st_rdev) <= kPtySlaveLast;
}

struct ClosePort {
  void operator()(sp_port* port) const {
    sp_close(port);  // of a port that is not open: refused, without effect
    sp_free_port(port);
  }
};
using Port = std::unique_ptr<sp_port, ClosePort>;

class SerialWire final : public ByteWire {
 public:
  SerialWire(std::string device, Port port, int fd)
      : device_(std::move(device)), port_(std::move(port)), fd_(fd) {}
  SerialWire(std::string device, Descriptor terminal)
      : device_(std::move(device)), terminal_(std::move(terminal)), fd_(terminal_.get()) {}

  std::string_view name() const override { return device_; }
  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override {
    const FdRead got = read_available(fd_, out, limit);
    // libserialport's ports read as ended while nothing waits (VMIN 0), a terminal of ours when it is hung up
    if (got.ended && limit > 0 && terminal_) return std::make_error_code(std::errc::io_error);
    return got.error;
  }
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    return write_some(fd_, bytes, error);
  }
  int handle() const override { return fd_; }

 private:
  std::string device_;
  Port port_;
  Descriptor terminal_;
  int fd_;
};

std::unique_ptr<ByteWire> open_port(const WireUrl& url, WireProblem& problem) {
  const std::string& device = url.address;
  const auto refuse = [&](const char* step, sp_return code) {
    problem.what = device + ": " + step;
    if (code == SP_ERR_FAIL) problem.code = last_error();
    if (code != SP_ERR_FAIL) problem.what += ": not a serial port that libserialport knows";
    return nullptr;
  };
  sp_port* raw = nullptr;
  sp_return code = sp_get_port_by_name(device.c_str(), &raw);
  if (code != SP_OK) return refuse("look up", code);
  Port port(raw);
  if ((code = sp_open(raw, SP_MODE_READ_WRITE)) != SP_OK) return refuse("open", code);
  if ((code = sp_set_baudrate(raw, url.number("baud"))) != SP_OK) return refuse("set the baud rate", code);
  if ((code = sp_set_bits(raw, 8)) != SP_OK) return refuse("set 8 bits", code);
  const sp_parity parity = url.word("parity") == "even" ? SP_PARITY_EVEN : SP_PARITY_NONE;
  if ((code = sp_set_parity(raw, parity)) != SP_OK) return refuse("set the parity", code);
  if ((code = sp_set_stopbits(raw, 1)) != SP_OK) return refuse("set 1 stop bit", code);
  if ((code = sp_set_flowcontrol(raw, SP_FLOWCONTROL_NONE)) != SP_OK) return refuse("no flow control", code);
  sp_flush(raw, SP_BUF_BOTH);
  int fd = -1;
  sp_get_port_handle(raw, &fd);
  return std::make_unique<SerialWire>(device, std::move(port), fd);
}

bool set_line(int fd, const WireUrl& url) {
  termios modes{};
  if (::tcgetattr(fd, &modes) != 0) return false;
  if (url.word("parity") == "even") modes.c_cflag |= PARENB;
  if (url.word("parity") == "even") modes.c_cflag &= ~static_cast<tcflag_t>(PARODD);
  return ::cfsetspeed(&modes, static_cast<speed_t>(url.number("baud"))) ==
             0 &&  // glibc takes the number itself
         ::tcsetattr(fd, TCSANOW, &modes) == 0;
}

std::unique_ptr<ByteWire> open_terminal(const WireUrl& url, bool pty, WireProblem& problem) {
  const auto refuse = [&](const char* step) {
    problem = {url.address + ": " + step, last_error()};
    return nullptr;
  };
  Descriptor terminal(::open(url.address.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!terminal) return refuse("open");
  if (!make_raw(terminal.get())) return refuse("raw mode");
  if (!pty && !set_line(terminal.get(), url)) return refuse("set the baud rate and the parity");
  return std::make_unique<SerialWire>(url.address, std::move(terminal));
}

std::unique_ptr<ByteWire> open(const WireUrl& url, WireProblem& problem) {
  std::unique_ptr<ByteWire> wire = open_port(url, problem);
  if (wire != nullptr) return wire;
  struct stat device {};
  if (::stat(url.address.c_str(), &device) != 0) {
    problem = {url.address + ": look up", last_error()};
    return nullptr;
  }
  if (!S_ISCHR(device.st_mode)) {
    problem = {url.address + ": no serial port", {ENOTTY, std::generic_category()}};
    return nullptr;
  }
  if (!is_pty(device) && problem.code) return nullptr;  // libserialport knows it, and why it does not open
  problem = {};
  return open_terminal(url, is_pty(device), problem);
}

}  // namespace

const WireKind& wire_serial() {
  static constexpr std::string_view kParity[] = {"none", "even"};
  static constexpr WireParameter kParameters[] = {
      {.name = "baud", .says = "baud rate", .usual = "115200", .low = 9600, .high = 12'000'000},
      {.name = "parity", .says = "parity", .usual = "none", .words = kParity},
  };
  static constexpr WireKind kKind{
      .scheme = "serial",
      .says =
          "a serial port of this computer, 8 data bits, 1 stop bit, no flow control; a pseudo-terminal, too",
      .address = "device",
      .example = "serial:/dev/ttyACM0",
      .parameters = kParameters,
      .open_bytes = open};
  return kKind;
}

}  // namespace omnihil
