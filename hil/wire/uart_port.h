// The UARTs of a motor bus, one per motor. A burst of bytes is a frame.
//
//   std::string problem;
//   auto port = open_uart_ptys("./motor", 4, problem);       // ptys ./motor0 ... ./motor3
//   auto port = open_uart_serial({"/dev/ttyUSB0", "/dev/ttyUSB1", ...}, 2'000'000, true, problem);
//
// On the wire a burst ends where the line falls idle; here, where a poll (0.5 ms of the robot's time) brings
// no more bytes. A burst longer than a frame may be is cut there. Parity and baud rate mean nothing on a pty.
// Two bursts that a host writes without a pause arrive as one, which the bus then refuses for its length.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

std::unique_ptr<FramePort> open_uart_ptys(const std::string& path, int lines, std::string& problem);
// Serial ports of this computer, 8 data bits, even parity or none; device i is motor i.
std::unique_ptr<FramePort> open_uart_serial(const std::vector<std::string>& devices, int baud,
                                            bool even_parity, std::string& problem);

}  // namespace omnihil
