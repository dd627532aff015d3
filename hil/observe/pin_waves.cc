#include "hil/observe/pin_waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

namespace omnihil {
namespace {

using Names = std::map<std::pair<char, unsigned>, std::string>;

// What hangs on them, by the board file.
Names names_of(const mcu::BoardSpec& spec) {
  Names names;
  const auto name = [&names](const mcu::PinName& pin, std::string what) {
    names[{pin.port, pin.pin}] += "_" + std::move(what);
  };
  for (const mcu::MotorEntry& motor : spec.motors) {
    if (motor.direction) name(*motor.direction, fmt::format("wheel{}_direction", motor.wheel));
    if (motor.enable) name(*motor.enable, fmt::format("wheel{}_enable", motor.wheel));
    for (std::size_t i = 0; i < motor.encoder_pins.size(); ++i)
      name(motor.encoder_pins[i], fmt::format("wheel{}_{}", motor.wheel, i == 0 ? 'A' : 'B'));
    for (std::size_t i = 0; i < motor.hall_pins.size(); ++i)
      name(motor.hall_pins[i], fmt::format("wheel{}_hall{}", motor.wheel, i + 1));
  }
  for (const mcu::DeviceEntry& device : spec.devices) {
    if (device.select) name(*device.select, device.name + "_select");
    for (const auto& [pin, at] : device.pins) name(at, device.name + "_" + pin);
  }
  for (const mcu::PinEntry& pin : spec.pins) {
    if (pin.break_beam) name(pin.pin, "break_beam");
    if (pin.robot_id_bit >= 0) name(pin.pin, fmt::format("robot_id{}", pin.robot_id_bit));
  }
  return names;
}

}  // namespace

void watch_pins(mcu::McuBoard& board, WaveLog& log, const std::string& scope) {
  const Names names = names_of(board.spec());
  std::vector<mcu::PinBank*> ports = board.chip().ports();
  std::ranges::sort(ports, {}, &mcu::PinBank::letter);
  for (mcu::PinBank* port : ports) {
    std::array<int, 32> signals{};
    signals.fill(-1);
    for (unsigned pin = 0; port->has(pin); ++pin) {
      const auto known = names.find({port->letter(), pin});
      const bool wired = known != names.end();
      signals[pin] =
          log.add(scope, mcu::PinBank::pin_name(port->letter(), pin) + (wired ? known->second : ""),
                  WaveKind::kLevel, 1, {port->level(pin) ? 1u : 0u, false}, wired);
    }
    port->watch_levels([&board, &log, port, signals](std::uint32_t levels) {
      const std::int64_t at_ns = board.now_ns();
      for (unsigned pin = 0; port->has(pin); ++pin) log.put(signals[pin], at_ns, levels >> pin & 1u);
    });
  }
}

}  // namespace omnihil
