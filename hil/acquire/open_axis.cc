#include "hil/acquire/open_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "firmware_iface/motor_bus/motor_bus.h"
#include "hil/acquire/bus_axis.h"
#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

AxisDemand demand_of(PlanDrive drive) {
  return drive == PlanDrive::kMotorVoltage ? AxisDemand::kVoltage : AxisDemand::kTorque;
}

}  // namespace

std::string axis_host_problem(const std::string& bus, PlanDrive drive) {
  const bool duty = drive == PlanDrive::kDuty;
  if (bus == kShimBus) return duty ? "" : "a board with the shim is asked for duty alone";
  const MotorBusKind* kind = find_motor_bus(bus);
  if (kind == nullptr || kind->host == nullptr) {
    std::string known;
    for (const MotorBusKind* each : motor_buses()) {
      if (each->host != nullptr) known += fmt::format("{}, ", each->id);
    }
    return fmt::format("{}; allowed: {}{}",
                       kind != nullptr ? "nobody has needed this end of it" : "there is no such bus", known,
                       kShimBus);
  }
  if (duty || !kind->host(0)->can(demand_of(drive)))
    return fmt::format("cannot be asked for {}", plan_drive_word(drive));
  return "";
}

int axis_id(const BusAxisChoice& choice) {
  if (choice.id >= 0) return choice.id;
  const MotorBusKind* kind = find_motor_bus(choice.bus);
  return kind != nullptr ? std::max(0, kind->default_first_id) : 0;
}

std::unique_ptr<AxisEnd> open_bus_axis(const BusAxisChoice& choice, PlanDrive drive, double gear_ratio) {
  const MotorBusKind& kind = *find_motor_bus(choice.bus);
  const WireQuery usual{{"stick", "1"},
                        {"bitrate", std::to_string(kind.bit_rate)},
                        {"data", std::to_string(kind.data_bit_rate)},
                        {"fd", kind.carrier == BusCarrier::kCanFd ? "1" : "0"}};
  WireProblem problem;
  std::unique_ptr<FrameWire> wire = open_frame_wire(read_wire_url(choice.device), usual, problem);
  if (!wire && problem.code) throw std::system_error(problem.code, problem.what);
  if (!wire) throw std::invalid_argument("--device: " + problem.what);
  return std::make_unique<BusAxis>(
      std::move(wire), kind.host(axis_id(choice)),
      bus_axis_setup(demand_of(drive), choice.at_rotor, gear_ratio, choice.amplitudes));
}

}  // namespace omnihil
