#include "hil/firmware/bus_firmware.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware_iface/motor_bus/motor_bus_firmware.h"
#include "hil/loop/session_checks.h"
#include "hil/wire/burst_wire.h"
#include "hil/wire/open_wire.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

bool read_order(const std::string& text, std::array<std::uint8_t, kWheels>& order) {
  if (text.size() != 2 * kWheels - 1) return false;
  std::array<bool, kWheels> seen{};
  for (std::size_t m = 0; m < kWheels; ++m) {
    const int wheel = text[2 * m] - '0';
    if (m > 0 && text[2 * m - 1] != ',') return false;
    if (wheel < 0 || wheel >= kWheels || seen[static_cast<std::size_t>(wheel)]) return false;
    seen[static_cast<std::size_t>(wheel)] = true;
    order[m] = static_cast<std::uint8_t>(wheel);
  }
  return true;
}

// What a bus says of its wires where the URL does not; the bench stands for the motors, so others come to it.
WireQuery usual(const MotorBusKind& kind) {
  return {{"baud", std::to_string(kind.bit_rate)},
          {"parity", kind.even_parity ? "even" : "none"},
          {"listen", "1"},
          {"fd", kind.carrier == BusCarrier::kCanFd ? "1" : "0"}};
}

std::unique_ptr<FrameWire> open_wire(const std::string& port, const MotorBusKind& kind,
                                     WireProblem& problem) {
  if (kind.carrier != BusCarrier::kUart) return open_frame_wire(read_wire_url(port), usual(kind), problem);
  std::vector<std::unique_ptr<ByteWire>> lines;
  for (const WireUrl& url : read_motor_wires(port, kWheels)) {
    lines.push_back(open_byte_wire(url, usual(kind), problem));
    if (!lines.back()) return nullptr;
  }
  return make_burst_wire(std::move(lines));
}

void check_wire(const std::string& port, const MotorBusKind& kind, std::vector<std::string>& problems) {
  const auto refuse = [&](const std::string& why) {
    problems.push_back(fmt::format("motor bus port: \"{}\": {}", port, why));
  };
  const bool uart = kind.carrier == BusCarrier::kUart;
  const std::vector<WireUrl> wires =
      uart ? read_motor_wires(port, kWheels) : std::vector<WireUrl>{read_wire_url(port)};
  if (uart && wires.size() != kWheels) {
    refuse(wires.empty()
               ? fmt::format("{} has a wire per motor, of {}; put {{motor}} where its number goes, such "
                             "as pty:./motor{{motor}}",
                             kind.id, known_wires(WireForm::kBytes))
               : fmt::format("{} devices; needed: one per motor, {}", wires.size(), kWheels));
    return;
  }
  for (const std::string& why : wire_problems(wires[0], uart ? WireForm::kBytes : WireForm::kFrames))
    problems.push_back("motor bus port: " + why);
}

void check_bus(const MotorBusChoice& choice, const MotorBusKind* kind, std::vector<std::string>& problems) {
  std::vector<std::string_view> known;
  for (const MotorBusKind* each : motor_buses()) known.push_back(each->id);
  if (kind == nullptr) {
    const std::string_view nearest = nearest_spelling(choice.bus, known);
    problems.push_back(fmt::format("motor bus: \"{}\" is none{}; known: {}", choice.bus,
                                   nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest),
                                   fmt::join(known, ", ")));
    return;
  }
  check_wire(choice.port, *kind, problems);
  if (choice.first_id >= 0 && (kind->default_first_id < 0 || choice.first_id > kind->max_first_id)) {
    problems.push_back(kind->default_first_id < 0
                           ? fmt::format("motor bus first id: {} has fixed ids", kind->id)
                           : fmt::format("motor bus first id: {}; allowed with {}: 0 to {}", choice.first_id,
                                         kind->id, kind->max_first_id));
  }
}

}  // namespace

Session::FirmwareMaker bus_firmware(const MotorBusChoice& choice, const SessionConfig& session) {
  std::vector<std::string> problems;
  const MotorBusKind* kind = find_motor_bus(choice.bus);
  check_bus(choice, kind, problems);
  MotorBusSetup setup{.first_id = choice.first_id, .watchdog_s = choice.watchdog_ms * 1e-3};
  if (!read_order(choice.order, setup.order)) {
    problems.push_back(fmt::format(
        "motor bus order: \"{}\"; allowed: each wheel of the model once, such as 0,1,2,3", choice.order));
  }
  if (choice.shaft != "rotor" && choice.shaft != "wheel") {
    problems.push_back(fmt::format("motor bus shaft: \"{}\"; allowed: rotor, wheel", choice.shaft));
  }
  if (!(choice.watchdog_ms <= 60e3)) {
    problems.push_back(fmt::format("motor bus watchdog: {} ms; allowed: 0 to 60000", choice.watchdog_ms));
  }
  if (session.robot_ids.size() > 1 && choice.port.find("{id}") == std::string::npos) {
    problems.push_back(
        fmt::format("motor bus port: \"{}\" for {} robots: each needs a wire of its own; put "
                    "{{id}} where the robot's number goes, or serve one robot",
                    choice.port, session.robot_ids.size()));
  }
  throw_problems(problems);
  const BusShaft shaft = choice.shaft == "wheel" ? BusShaft::kWheel : BusShaft::kRotor;
  return [kind, setup, shaft, port = choice.port](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    WireProblem problem;
    std::unique_ptr<FrameWire> wire = open_wire(with_number(port, "{id}", config.robot_id), *kind, problem);
    if (!wire) throw_problems({"motor bus: " + problem.text()});
    return std::make_unique<MotorBusFirmware>(*kind, setup, shaft, config, std::move(wire));
  };
}

}  // namespace omnihil
