// A CAN interface of this computer (SocketCAN): can0 of an adapter, vcan0 between programs.
//
//   std::string problem;
//   auto port = open_socketcan("vcan0", BusCarrier::kCanFd, problem);  // nullptr: `problem` says why
//
// Bit rates are the interface's own business (ip link set can0 type can bitrate ...). A full send queue
// (ENOBUFS, EAGAIN) counts the frame as not taken; an interface that goes down or away ends the bus.
#pragma once
#include <memory>
#include <string>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {

std::unique_ptr<FramePort> open_socketcan(const std::string& interface, BusCarrier carrier,
                                          std::string& problem);

}  // namespace omnihil
