// A wire that carries frames: CAN, or the bursts of a UART. Never blocks. Given from outside (hil/wire).
//
//   while (wire.read(frame)) bus.receive(frame, now_ns);
//   if (!wire.write(answer)) ++not_sent;
//   if (wire.error()) …                                   // the wire is gone
#pragma once
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

class FrameWire {
 public:
  virtual ~FrameWire() = default;
  virtual std::string_view name() const = 0;            // in messages: "can:can0"
  virtual bool read(BusFrame& frame) = 0;               // false: nothing waits
  virtual bool write(const BusFrame& frame) = 0;        // false: not taken (counted by the caller)
  virtual std::error_code error() const { return {}; }  // why the wire is gone
  virtual int handle() const { return -1; }  // readable when frames wait; -1: there is none to watch
  virtual std::vector<std::string> report() const { return {}; }  // after a run, a line each
};

}  // namespace omnihil
