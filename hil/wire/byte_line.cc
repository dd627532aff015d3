#include "hil/wire/byte_line.h"

#include <fcntl.h>
#include <libserialport.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

namespace omnihil {
namespace {

constexpr std::size_t kQueue_bytes = 4096;                     // what a stopped line may pile up
constexpr unsigned kPtySlaveFirst = 136, kPtySlaveLast = 143;  // major numbers, kernel's devices.txt

// The part that real ports and ptys share; bytes go through put() and get(), below 0: an errno is set.
class LineBase : public ByteLine {
 public:
  explicit LineBase(std::string device) : device_(std::move(device)) {}
  std::size_t read(std::span<std::uint8_t> out) override {
    const ssize_t n = get(out);
    if (n < 0) note("read");
    return n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  bool write(std::span<const std::uint8_t> bytes) override {
    const bool fits = waiting_.size() + bytes.size() <= kQueue_bytes;
    if (fits) waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    const ssize_t n = waiting_.empty() ? 0 : put(waiting_);
    if (n < 0) note("write");
    if (n > 0) waiting_.erase(waiting_.begin(), waiting_.begin() + n);
    return fits && failure_.empty();
  }
  void wait(std::int64_t at_most_ns) override {
    pollfd watched{.fd = handle(), .events = POLLIN, .revents = 0};
    const timespec time{at_most_ns / 1'000'000'000, at_most_ns % 1'000'000'000};
    ::ppoll(&watched, 1, &time, nullptr);
    if ((watched.revents & (POLLERR | POLLNVAL)) != 0) {
      errno = EIO;
      note("wait");
    }
  }
  std::string_view failure() const override { return failure_; }

 protected:
  virtual ssize_t get(std::span<std::uint8_t> out) = 0;
  virtual ssize_t put(std::span<const std::uint8_t> bytes) = 0;
  virtual int handle() const = 0;

 private:
  void note(const char* what) {
    if (errno == EAGAIN || errno == EINTR) return;
    if (failure_.empty()) failure_ = device_ + ": " + what + ": " + std::strerror(errno);
  }

  std::string device_, failure_;
  std::vector<std::uint8_t> waiting_;
};

class SerialLine final : public LineBase {
 public:
  explicit SerialLine(std::string device) : LineBase(std::move(device)) {}
  ~SerialLine() override {
    if (port_ == nullptr) return;
    if (open_) sp_close(port_);
    sp_free_port(port_);
  }
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  std::string open(const std::string& device, const SerialMode& mode) {
    const auto reason = [&](const char* step, sp_return code) {
      return device + ": " + step + ": " +
             (code == SP_ERR_FAIL ? std::strerror(errno) : "not a serial port that libserialport knows");
    };
    sp_return code = sp_get_port_by_name(device.c_str(), &port_);
    if (code != SP_OK) return reason("look up", code);
    code = sp_open(port_, SP_MODE_READ_WRITE);
    if (code != SP_OK) return reason("open", code);
    open_ = true;
    if ((code = sp_set_baudrate(port_, mode.baud)) != SP_OK) return reason("set the baud rate", code);
    if ((code = sp_set_bits(port_, 8)) != SP_OK) return reason("set 8 bits", code);
    const sp_parity parity = mode.even_parity ? SP_PARITY_EVEN : SP_PARITY_NONE;
    if ((code = sp_set_parity(port_, parity)) != SP_OK) return reason("set the parity", code);
    if ((code = sp_set_stopbits(port_, 1)) != SP_OK) return reason("set 1 stop bit", code);
    if ((code = sp_set_flowcontrol(port_, SP_FLOWCONTROL_NONE)) != SP_OK)
      return reason("no flow control", code);
    sp_flush(port_, SP_BUF_BOTH);
    return {};
  }

 protected:
  ssize_t get(std::span<std::uint8_t> out) override {
    return sp_nonblocking_read(port_, out.data(), out.size());
  }
  ssize_t put(std::span<const std::uint8_t> bytes) override {
    return sp_nonblocking_write(port_, bytes.data(), bytes.size());
  }
  int handle() const override {
    int fd = -1;
    sp_get_port_handle(port_, &fd);
    return fd;
  }

 private:
  sp_port* port_ = nullptr;
  bool open_ = false;
};

class PtyLine final : public LineBase {
 public:
  explicit PtyLine(std::string device) : LineBase(std::move(device)) {}
  ~PtyLine() override {
    if (fd_ >= 0) ::close(fd_);
  }
  PtyLine(const PtyLine&) = delete;
  PtyLine& operator=(const PtyLine&) = delete;

  std::string open(const std::string& device) {
    fd_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    termios mode{};
    if (fd_ < 0 || ::tcgetattr(fd_, &mode) != 0) return device + ": open: " + std::strerror(errno);
    ::cfmakeraw(&mode);
    if (::tcsetattr(fd_, TCSANOW, &mode) != 0) return device + ": raw mode: " + std::strerror(errno);
    return {};
  }

 protected:
  ssize_t get(std::span<std::uint8_t> out) override {
    const ssize_t n = ::read(fd_, out.data(), out.size());
    if (n == 0) {  // the other end is gone
      errno = EIO;
      return -1;
    }
    return n;
  }
  ssize_t put(std::span<const std::uint8_t> bytes) override {
    return ::write(fd_, bytes.data(), bytes.size());
  }
  int handle() const override { return fd_; }

 private:
  int fd_ = -1;
};

bool is_pty(const std::string& device) {
  struct stat s {};
  if (::stat(device.c_str(), &s) != 0 || !S_ISCHR(s.st_mode)) return false;
  return major(s.st_rdev) >= kPtySlaveFirst && major(s.st_rdev) <= kPtySlaveLast;
}

template <class Line, class... More>
std::unique_ptr<ByteLine> opened(const std::string& device, std::string& problem, More... more) {
  auto line = std::make_unique<Line>(device);
  problem = line->open(device, more...);
  if (!problem.empty()) return nullptr;
  return line;
}

}  // namespace

std::unique_ptr<ByteLine> open_byte_line(const std::string& device, const SerialMode& mode,
                                         std::string& problem) {
  std::unique_ptr<ByteLine> line = opened<SerialLine>(device, problem, mode);
  if (line == nullptr && is_pty(device)) line = opened<PtyLine>(device, problem);
  return line;
}

}  // namespace omnihil
