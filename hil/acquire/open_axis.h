// Opens what hangs at the other end of an axis's wire: a motor controller by its bus's name, or a board with the shim.
//
//   if (std::string why = axis_host_problem("odrive", plan.drive); !why.empty()) …       // of the words alone
//   std::unique_ptr<AxisEnd> end = open_bus_axis({.bus = "odrive", .device = "slcan:/dev/ttyACM0"}, plan.drive, 3.0);
//
// Real USB-CAN sticks are opened as the bus needs them (bit rates, CAN FD) where the URL says nothing.
#pragma once
#include <memory>
#include <string>

#include "hil/acquire/acquire_plan.h"
#include "hil/acquire/axis_end.h"

namespace omnihil {

inline constexpr const char* kShimBus = "shim";

struct BusAxisChoice {
  std::string bus, device;
  int id = -1;             // node; -1: the first that the bus has
  bool at_rotor = true;    // what a turn on the bus is a turn of
  bool amplitudes = true;  // of its q axis (bus_axis.h)
};

// Whether this bus has a host's end that can ask for this; else why not. The shim takes duty.
std::string axis_host_problem(const std::string& bus, PlanDrive drive);
int axis_id(const BusAxisChoice& choice);

// Of a bus without such a problem. std::invalid_argument: the wire's words; std::system_error: it cannot be opened.
std::unique_ptr<AxisEnd> open_bus_axis(const BusAxisChoice& choice, PlanDrive drive, double gear_ratio);

}  // namespace omnihil
