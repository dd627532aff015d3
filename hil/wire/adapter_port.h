// A CAN bus behind a virtual USB-CAN stick: a pty that a client opens as the adapter's serial port.
//
//   std::string problem;
//   auto port = AdapterPort::open("./can", "slcan", make_slcan_adapter(), problem);
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "hil/wire/can_adapter.h"
#include "hil/wire/pty_transport.h"

namespace omnihil {

class AdapterPort final : public FramePort {
 public:
  static std::unique_ptr<FramePort> open(const std::string& path, const std::string& scheme,
                                         std::unique_ptr<CanAdapter> adapter, std::string& problem);
  bool read(BusFrame& frame) override;
  bool write(const BusFrame& frame) override;
  std::string_view failure() const override { return failure_; }
  std::vector<std::string> report() const override;

 private:
  AdapterPort() = default;
  void flush();

  std::string url_, failure_;
  std::unique_ptr<CanAdapter> adapter_;
  std::unique_ptr<Transport> transport_;
  std::vector<std::uint8_t> bytes_;
  std::vector<BusFrame> frames_;  // in reverse: the next one is the last
  std::string waiting_;           // for the host
};

}  // namespace omnihil
