// A CAN bus behind a real USB-CAN stick: its serial port is opened, frames are lines of its language.
//
//   auto wire = open_stick_wire(url, std::move(stick), problem);      // url: slcan:/dev/ttyACM0?stick=1
//
// The other end of adapter_wire.h, where the bench itself is the stick. Answers of the stick to its commands are passed
// over; frames that it refuses show as their answers' absence.
#pragma once
#include <memory>
#include <string>

#include "firmware_iface/motor_bus/bus_frame.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {

// A stick's serial language from the host's side. Pure.
class CanStick {
 public:
  virtual ~CanStick() = default;
  virtual std::string open() const = 0;                                  // said once: bit rate, channel open
  virtual std::string close() const = 0;                                 // said at the end
  virtual bool say(const BusFrame& frame, std::string& line) const = 0;  // false: it cannot carry it
  virtual bool hear(std::string_view line, BusFrame& frame) const = 0;   // false: no frame
};

std::unique_ptr<FrameWire> open_stick_wire(const WireUrl& url, std::unique_ptr<CanStick> stick,
                                           WireProblem& problem);

// Of wire kinds that are a stick or open one.
inline constexpr WireParameter kStickParameter{
    .name = "stick", .says = "1: a stick that is there is opened", .usual = "0", .words = kWireNoYes};

}  // namespace omnihil
