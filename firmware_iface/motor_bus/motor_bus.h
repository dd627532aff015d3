// A motor bus: what the motor controllers of one robot say and do on the wire between them and the main
// board. One bus, one file in buses/; the list is generated from that folder: a file added is a bus added.
// What a main board says to emulated boards is a table in a file (wheel_words.h).
//
//   const MotorBusKind* kind = find_motor_bus("odrive");
//   auto bus = kind->make({axes, out, setup});
//   BusVerdict verdict = bus->receive(frame, now_ns);      // anything but kOk changed nothing
//   bus->tick(now_ns);                                     // timeouts, demands to the axes, cyclic frames
//   std::unique_ptr<AxisHost> host = kind->host(1);        // the other end of the wire, of one motor (axis_host.h)
//
// Motor m of the bus is wheel `order[m]` of the robot's model.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/motor_bus/axis_host.h"
#include "firmware_iface/motor_bus/bus_frame.h"
#include "firmware_iface/motor_bus/motor_axis.h"

namespace omnihil {

enum class BusVerdict : std::uint8_t {
  kOk,
  kNotOurs,         // a well-formed frame for somebody else
  kWrongKind,       // classic, FD, remote, extended or not, as this bus never has it
  kUnknownCommand,  // id or type that the device does not know
  kLength,
  kMalformed,    // subframes that do not add up
  kNotFinite,    // a number that is none
  kUnsupported,  // the device knows it; this model of it does not, or refuses the value
  kCount
};
std::string_view to_string(BusVerdict verdict);

enum class BusCarrier : std::uint8_t { kCan, kCanFd, kUart };

struct MotorBusSetup {
  std::array<std::uint8_t, kWheels> order{0, 1, 2, 3};
  int first_id = -1;         // node id of motor 0, the others follow; -1: the bus's own default
  double watchdog_s = -1.0;  // 0: none; below 0: the device's own default
};

struct MotorBusContext {
  std::array<MotorAxis, kWheels>& axes;  // by motor number
  FrameQueue& out;
  MotorBusSetup setup;
  double period_s = 0;
};

class MotorBus {
 public:
  virtual ~MotorBus() = default;
  virtual BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) = 0;
  virtual void tick(std::int64_t now_ns) = 0;
  std::uint64_t timeouts() const { return timeouts_; }

 protected:
  std::uint64_t timeouts_ = 0;  // motors stopped because no command came
};

struct MotorBusKind {
  std::string_view id;
  std::string_view title;
  BusCarrier carrier;
  int bit_rate;
  int data_bit_rate;          // CAN FD; 0: none
  int default_first_id;       // -1: ids are fixed
  int max_first_id;           // such that all four fit
  double default_watchdog_s;  // 0: none
  bool even_parity = false;   // UART
  std::unique_ptr<AxisHost> (*host)(int id) =
      nullptr;  // of the motor with this id; null: nobody has needed it
  std::unique_ptr<MotorBus> (*make)(const MotorBusContext& context);
};

std::span<const MotorBusKind* const> motor_buses();
const MotorBusKind* find_motor_bus(std::string_view id);

}  // namespace omnihil
