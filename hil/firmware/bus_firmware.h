// A motor bus and its wire, as a user names them, as a session takes it.
//
//   MotorBusChoice choice{.bus = "odrive", .port = "slcan:./can"};
//   Session session(config, bus_firmware(choice, config));
//
// The port is a wire's URL (hil/wire/wire_url.h): of one for frames, such as can:vcan0, or, of a UART bus, of one
// for bytes per motor, {motor} in it standing for the motor's number: pty:./motor{motor}. {id} stands for the
// robot's id: each robot has a wire of its own.
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
