#include "firmware_iface/mcu/board/board.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "firmware_iface/mcu/stm32/adc/adc.h"
#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/i2c.h"
#include "firmware_iface/mcu/stm32/sdmmc.h"
#include "firmware_iface/mcu/stm32/serial_port.h"
#include "firmware_iface/mcu/stm32/spi.h"

namespace omnihil::mcu {
namespace {
// No chip has anything here; wires and alarms only have events.
constexpr std::uint32_t kWiresBase = 0x5FFF0000, kAlarmsBase = 0x5FFE0000;

MachineConfig configuration(const BoardSpec& spec) {
  MachineConfig config = machine_config(*spec.chip);
  config.cpi_scale = spec.cpi_scale;
  if (spec.boot_address) config.boot_address = *spec.boot_address;
  return config;
}

double clamp_ratio(double ratio) { return std::clamp(ratio, -1.0, 1.0); }
}  // namespace

McuBoard::McuBoard(const BoardSpec& spec, const ElfImage& image)
    : spec_(spec), machine_(configuration(spec)), chip_(*spec.chip, machine_) {
  chip_.context().clocks.hse_hz = spec.crystal_Hz;
  if (spec.boot_address) chip_.flash()->set_boot_address(*spec.boot_address);
  attach(chip_, machine_);
  wire_motors();
  for (const DeviceEntry& entry : spec_.devices) wire_device(entry);
  wire_analog();
  for (const PinEntry& entry : spec_.pins)
    chip_.port(entry.pin.port)->drive(entry.pin.pin, entry.break_beam ? !entry.level : entry.level);
  wire_radio();
  wire_commands();
  std::vector<std::string> problems;
  if (!machine_.load(image, problems)) {
    std::string all;
    for (const std::string& problem : problems) all += (all.empty() ? "" : "\n") + problem;
    throw std::invalid_argument(all);
  }
  for (const FlashEntry& entry : spec_.flash) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint32_t word : entry.words) {
      for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
    }
    machine_.program_flash(entry.address, bytes);
  }
  machine_.power_on();
  for (const Wired& wired : devices_) wired.device->reset();
}

McuBoard::~McuBoard() = default;

template <class Lines>
void McuBoard::add_lines(const MotorEntry& entry) {
  lines_.push_back(
      std::make_unique<Lines>(entry, chip_, machine_, [this]() -> const WorldState& { return world_; }));
  machine_.attach(kWiresBase + 16 * static_cast<std::uint32_t>(lines_.size()), 4, *lines_.back());
}

void McuBoard::wire_motors() {
  for (const MotorEntry& entry : spec_.motors) {
    wires_.push_back(std::make_unique<MotorWire>(entry, chip_, [this] { return now_ns(); }));
    if (!entry.encoder_timer.empty()) {
      chip_.find<Timer>(entry.encoder_timer)
          ->set_shaft([this, wheel = entry.wheel, sign = entry.encoder_sign](std::int64_t at_ns) {
            const std::int64_t counts = world_.encoder_counts(wheel, at_ns);
            return sign < 0 ? -counts : counts;
          });
    }
    if (!entry.encoder_pins.empty()) add_lines<EncoderLines>(entry);
    if (entry.hall_pole_pairs > 0 && (!entry.hall_timer.empty() || !entry.hall_pins.empty()))
      add_lines<HallLines>(entry);
  }
}

DeviceWorld McuBoard::device_world(const DeviceEntry& entry) {
  DeviceWorld world;
  world.now_ns = [this] { return now_ns(); };
  world.angle_rad = [this, entry](std::int64_t at_ns) {
    const double rotor = world_.rotor_rad(entry.wheel, at_ns);
    return entry.on_wheel_shaft ? rotor / world_.gear_ratio : rotor;
  };
  world.bus_voltage_V = [this](std::int64_t) { return world_.bus_voltage_V; };
  world.bus_current_A = [this](std::int64_t) {
    double sum_A = 0.0;
    for (const auto& wire : wires_) {
      const double current_A = world_.motor_current_A[static_cast<std::size_t>(wire->entry().wheel)];
      sum_A += clamp_ratio(wire->now().duty_ratio) * current_A;  // what the bridge takes from the bus
    }
    return sum_A;
  };
  world.motor_current_A = [this, entry](std::int64_t) {
    return world_.motor_current_A[static_cast<std::size_t>(entry.wheel)];
  };
  world.gyro_z_rad_s = [this](std::int64_t) { return world_.gyro_z_rad_s; };
  world.accel_x_m_s2 = [this](std::int64_t) { return world_.accel_x_m_s2; };
  world.accel_y_m_s2 = [this](std::int64_t) { return world_.accel_y_m_s2; };
  world.settings = entry.settings;
  world.card = entry.card;
  return world;
}

