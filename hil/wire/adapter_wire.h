// A CAN bus behind a virtual USB-CAN stick: a pty that a client opens as the adapter's serial port.
//
//   auto wire = open_adapter_wire(url, make_slcan_adapter(), problem);        // url: slcan:./can
#pragma once
#include <memory>

#include "hil/wire/can_adapter.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {

std::unique_ptr<FrameWire> open_adapter_wire(const WireUrl& url, std::unique_ptr<CanAdapter> adapter,
                                             WireProblem& problem);

}  // namespace omnihil
