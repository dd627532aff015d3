// The process that holds one robot's firmware, seen from the bench: start, ask, and know how it ended.
//
//   FirmwareProcess process(10.0);                       // throws std::system_error if it cannot be started
//   process.send({FirmwareCall::kTick}, &sensors, sizeof sensors);
//   std::span<const std::uint8_t> answer = process.receive();     // empty: it is no more
//   process.end();                                       // "crashed in tick() at tick 1234 …"
//
// The deadline is of wall time and for hangs alone: an answer that comes is the same whenever it comes. It does not end a
// process that a debugger is attached to.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hil/firmware/wire.h"

namespace omnihil {

class FirmwareProcess {
 public:
  explicit FirmwareProcess(double deadline_s);
  ~FirmwareProcess();
  FirmwareProcess(const FirmwareProcess&) = delete;
  FirmwareProcess& operator=(const FirmwareProcess&) = delete;

  void send(WireRequest request, const void* body, std::size_t bytes);
  std::span<const std::uint8_t> receive();  // valid until the next one
  // How it ended, in words without addresses: the same crash reads the same every time. Empty: it lives.
  const std::string& end() const { return end_; }

 private:
  void start();
  bool wait_for(short what);
  void note_end(bool hung);
  std::string end_words(int status) const;
  std::string where() const;

  double deadline_s_;
  int socket_ = -1;
  pid_t child_ = -1;
  WirePage* page_ = nullptr;
  std::vector<std::uint8_t> out_, in_;
  std::string end_;
};

}  // namespace omnihil
