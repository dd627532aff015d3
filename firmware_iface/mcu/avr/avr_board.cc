#include "firmware_iface/mcu/avr/avr_board.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>

#include "firmware_iface/mcu/board/board_keys.h"
#include "firmware_iface/mcu/board/board_names.h"
#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {
namespace {
constexpr const char* kFormat = "omnihil-board/1";

template <class Entries>
std::string names_of(const Entries& entries) {
  std::string all;
  for (const auto& entry : entries) all += (all.empty() ? "" : ", ") + std::string(entry.name);
  return all;
}

class Reader {
 public:
  Reader(const toml::table& top, const std::string& file, std::vector<BoardProblem>& problems,
         const BoardContext& context)
      : top_(top), keys_(file, problems), context_(context) {}
  AvrBoardSpec read();

 private:
  using Table = toml::table;
  void read_top();
  void read_control();
  void read_motor(const Table& t, const std::string& path);
  void read_encoder(const Table& t, const std::string& path, AvrMotor& motor);
  void read_pin(const Table& t, const std::string& path);
  void read_analog(const Table& t, const std::string& path);
  void read_eeprom(const Table& t, const std::string& path);
  void read_radio();
  std::optional<PinName> pin_word(const Table& t, const std::string& path, std::string_view key,
                                  const std::string& word);
  std::optional<PinName> pin(const Table& t, const std::string& path, std::string_view key);

