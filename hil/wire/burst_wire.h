// The lines of a motor bus, one byte wire per motor, as one wire of frames: a burst of bytes is a frame, the
// number of its line the frame's id.
//
//   std::unique_ptr<FrameWire> wire = make_burst_wire(std::move(lines));
//
// On a UART a burst ends where the line falls idle; here, where a poll (0.5 ms of the robot's time) brings
// no more bytes. A burst longer than a frame may be is cut there.
// Two bursts that a host writes without a pause arrive as one, which the bus then refuses for its length.
#pragma once
#include <memory>
#include <vector>

#include "firmware_iface/motor_bus/frame_wire.h"
#include "hil/wire/byte_wire.h"

namespace omnihil {

std::unique_ptr<FrameWire> make_burst_wire(std::vector<std::unique_ptr<ByteWire>> lines);

}  // namespace omnihil