void McuBoard::wire_device(const DeviceEntry& entry) {
  Wired wired{nullptr, nullptr, entry};
  const std::size_t place = devices_.size();
  wired.alarm =
      std::make_unique<DeviceAlarm>(entry.name, machine_, [this, place] { devices_[place].device->woken(); });
  machine_.attach(kAlarmsBase + 16 * static_cast<std::uint32_t>(place), 4, *wired.alarm);
  DeviceWorld world = device_world(entry);
  world.wake_at = [alarm = wired.alarm.get()](std::int64_t at_ns) { alarm->set(at_ns); };
  wired.device = entry.kind->make(world);
  devices_.push_back(std::move(wired));
  Device* device = devices_.back().device.get();
  if (SpiDevice* slave = device->spi()) {
    Spi* bus = chip_.find<Spi>(entry.bus);
    bus->connect(*slave);
    // Selected while the pin is low; until the firmware makes it an output, a pull-up keeps it high.
    PinBank* port = chip_.port(entry.select->port);
    const unsigned pin = entry.select->pin;
    const auto follow = [bus, slave, port, pin] {
      bus->select(*slave, port->mode(pin) == PinMode::kOutput && !port->output(pin));
    };
    port->on_output(pin, [follow](bool) { follow(); });
    port->on_modes(follow);
  }
  if (SdDevice* card = device->sd()) chip_.find<Sdmmc>(entry.bus)->connect(*card);
  if (I2cDevice* slave = device->i2c()) chip_.find<I2c>(entry.bus)->connect(*slave);
  wire_device_pins(*device, entry);
}

void McuBoard::wire_device_pins(Device& device, const DeviceEntry& entry) {
  for (const std::string_view name : device.inputs()) {
    const auto at = entry.pins.find(name);
    if (at == entry.pins.end()) continue;
    chip_.port(at->second.port)->on_output(at->second.pin, [&device, name](bool level) {
      device.input(name, level);
    });
    device.input(name, false);  // as the pin is before the image makes anything of it
  }
  std::map<std::string, PinName, std::less<>> pins = entry.pins;
  if (MotorWire* motor = wire(entry.wheel); motor != nullptr && device.gates_bridge()) motor->gate_by(device);
  Timer* broken = entry.breaks.empty() ? nullptr : chip_.find<Timer>(entry.breaks);
  device.on_output([this, pins, broken](std::string_view name, bool level) {
    if (broken != nullptr && name == "fault") broken->break_input(level);
    const auto at = pins.find(name);
    if (at != pins.end()) chip_.port(at->second.port)->drive(at->second.pin, level);
  });
}

double McuBoard::analog_value(const AnalogEntry& entry, std::int64_t at_ns) const {
  const auto wheel = static_cast<std::size_t>(entry.wheel), phase = static_cast<std::size_t>(entry.phase);
  switch (entry.signal) {
    case AnalogSignal::kBusVoltage:
      return world_.bus_voltage_V;
    case AnalogSignal::kMotorCurrent:
      return world_.motor_current_A[wheel];
    case AnalogSignal::kPhaseCurrent:
      return world_.phase_A(entry.wheel, phase, at_ns);
    case AnalogSignal::kPhaseVoltage:
      return phase_voltage_V(entry.wheel, phase);
    case AnalogSignal::kShuntCurrent:
      return shunt_current_A(entry.wheel, phase, at_ns);
    case AnalogSignal::kConstant:
      break;
  }
  return 0.0;
}

// On the mean of the PWM period, against the bus's minus, as its RC filter shows it. A leg that is off is what windings and
// diodes have made of it in the last period.
double McuBoard::phase_voltage_V(int wheel, std::size_t phase) const {
  const MotorWire* motor = this->wire(wheel);
  if (motor == nullptr || !motor->phases()) return 0.0;
  std::uint32_t leg[kLegs];
  double duty[kLegs];
  motor->legs(leg, duty);
  if (leg[phase] == OMNIHIL_LEG_LOW) return 0.0;
  if (leg[phase] == OMNIHIL_LEG_OFF) return world_.leg_V[static_cast<std::size_t>(wheel)][phase];
  return duty[phase] * world_.bus_voltage_V;
}

