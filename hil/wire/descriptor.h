// A file descriptor that never blocks: closed by its owner, read until nothing waits, written until it is full,
// waited for.
//
//   Descriptor port(::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC));
//   const FdRead got = read_available(port.get(), bytes, 4096);
//   const std::size_t sent = write_some(port.get(), answer, error);
//   error = wait_for(port.get(), 1'000'000, false);              // until bytes come, 1 ms at most
#pragma once
#include <sys/types.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

namespace omnihil {

class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    reset(std::exchange(other.fd_, -1));
    return *this;
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  void reset(int fd = -1) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

std::error_code last_error();  // errno

struct FdRead {
  std::size_t bytes = 0;
  bool ended = false;     // read() gave 0: on most descriptors the other end is gone
  std::error_code error;  // none of "nothing waits" and "interrupted"
};
// Appends what waits, at most `limit` bytes.
FdRead read_available(int fd, std::vector<std::uint8_t>& out, std::size_t limit);

using FdPut = ssize_t (*)(int fd, const void* data, std::size_t size);
// Takes what fits; how many bytes did. `error` is cleared first; a full descriptor is none.
std::size_t write_some(int fd, std::span<const std::uint8_t> bytes, std::error_code& error,
                       FdPut put = ::write);

// Waits until something can be read, or written if `to_write`, or the time is over, or a signal came. An
// error: the device is gone. fd -1: waits for the time to be over.
std::error_code wait_for(int fd, std::int64_t at_most_ns, bool to_write);

}  // namespace omnihil
