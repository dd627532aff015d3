// A serial device as a client opens it: raw, 8N1, 115200 baud, never blocking. For `omnihil play`, which
// stands for an AI host and so shares nothing with the bench's end of the line.
//
//   std::error_code error;
//   auto port = ClientPort::open("./dongle", error);
//   port->write(bytes, error);
//
// By termios and not by libserialport: that library refuses pseudo-terminals.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <vector>

namespace omnihil {

class ClientPort {
 public:
  // Null and `error` when it cannot be opened, or is no serial device (not_a_terminal: ENOTTY).
  static std::unique_ptr<ClientPort> open(const std::filesystem::path& path, std::error_code& error);
  ~ClientPort();
  ClientPort(const ClientPort&) = delete;
  ClientPort& operator=(const ClientPort&) = delete;

  // Waits until something can be read, or written if `to_write`, or `timeout_ns` is over, or a signal came.
  void wait(std::int64_t timeout_ns, bool to_write) const;
  // Takes what fits now; returns how many bytes.
  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error);
  // Appends what is there; io_error when the other end is gone.
  void read(std::vector<std::uint8_t>& out, std::error_code& error);

 private:
  explicit ClientPort(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace omnihil
