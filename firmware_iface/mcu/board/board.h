// A board: one microcontroller with its image, wired to motors, sensors and a radio as its file says.
//
//   McuBoard board(spec, image);                 // throws std::invalid_argument naming what does not fit
//   board.set_world(world);                      // shafts, currents, voltage at board.now_ns()
//   board.run_until_ns(end_ns);
//   board.wire(2)->end(end_ns);                  // what motor 2's bridge did on the mean
//
// Deterministic: a function of spec, image, worlds and packets with their instants.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/device_alarm.h"
#include "firmware_iface/mcu/board/encoder_lines.h"
#include "firmware_iface/mcu/board/hall_lines.h"
#include "firmware_iface/mcu/board/motor_wire.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "firmware_iface/mcu/machine/machine.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

class Adc;
class SerialPort;

class McuBoard {
 public:
  McuBoard(const BoardSpec& spec, const ElfImage& image);
  ~McuBoard();

  const BoardSpec& spec() const { return spec_; }
  Machine& machine() { return machine_; }
  const Machine& machine() const { return machine_; }
  Chip& chip() { return chip_; }
  const Chip& chip() const { return chip_; }
  std::int64_t now_ns() const { return machine_.to_ns(machine_.now()); }
  void set_world(const WorldState& world);
  const WorldState& world() const { return world_; }
  // Hears of each world before it is set: world() is then the one that held until now.
  void watch_world(std::function<void(const WorldState& next)> watcher) { watcher_ = std::move(watcher); }
  void run_until_ns(std::int64_t end_ns) {
    if (!due_.empty()) run_to_due(end_ns);
    machine_.run_until_ns(end_ns);
  }
  // Does `work` between two instructions, at the first boundary at or after this instant.
  void at(std::int64_t at_ns, std::function<void()> work) { due_.emplace(at_ns, std::move(work)); }
  MotorWire* wire(int wheel) const;  // null: the board drives no such motor
  Device* device(std::string_view name) const;
  // Packets of the radio, at now_ns().
  void radio_receive(std::span<const std::uint8_t> frame);
  // The next packet that the board has sent: of a radio chip as it was, of a serial port what stood without a
  // gap.
  bool radio_transmit(std::vector<std::uint8_t>& frame);

 private:
  struct Wired {
    std::unique_ptr<DeviceAlarm> alarm;
    std::unique_ptr<Device> device;
    DeviceEntry entry;
  };
  void run_to_due(std::int64_t end_ns);
  template <class Lines>
  void add_lines(const MotorEntry& entry);
  void wire_motors();
  void wire_device(const DeviceEntry& entry);
  void wire_device_pins(Device& device, const DeviceEntry& entry);
  void wire_analog();
  double analog_value(const AnalogEntry& entry, std::int64_t at_ns) const;
  double phase_voltage_V(int wheel, std::size_t phase) const;
  double shunt_current_A(int wheel, std::size_t phase, std::int64_t at_ns) const;
  void wire_radio();
  void wire_commands();
  DeviceWorld device_world(const DeviceEntry& entry);

  BoardSpec spec_;
  Machine machine_;
  Chip chip_;
  WorldState world_;
  std::vector<std::unique_ptr<MotorWire>> wires_;
  std::vector<std::unique_ptr<ShaftLines>> lines_;
  std::vector<Wired> devices_;
  std::vector<Adc*> adcs_;  // that something of the world is wired to
  Device* radio_ = nullptr;
  SerialPort* serial_ = nullptr;
  std::vector<std::uint8_t> sent_;  // bytes of a serial radio, not yet a frame
  std::int64_t sent_last_ns_ = 0;
  std::multimap<std::int64_t, std::function<void()>> due_;
  std::function<void(const WorldState&)> watcher_;
};

}  // namespace omnihil::mcu
