// The UARTs of a motor bus as ptys, one per motor: PATH0 to PATH3. A burst of bytes is a frame.
//
//   std::string problem;
//   auto port = open_uart_ptys("./motor", 4, problem);       // ./motor0 … ./motor3
//
// On the wire a burst ends where the line falls idle; here, where a poll (0.5 ms of the robot's time) brings
// no more bytes. A burst longer than a frame may be is cut there. Parity and baud rate mean nothing on a pty.
// Two bursts that a host writes without a pause arrive as one, which the bus then refuses for its length.
#pragma once
#include <memory>
#include <string>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

std::unique_ptr<FramePort> open_uart_ptys(const std::string& path, int lines, std::string& problem);

}  // namespace omnihil
