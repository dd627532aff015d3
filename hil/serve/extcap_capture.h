// Packets of a running bench (`serve --capture SOCKET`) into the pipe that Wireshark reads.
//
//   const ExtcapEnd end = copy_capture("/tmp/omnihil-capture", fifo);
//
// Waits for a bench to come, and ends when it ends or when nobody reads the pipe any more.
#pragma once
#include <cstdint>
#include <string>

namespace omnihil {

enum class ExtcapEnd : std::uint8_t {
  kDone,
  kNoPipe,    // the pipe could not be opened; errno says why
  kNoSocket,  // the socket's name cannot be one, or something else is in its place; errno says why
};
ExtcapEnd copy_capture(const std::string& socket, const std::string& pipe);

}  // namespace omnihil
