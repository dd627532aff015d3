// Where the AI host's bytes come from and where the dongle's bytes go. Never blocks.
//
//   transport.read(bytes, 4096);                           // what has arrived, in order
//   if (transport.take_host_closed()) session.host_closed();  // after the last of those bytes
//   if (transport.host_present()) transport.write(answer, error);
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace omnihil {

class Transport {
 public:
  virtual ~Transport() = default;
  virtual std::string_view url() const = 0;  // "pty:./dongle"
  // Appends what has arrived, at most `limit` bytes, so that a flood cannot stall the loop.
  virtual std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) = 0;
  // Takes as many bytes as fit now; returns how many. The rest stays with the caller.
  virtual std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) = 0;
  virtual bool host_present() const = 0;  // a client has the port open (as far as the transport can tell)
  // True once after each time the client went away; everything it had written has been read before.
  virtual bool take_host_closed() = 0;
};

}  // namespace omnihil
