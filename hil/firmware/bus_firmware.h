// A motor bus and its wire, as a user names them, as a session takes it.
//
//   MotorBusChoice choice{.bus = "odrive", .port = "slcan:./can"};
//   Session session(config, bus_firmware(choice, config));
//
//   can:vcan0        an interface of this computer (SocketCAN)
//   slcan:./can      a pty that is a LAWICEL USB-CAN stick to whoever opens it
//   fdcanusb:./can   a pty that is an mjbots fdcanusb
//   uart:./motor     ptys ./motor0 to ./motor3 (UART buses)
//   serial:A,B,C,D   serial ports of this computer, one per motor (UART buses)
//   {id}             in any of them stands for the robot's id: each robot has a wire of its own
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/loop/session.h"

namespace omnihil {

struct MotorBusChoice {
  std::string bus;  // empty: none
  std::string port;
  std::string shaft = "rotor";    // what a "turn" on the bus is a turn of; or "wheel"
  std::string order = "0,1,2,3";  // wheel of the model at motor 0, 1, 2, 3
  int first_id = -1;              // of motor 0; -1: the bus's own
  double watchdog_ms = -1.0;      // 0: none; below 0: the device's own
};

// Throws std::invalid_argument with every problem of the words; the maker does when a wire cannot be opened.
Session::FirmwareMaker bus_firmware(const MotorBusChoice& choice, const SessionConfig& session);

}  // namespace omnihil
