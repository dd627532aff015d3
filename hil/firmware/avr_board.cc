#include "hil/firmware/avr_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "hil/text/recording_text.h"

namespace omnihil {
namespace {

std::string pin_text(const mcu::PinName& pin) { return fmt::format("P{}{}", pin.port, pin.pin); }

}  // namespace

AvrBoard::AvrBoard(const mcu::AvrBoardSpec& spec, const mcu::AvrMotor& motor, const mcu::AvrImage& image,
                   const RobotConfig& config, double deadline_s)
    : motor_(motor), analog_(spec.analog), process_(deadline_s), shown_mV_(spec.analog.size(), -1) {
  process_.send(fmt::format("chip {} {}", spec.chip->name, std::llround(spec.crystal_Hz)));
  program(image, spec);
  wire(spec, config);
  process_.send("start");
  std::string line;
  const bool answered = process_.receive(line);
  if (answered && line == "ready") return;
  throw std::invalid_argument(
      fmt::format("board of wheel {}: {}", wheel(), answered ? line : "omnihil-avr " + process_.end()));
}

void AvrBoard::program(const mcu::AvrImage& image, const mcu::AvrBoardSpec& spec) {
  for (const mcu::ElfSegment& part : image.flash) {
    process_.send(fmt::format("flash {} {}", part.address, to_hex(part.bytes)));
  }
  for (const mcu::ElfSegment& part : image.eeprom) {
    process_.send(fmt::format("eeprom {} {}", part.address, to_hex(part.bytes)));
  }
  for (const mcu::FlashEntry& entry : spec.eeprom) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint32_t word : entry.words) {
      for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
    }
    process_.send(fmt::format("eeprom {} {}", entry.address, to_hex(bytes)));
  }
}

void AvrBoard::wire(const mcu::AvrBoardSpec& spec, const RobotConfig& config) {
  for (const mcu::AvrPin& pin : spec.pins) {
    bool level = pin.level;
    if (pin.robot_id_bit >= 0) level = (config.robot_id >> pin.robot_id_bit & 1u) != 0;
    if (pin.wheel_bit >= 0) level = (motor_.wheel >> pin.wheel_bit & 1) != 0;
    process_.send(fmt::format("pin {} {}", pin_text(pin.pin), level ? 1 : 0));
  }
  if (const mcu::AvrChannel* c = motor_.pwm; c != nullptr) {
    process_.send(fmt::format("pwm {} {} {} {} {} {} {} {} {}", pin_text(c->pin), c->bits, c->tccra, c->tccrb,
                              c->ocr, c->ocra, c->icr, c->com_shift, motor_.inverted ? 1 : 0));
  }
  if (motor_.direction) {
    process_.send(fmt::format("direction {} {}", pin_text(*motor_.direction),
                              motor_.direction_high_is_forward ? 1 : 0));
  }
  if (motor_.enable) process_.send(fmt::format("enable {}", pin_text(*motor_.enable)));
  process_.send("bridge");
  if (motor_.encoder.size() == 2) {
    process_.send(fmt::format("encoder {} {} {:a}", pin_text(motor_.encoder[0]), pin_text(motor_.encoder[1]),
                              motor_.encoder_sign * config.encoder_counts_per_rotor_turn));
  }
  if (spec.serial != 0) process_.send(fmt::format("serial {}", spec.serial));
  if (spec.control != nullptr) {
    process_.send(fmt::format("control {} {}", spec.control->vector, spec.control_period_ns));
  }
}

void AvrBoard::receive(std::span<const std::uint8_t> frame) {
  if (!frame.empty()) process_.send("receive " + to_hex(frame));
}

void AvrBoard::begin(const mcu::WorldState& world, std::int64_t end_ns) {
  drive_ = {};
  running_ = failure_.empty();
  if (!running_) return;
  const auto w = static_cast<std::size_t>(motor_.wheel);
  for (std::size_t i = 0; i < analog_.size(); ++i) {
    double value = 0.0;
    if (analog_[i].signal == mcu::AnalogSignal::kBusVoltage) value = world.bus_voltage_V;
    if (analog_[i].signal == mcu::AnalogSignal::kMotorCurrent) value = world.motor_current_A[w];
    const double voltage_V = analog_[i].offset_V + analog_[i].volts_per_unit * value;
    const int mV = static_cast<int>(std::lround(std::clamp(voltage_V, 0.0, 5.0) * 1e3));
    if (mV == shown_mV_[i]) continue;
    shown_mV_[i] = mV;
    process_.send(fmt::format("adc {} {}", analog_[i].channel, mV));
  }
  process_.send(fmt::format("run {} {} {:a} {:a}", end_ns, world.at_ns, world.theta_rotor_rad[w],
                            world.omega_rotor_rad_s[w]));
}

void AvrBoard::fail(const std::string& why) {
  failure_ = fmt::format("board of wheel {}: {}", wheel(), why);
  drive_ = {};
}

void AvrBoard::take(const std::string& line, bool& done) {
  const std::size_t space = line.find(' ');
  const std::string verb = line.substr(0, space);
  const std::string rest = space == std::string::npos ? "" : line.substr(space + 1);
  if (verb == "sent") {
    parse_hex(rest, sent_.emplace_back());
  } else if (verb == "note") {
    notes_.push_back(rest);
  } else if (verb == "stopped" || verb == "error") {
    fail(rest);
    done = verb == "error";
  } else if (verb == "done") {
    done = true;
    char* end = nullptr;
    drive_.driven = rest.starts_with('1') && failure_.empty();
    drive_.duty_ratio = motor_.sign * std::strtod(rest.c_str() + std::min<std::size_t>(2, rest.size()), &end);
    missed_ = std::strtoull(end, nullptr, 10);
  }
}

bool AvrBoard::finish() {
  std::string line;
  for (bool done = !running_; !done;) {
    if (!process_.receive(line)) {
      fail("omnihil-avr " + process_.end());
      break;
    }
    if (line == "paused") return false;
    take(line, done);
  }
  running_ = false;
  return true;
}

void AvrBoard::pause_at(std::uint32_t address) { process_.send(fmt::format("pause {}", address)); }
void AvrBoard::go_on() { process_.send("go_on"); }

// One answer to one question; false: it is another one ("refused …"), or the process is no more.
bool AvrBoard::answer(std::string_view verb, std::string& rest) {
  std::string line;
  if (!process_.receive(line)) {
    if (failure_.empty()) fail("omnihil-avr " + process_.end());
    return false;
  }
  if (!line.starts_with(verb)) return false;
  rest = line.substr(std::min(line.size(), verb.size() + 1));
  return true;
}

void AvrBoard::ask(std::span<const AvrBytes> places) {
  std::string line = "read";
  for (const AvrBytes& place : places) line += fmt::format(" {} {}", place.address, place.count);
  process_.send(line);
}

bool AvrBoard::read(std::vector<std::uint8_t>& bytes) {
  std::string text;
  return answer("memory", text) && parse_hex(text, bytes);
}

bool AvrBoard::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return true;
  process_.send(fmt::format("write {} {}", address, to_hex(bytes)));
  std::string rest;
  return answer("written", rest);
}

}  // namespace omnihil