  const Table& top_;
  BoardKeys keys_;
  const BoardContext& context_;
  AvrBoardSpec spec_;
  std::set<int> wheels_;
};

std::optional<PinName> Reader::pin_word(const Table& t, const std::string& path, std::string_view key,
                                        const std::string& word) {
  const auto parsed = parse_pin(word);
  const bool known =
      parsed && parsed->pin < 8 && spec_.chip->ports.find(parsed->port) != std::string_view::npos;
  if (known) return parsed;
  keys_.wrong(t, path, key, fmt::format("no pin \"{}\"", word), "pins of the chip, such as PB1");
  return std::nullopt;
}

std::optional<PinName> Reader::pin(const Table& t, const std::string& path, std::string_view key) {
  const auto word = keys_.text(t, path, key);
  return word ? pin_word(t, path, key, *word) : std::nullopt;
}

void Reader::read_top() {
  keys_.only(top_, "",
             {"format", "name", "source", "chip", "crystal_Hz", "coupling_us", "control_interrupt",
              "control_period_us", "radio", "motor", "analog", "pin", "eeprom"});
  keys_.format(top_, kFormat);
  spec_.name = keys_.text(top_, "", "name").value_or("");
  if (spec_.name.empty()) keys_.missing(top_, "", "name", "a text");
  const auto chip = keys_.text(top_, "", "chip");
  spec_.chip = find_avr_chip(chip.value_or(""));
  if (spec_.chip == nullptr)
    keys_.wrong(top_, "", "chip", chip ? "unknown" : "missing", names_of(all_avr_chips()));
  spec_.crystal_Hz = keys_.number(top_, "", "crystal_Hz", 1e6, 20e6).value_or(spec_.crystal_Hz);
  spec_.coupling_ns =
      1000 * keys_.whole(top_, "", "coupling_us", 100, 10'000).value_or(spec_.coupling_ns / 1000);
}

void Reader::read_control() {
  const auto name = keys_.text(top_, "", "control_interrupt");
  const auto period_us = keys_.whole(top_, "", "control_period_us", 50, 100'000);
  spec_.control_period_ns = 1000 * period_us.value_or(0);
  if (name && !top_.contains("control_period_us")) {
    keys_.missing(top_, "", "control_period_us", "50 to 100000, with control_interrupt");
  }
  if (!name) return;
  spec_.control = spec_.chip->interrupt(*name);
  if (spec_.control == nullptr) {
    keys_.wrong(top_, "", "control_interrupt", "no such interrupt", names_of(spec_.chip->interrupts));
  }
}

void Reader::read_motor(const Table& t, const std::string& path) {
  keys_.only(t, path,
             {"wheel", "pwm", "inverted", "direction", "forward", "reversed", "enable", "encoder",
              "encoder_reversed"});
  AvrMotor motor;
  motor.wheel = static_cast<int>(keys_.whole(t, path, "wheel", 0, kWheels - 1).value_or(0));
  if (!t.contains("wheel")) keys_.missing(t, path, "wheel", "0 to 3");
  if (!wheels_.insert(motor.wheel).second) {
    keys_.wrong(t, path, "wheel", fmt::format("wheel {} is used twice", motor.wheel), "");
  }
  const auto pwm = keys_.text(t, path, "pwm");
  if (!t.contains("pwm")) keys_.missing(t, path, "pwm", "a compare output, such as OC1A");
  if (pwm) {
    motor.pwm = spec_.chip->channel(*pwm);
    if (motor.pwm == nullptr) {
      keys_.wrong(t, path, "pwm", "no such compare output", names_of(spec_.chip->channels));
    }
  }
  motor.inverted = keys_.flag(t, path, "inverted").value_or(false);
  motor.direction = pin(t, path, "direction");
  if (const auto level = keys_.word(t, path, "forward", {"high", "low"}))
    motor.direction_high_is_forward = *level == 0;
  motor.sign = keys_.flag(t, path, "reversed").value_or(false) ? -1.0 : 1.0;
  motor.enable = pin(t, path, "enable");
  read_encoder(t, path, motor);
  spec_.motors.push_back(std::move(motor));
}

void Reader::read_encoder(const Table& t, const std::string& path, AvrMotor& motor) {
  for (const std::string& word : keys_.texts(t, path, "encoder")) {
    if (const auto p = pin_word(t, path, "encoder", word)) motor.encoder.push_back(*p);
  }
  if (t.contains("encoder") && motor.encoder.size() != 2) {
    keys_.wrong(t, path, "encoder", "not two pins", "two pins: lines A and B");
  }
  motor.encoder_sign = keys_.flag(t, path, "encoder_reversed").value_or(false) ? -1.0 : 1.0;
}

void Reader::read_pin(const Table& t, const std::string& path) {
  keys_.only(t, path, {"pin", "level", "robot_id_bit", "wheel_bit"});
  const auto p = pin(t, path, "pin");
  if (!t.contains("pin")) keys_.missing(t, path, "pin", "a pin, such as PC0");
  const int said = t.contains("level") + t.contains("robot_id_bit") + t.contains("wheel_bit");
  if (said != 1) {
    keys_.wrong(t, path, "pin", said == 0 ? "no level" : "more than one level",
                "one of level, robot_id_bit, wheel_bit");
  }
  const auto level = keys_.flag(t, path, "level");
  const auto id_bit = keys_.whole(t, path, "robot_id_bit", 0, 7);
  const auto wheel_bit = keys_.whole(t, path, "wheel_bit", 0, 1);
  if (p) {
    spec_.pins.push_back({*p, level.value_or(false), static_cast<int>(id_bit.value_or(-1)),
                          static_cast<int>(wheel_bit.value_or(-1))});
  }
}

void Reader::read_analog(const Table& t, const std::string& path) {
  keys_.only(t, path, {"channel", "signal", "volts_per_unit", "offset_V"});
  AnalogEntry analog;
  const unsigned channels = spec_.chip->adc_channels;
  analog.channel = static_cast<unsigned>(keys_.whole(t, path, "channel", 0, channels - 1).value_or(0));
  if (!t.contains("channel")) keys_.missing(t, path, "channel", fmt::format("0 to {}", channels - 1));
  const auto signal =  // in the order of AnalogSignal
      keys_.word(t, path, "signal", {"constant", "bus_voltage", "motor_current"});
  analog.signal = static_cast<AnalogSignal>(signal.value_or(0));
  analog.volts_per_unit = keys_.number(t, path, "volts_per_unit", -1e3, 1e3).value_or(0.0);
  analog.offset_V = keys_.number(t, path, "offset_V", -100.0, 100.0).value_or(0.0);
  spec_.analog.push_back(analog);
}

void Reader::read_eeprom(const Table& t, const std::string& path) {
  keys_.only(t, path, {"address", "words"});
  FlashEntry entry;
  const std::int64_t end = spec_.chip->eeprom_bytes;
  entry.address = static_cast<std::uint32_t>(keys_.whole(t, path, "address", 0, end - 4).value_or(0));
  if (!t.contains("address")) keys_.missing(t, path, "address", fmt::format("0 to {}", end - 4));
  const toml::array* words = t.get_as<toml::array>("words");
  if (words == nullptr || words->empty()) {
    keys_.wrong(t, path, "words", "not a list of words", "[0x3F800000, 12]");
    return;
  }
  for (const toml::node& node : *words) {
    const auto word = node.value_exact<std::int64_t>();
    if (!word || *word < 0 || *word > 0xFFFFFFFFLL) {
      keys_.wrong(t, path, "words", "not all are words", "0 to 0xFFFFFFFF");
      return;
    }
    entry.words.push_back(static_cast<std::uint32_t>(*word));
  }
  if (entry.address + 4 * static_cast<std::int64_t>(entry.words.size()) > end) {
    keys_.wrong(t, path, "words", "reach beyond the end of the EEPROM", fmt::format("up to {} bytes", end));
  }
  spec_.eeprom.push_back(std::move(entry));
}

void Reader::read_radio() {
  const toml::node* node = top_.get("radio");
  if (node == nullptr) return;
  const Table* t = node->as_table();
  if (t == nullptr) return keys_.wrong(top_, "", "radio", "not a table", "[radio]");
  keys_.only(*t, "radio", {"format", "via"});
  spec_.radio_format = keys_.radio_format(*t, context_.radio);
  const std::string via = keys_.text(*t, "radio", "via").value_or("");
  const std::string serials(spec_.chip->serials);
  if (via.size() == 6 && via.starts_with("USART") && serials.find(via[5]) != std::string::npos) {
    spec_.serial = via[5];
  } else {
    keys_.wrong(*t, "radio", "via", t->contains("via") ? "no such serial port" : "missing",
                fmt::format("USART{}", serials));
  }
}

AvrBoardSpec Reader::read() {
  read_top();
  if (spec_.chip == nullptr) return std::move(spec_);  // the rest is said of a chip
  read_control();
  for (const auto& [t, path] : keys_.tables(top_, "", "motor")) read_motor(*t, path);
  if (spec_.motors.empty()) keys_.missing(top_, "", "motor", "[[motor]], one per wheel");
  for (const auto& [t, path] : keys_.tables(top_, "", "pin")) read_pin(*t, path);
  for (const auto& [t, path] : keys_.tables(top_, "", "analog")) read_analog(*t, path);
  for (const auto& [t, path] : keys_.tables(top_, "", "eeprom")) read_eeprom(*t, path);
  read_radio();
  return std::move(spec_);
}

}  // namespace

std::optional<AvrBoardSpec> read_avr_board(std::string_view text, const std::string& file,
                                           std::vector<BoardProblem>& problems, const BoardContext& context) {
  return read_board_by<Reader>(text, file, problems, context);
}

}  // namespace omnihil::mcu