// Of a shunt between the lower switch and the bus's minus: the phase's current while that switch or its diode carries it.
double McuBoard::shunt_current_A(int wheel, std::size_t phase, std::int64_t at_ns) const {
  const MotorWire* motor = this->wire(wheel);
  if (motor == nullptr || !motor->phases()) return 0.0;
  const double current_A = world_.phase_A(wheel, phase, at_ns);
  switch (motor->path(phase)) {
    case CurrentPath::kLower:
      return current_A;
    case CurrentPath::kDiodes:
      return std::max(current_A, 0.0);
    case CurrentPath::kUpper:
      break;
  }
  return 0.0;
}

void McuBoard::wire_analog() {
  for (const std::string& name : chip_.names<Adc>())
    chip_.find<Adc>(name)->reference_V = spec_.adc_reference_V;
  for (const AnalogEntry& entry : spec_.analog) {
    Adc* adc = chip_.find<Adc>(entry.adc);
    const bool of_timers =
        entry.signal == AnalogSignal::kPhaseVoltage || entry.signal == AnalogSignal::kShuntCurrent;
    adc->set_source(
        entry.channel,
        [this, entry](std::int64_t at_ns) {
          return entry.offset_V + entry.volts_per_unit * analog_value(entry, at_ns);
        },
        !of_timers);
    if (std::find(adcs_.begin(), adcs_.end(), adc) == adcs_.end()) adcs_.push_back(adc);
  }
}

// The main board is at the other end; what it is answered is dropped.
void McuBoard::wire_commands() {
  const std::string& via = spec_.wheel_commands.via;
  if (auto* serial = chip_.find<SerialPort>(via)) serial->on_transmit([](std::uint8_t, Cycles) {});
  if (auto* can = chip_.find<CanPort>(via)) can->on_transmit([](const CanFrame&, Cycles) {});
}

void McuBoard::wire_radio() {
  if (spec_.radio_via.empty()) return;
  radio_ = device(spec_.radio_via);
  if (radio_ != nullptr) return;
  serial_ = chip_.find<SerialPort>(spec_.radio_via);
  serial_->on_transmit([this](std::uint8_t byte, Cycles end) {
    sent_.push_back(byte);
    sent_last_ns_ = machine_.to_ns(end);
  });
}

void McuBoard::run_to_due(std::int64_t end_ns) {
  while (!due_.empty() && due_.begin()->first < end_ns) {
    machine_.run_until_ns(due_.begin()->first);
    const auto work = std::move(due_.begin()->second);
    due_.erase(due_.begin());
    work();
  }
}

void McuBoard::set_world(const WorldState& world) {
  if (watcher_) watcher_(world);
  for (Adc* adc : adcs_) adc->take_samples();
  world_ = world;
  for (const auto& lines : lines_) lines->world_changed();
  for (const Wired& wired : devices_) wired.device->world_changed();
}

MotorWire* McuBoard::wire(int wheel) const {
  for (const auto& wire : wires_) {
    if (wire->entry().wheel == wheel) return wire.get();
  }
  return nullptr;
}

Device* McuBoard::device(std::string_view name) const {
  for (const Wired& wired : devices_) {
    if (wired.entry.name == name) return wired.device.get();
  }
  return nullptr;
}

void McuBoard::radio_receive(std::span<const std::uint8_t> frame) {
  if (radio_ != nullptr) radio_->air(frame);
  if (serial_ != nullptr) serial_->feed(frame, now_ns());
}

bool McuBoard::radio_transmit(std::vector<std::uint8_t>& frame) {
  if (radio_ != nullptr) return radio_->take_sent(frame);
  if (serial_ == nullptr || sent_.empty()) return false;
  // A gap of two frame times ends a packet (20 bit times).
  const auto gap_ns = static_cast<std::int64_t>(20.0 * 1e9 / serial_->baud());
  if (now_ns() - sent_last_ns_ < gap_ns) return false;
  frame = std::move(sent_);
  sent_.clear();
  return true;
}

}  // namespace omnihil::mcu
