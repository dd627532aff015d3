// What a host writes to a USB-CAN stick (slcan, fdcanusb), and the frames of it at every motor bus.
//
// Byte 0: bit 0 which stick, the rest which bus. What the stick says it has read it can say again, and slcan reads it as it was.
#include <array>
#include <cmath>
#include <vector>

#include "firmware_iface/motor_bus/motor_bus.h"
#include "firmware_iface/motor_bus/multiplex.h"
#include "hil/wire/can_adapter.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

// Of a small robot with brushless motors; any will do.
RobotConfig robot() {
  RobotConfig config{};
  config.wheel_radius_m = 0.027;
  config.wheel_center_radius_m = 0.08;
  config.gear_ratio = 3.0;
  config.encoder_counts_per_rotor_turn = 4096;
  config.bus_voltage_nominal_V = 24.0;
  config.motor_resistance_ohm = 0.6;
  config.motor_torque_constant_Nm_per_A = 0.025;
  return config;
}

// CAN FD has no length between 8 and 12 and few beyond: a frame is filled up to the next one.
void same(const BusFrame& a, const BusFrame& b) {
  demand(a.id == b.id && a.extended == b.extended && a.remote == b.remote && a.fd == b.fd,
         "a frame's head goes there and back");
  demand(b.size == can_fd_length(can_fd_code(a.size)), "and its length");
  demand(std::equal(a.bytes().begin(), a.bytes().end(), b.bytes().begin()), "and its bytes");
}

void there_and_back(const BusFrame& frame) {
  const auto here = make_slcan_adapter(), there = make_slcan_adapter();
  std::string answer, line;
  std::vector<BusFrame> frames;
  const std::string open = "O\r";
  const auto bytes = [](const std::string& text) {
    return std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  here->receive(bytes(open), frames, answer);
  there->receive(bytes(open), frames, answer);
  demand(here->send(frame, line), "an open stick takes every frame");
  there->receive(bytes(line), frames, answer);
  demand(frames.size() == 1, "one frame, one line");
  same(frame, frames[0]);
}

void at_bus(const MotorBusKind& kind, std::span<const BusFrame> frames) {
  std::array<MotorAxis, kWheels> axes;
  axes.fill(MotorAxis(robot(), BusShaft::kRotor, 500e-6));
  FrameQueue out;
  const auto bus = kind.make({axes, out, {}, 500e-6});
  std::int64_t now_ns = 0;
  for (const BusFrame& frame : frames) {
    bus->receive(frame, now_ns);
    for (MotorAxis& axis : axes) axis.sense(now_ns / 1000, 0.5, 24.0);
    bus->tick(now_ns);
    for (const MotorAxis& axis : axes) demand(std::isfinite(axis.duty_ratio()), "a finite duty");
    now_ns += 500'000;
  }
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const std::uint8_t which = take_byte(bytes);
  const auto stick = (which & 1U) != 0 ? make_fdcanusb_adapter() : make_slcan_adapter();
  std::vector<BusFrame> frames;
  std::string answer;
  while (!bytes.empty()) stick->receive(take_bytes(bytes, 1U + (which >> 4U)), frames, answer);
  for (const BusFrame& frame : frames) {
    demand(frame.id <= (frame.extended ? 0x1FFF'FFFFU : 0x7FFU), "an id that CAN has");
    demand(frame.size <= 64 && (frame.fd || frame.size <= 8), "a length that CAN has");
    answer.clear();
    stick->send(frame, answer);
    there_and_back(frame);
  }
  const auto buses = motor_buses();
  at_bus(*buses[(which >> 1U) % buses.size()], frames);
}
