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

// The ways a bus may run over, in the order a user reads them.
struct WireScheme {
  std::string_view scheme;
  std::string_view rest;  // what follows the colon
  bool uart;              // for buses on UARTs; else for CAN
  std::unique_ptr<FramePort> (*open)(const std::string& rest, const MotorBusKind& kind, std::string& problem);
};
constexpr WireScheme kSchemes[] = {
    {"uart", "PATH", true,
     [](const std::string& rest, const MotorBusKind&, std::string& problem) {
       return open_uart_ptys(rest, kWheels, problem);
     }},
    {"serial", "DEVICE,DEVICE,DEVICE,DEVICE", true,
     [](const std::string& rest, const MotorBusKind& kind, std::string& problem) {
       return open_uart_serial(split_list(rest), kind.bit_rate, kind.even_parity, problem);
     }},
    {"can", "INTERFACE", false,
     [](const std::string& rest, const MotorBusKind& kind, std::string& problem) {
       return open_socketcan(rest, kind.carrier, problem);
     }},
    {"slcan", "PATH", false,
     [](const std::string& rest, const MotorBusKind&, std::string& problem) {
       return AdapterPort::open(rest, "slcan", make_slcan_adapter(), problem);
     }},
    {"fdcanusb", "PATH", false,
     [](const std::string& rest, const MotorBusKind&, std::string& problem) {
       return AdapterPort::open(rest, "fdcanusb", make_fdcanusb_adapter(), problem);
     }},
};

bool fits(const WireScheme& wire, const MotorBusKind& kind) {
  return wire.uart == (kind.carrier == BusCarrier::kUart);
}

// nullptr: the bus does not run over this.
const WireScheme* scheme_of(const MotorBusKind& kind, std::string_view scheme) {
  for (const WireScheme& wire : kSchemes) {
    if (wire.scheme == scheme && fits(wire, kind)) return &wire;
  }
  return nullptr;
}

// "can:INTERFACE, slcan:PATH or fdcanusb:PATH"
std::string schemes_of(const MotorBusKind& kind) {
  std::vector<std::string> ways;
  for (const WireScheme& wire : kSchemes) {
    if (fits(wire, kind)) ways.push_back(fmt::format("{}:{}", wire.scheme, wire.rest));
  }
  const std::string last = ways.back();
  ways.pop_back();
  return fmt::format("{} or {}", fmt::join(ways, ", "), last);
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
  if (scheme_of(*kind, scheme) == nullptr) {
    problems.push_back(
        fmt::format("motor bus port: \"{}\": {} runs over {}", choice.port, kind->id, schemes_of(*kind)));
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
    const Url url = split(with_id(port, config.robot_id));
    std::unique_ptr<FramePort> wire = scheme_of(*kind, url.scheme)->open(url.rest, *kind, problem);
    if (!wire) throw_problems({"motor bus: " + problem});
    return std::make_unique<MotorBusFirmware>(*kind, setup, shaft, config, std::move(wire));
  };
}

}  // namespace omnihil
