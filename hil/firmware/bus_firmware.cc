#include "hil/firmware/bus_firmware.h"

#include <fmt/format.h>

#include <algorithm>

#include "firmware_iface/motor_bus/motor_bus_firmware.h"
#include "hil/loop/session_checks.h"
#include "hil/wire/adapter_port.h"
#include "hil/wire/socketcan_port.h"
#include "hil/wire/uart_port.h"
#include "sim/model/params.h"

namespace omnihil {
namespace {

struct Url {
  std::string scheme, rest;
};
Url split(const std::string& port) {
  const std::size_t colon = port.find(':');
  if (colon == std::string::npos) return {"", port};
  return {port.substr(0, colon), port.substr(colon + 1)};
}

std::string with_id(std::string text, std::uint32_t id) {
  for (std::size_t at; (at = text.find("{id}")) != std::string::npos;)
    text.replace(at, 4, std::to_string(id));
  return text;
}

bool fits(std::string_view scheme, BusCarrier carrier) {
  if (carrier == BusCarrier::kUart) return scheme == "uart" || scheme == "serial";
  return scheme == "can" || scheme == "slcan" || scheme == "fdcanusb";
}

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

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    parts.push_back(text.substr(from, comma - from));
    from = comma + 1;
  }
  return parts;
}

std::unique_ptr<FramePort> open_wire(const Url& url, const MotorBusKind& kind, std::string& problem) {
  const BusCarrier carrier = kind.carrier;
  if (url.scheme == "serial") {
    return open_uart_serial(split_list(url.rest), kind.bit_rate, kind.even_parity, problem);
  }
  if (url.scheme == "can") return open_socketcan(url.rest, carrier, problem);
  if (url.scheme == "slcan") return AdapterPort::open(url.rest, url.scheme, make_slcan_adapter(), problem);
  if (url.scheme == "uart") return open_uart_ptys(url.rest, kWheels, problem);
  return AdapterPort::open(url.rest, url.scheme, make_fdcanusb_adapter(), problem);
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
  const std::string scheme = split(choice.port).scheme;
  if (!fits(scheme, kind->carrier)) {
    problems.push_back(fmt::format("motor bus port: \"{}\": {} runs over {}", choice.port, kind->id,
                                   kind->carrier == BusCarrier::kUart
                                       ? "uart:PATH or serial:DEVICE,DEVICE,DEVICE,DEVICE"
                                       : "can:INTERFACE, slcan:PATH or fdcanusb:PATH"));
  }
  const std::size_t devices = split_list(choice.port).size();
  if (scheme == "serial" && devices != kWheels) {
    problems.push_back(fmt::format("motor bus port: \"{}\": {} devices; needed: one per motor, {}",
                                   choice.port, devices, kWheels));
  }
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
    std::string problem;
    std::unique_ptr<FramePort> wire = open_wire(split(with_id(port, config.robot_id)), *kind, problem);
    if (!wire) throw_problems({"motor bus: " + problem});
    return std::make_unique<MotorBusFirmware>(*kind, setup, shaft, config, std::move(wire));
  };
}

}  // namespace omnihil
