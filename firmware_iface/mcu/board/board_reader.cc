#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>

#include "firmware_iface/mcu/board/board_keys.h"
#include "firmware_iface/mcu/board/board_names.h"
#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/wheel_commands_reader.h"
#include "firmware_iface/mcu/stm32/device.h"
#include "firmware_iface/robot_io.h"

namespace omnihil::mcu {
namespace {
constexpr const char* kFormat = "omnihil-board/1";

class Reader {
 public:
  Reader(const toml::table& top, const std::string& file, std::vector<BoardProblem>& problems,
         const BoardContext& context)
      : top_(top), keys_(file, problems), context_(context) {}
  BoardSpec read();

 private:
  void read_top();
  void read_boot_address();
  void read_motor(const toml::table& t, const std::string& path);
  std::vector<ChannelName> channels(const toml::table& t, const std::string& path, std::string_view key);
  void read_pin(const toml::table& t, const std::string& path);
  void read_sensors(const toml::table& t, const std::string& path, MotorEntry& motor);
  void read_device(const toml::table& t, const std::string& path);
  void read_device_wires(const toml::table& t, const std::string& path, DeviceEntry& device);
  void read_analog(const toml::table& t, const std::string& path);
  void read_flash(const toml::table& t, const std::string& path);
  void read_port(const toml::table& t, const std::string& path);
  void read_radio();
  void read_wheel_commands();
  std::optional<PinName> pin(const toml::table& t, const std::string& path, std::string_view key);
  std::optional<PinName> pin_word(const toml::table& t, const std::string& path, std::string_view key,
                                  const std::string& word);
  void claim(const toml::table& t, const std::string& path, std::string_view key, const std::string& what);

  const toml::table& top_;
  BoardKeys keys_;
  const BoardContext& context_;
  BoardSpec spec_;
  std::unique_ptr<BoardNames> names_;
  std::set<std::string> claimed_;
};

// Each thing of the board serves one purpose.
void Reader::claim(const toml::table& t, const std::string& path, std::string_view key,
                   const std::string& what) {
  if (!claimed_.insert(what).second) keys_.wrong(t, path, key, fmt::format("{} is used twice", what), "");
}

std::optional<PinName> Reader::pin_word(const toml::table& t, const std::string& path, std::string_view key,
                                        const std::string& word) {
  const auto parsed = parse_pin(word);
  if (parsed && (!names_ || names_->has_pin(*parsed))) return parsed;
  keys_.wrong(t, path, key, fmt::format("no pin \"{}\"", word),
              fmt::format("pins of the chip, such as {}",
                          names_ && names_->has_pin({PinBank::kGp, 3}) ? "GP3" : "PA3"));
  return std::nullopt;
}

std::optional<PinName> Reader::pin(const toml::table& t, const std::string& path, std::string_view key) {
  const auto word = keys_.text(t, path, key);
  return word ? pin_word(t, path, key, *word) : std::nullopt;
}

void Reader::read_top() {
  keys_.only(top_, "",
             {"format", "name", "source", "chip", "boot_address", "crystal_Hz", "cpi_scale", "coupling_us",
              "adc_reference_V", "control_timer", "boards_per_robot", "wheel_commands", "radio", "motor",
              "device", "analog", "pin", "flash", "port"});
  keys_.format(top_, kFormat);
  spec_.name = keys_.text(top_, "", "name").value_or("");
  if (spec_.name.empty()) keys_.missing(top_, "", "name", "a text");
  std::string chips;
  for (const ChipSpec* chip : all_chips()) {
    chips += (chips.empty() ? "" : ", ") + std::string(chip->name);
    for (const std::string_view variant : chip->variants) chips += ", " + std::string(variant);
  }
  if (const auto chip = keys_.text(top_, "", "chip")) {
    spec_.chip = find_chip(*chip);
    spec_.chip_name = chip_name(*chip);
    if (spec_.chip == nullptr) keys_.wrong(top_, "", "chip", "unknown", chips);
  } else if (!top_.contains("chip")) {
    keys_.missing(top_, "", "chip", chips);
  }
  if (spec_.chip != nullptr) names_ = std::make_unique<BoardNames>(*spec_.chip);
  read_boot_address();
  spec_.crystal_Hz = keys_.number(top_, "", "crystal_Hz", 1e6, 50e6)
                         .value_or(spec_.chip != nullptr ? spec_.chip->crystal_hz : spec_.crystal_Hz);
  spec_.cpi_scale = keys_.number(top_, "", "cpi_scale", 0.25, 10.0).value_or(spec_.cpi_scale);
  spec_.coupling_ns =
      1000 * keys_.whole(top_, "", "coupling_us", 10, 10'000).value_or(spec_.coupling_ns / 1000);
  spec_.adc_reference_V = keys_.number(top_, "", "adc_reference_V", 0.5, 6.0).value_or(spec_.adc_reference_V);
  spec_.control_timer = keys_.text(top_, "", "control_timer").value_or("");
  if (!spec_.control_timer.empty() && names_ && !names_->has_timer(spec_.control_timer)) {
    keys_.wrong(top_, "", "control_timer", "no such timer", names_->timers());
  }
}

// BOOT_ADD0 of F7: 16 bits, in units of 16 KiB.
void Reader::read_boot_address() {
  const auto address = keys_.whole(top_, "", "boot_address", 0, 0x3FFFC000);
  if (!address || spec_.chip == nullptr) return;
  const auto at = static_cast<std::uint32_t>(*address);
  if (spec_.chip->boot_address == 0) {
    return keys_.wrong(top_, "", "boot_address", fmt::format("{} has no boot address", spec_.chip_name),
                       "no such key");
  }
  bool in_flash = false;
  for (const MemorySpec& memory : spec_.chip->memories) {
    if (!memory.flash) continue;
    in_flash = at - memory.base < memory.bytes || at - spec_.chip->boot_address < memory.bytes;
  }
  if (at % 16384 != 0) {
    keys_.wrong(top_, "", "boot_address", fmt::format("0x{:08x} is no multiple of 16 KiB", at),
                "as BOOT_ADD0 has it: 16384 times a number");
  } else if (!in_flash) {
    keys_.wrong(top_, "", "boot_address", fmt::format("0x{:08x} is not in flash", at),
                fmt::format("flash, at 0x08000000 or at 0x{:08x}", spec_.chip->boot_address));
  }
  spec_.boot_address = at;
}

std::vector<ChannelName> Reader::channels(const toml::table& t, const std::string& path,
                                          std::string_view key) {
  std::vector<ChannelName> found;
  for (const std::string& word : keys_.texts(t, path, key)) {
    const auto channel = parse_channel(word);
    if (!channel || (names_ && !names_->has_channel(*channel))) {
      keys_.wrong(t, path, key, fmt::format("no channel \"{}\"", word),
                  !names_ ? "channels of the chip, such as TIM1.2, TIM1.2N, PWM3.A"
                  : word.ends_with('N')
                      ? "complementary outputs such as TIM1.2N of " + names_->timers_with_complements()
                      : names_->example_channels());
      continue;
    }
    claim(t, path, key, word);
    found.push_back(*channel);
  }
  return found;
}

void Reader::read_motor(const toml::table& t, const std::string& path) {
  keys_.only(
      t, path,
      {"wheel", "pwm", "pwm_low", "inverted", "direction", "forward", "reversed", "enable", "brake",
       "encoder", "encoder_pins", "encoder_reversed", "hall", "hall_pins", "hall_inverted", "pole_pairs"});
  MotorEntry motor;
  if (const auto wheel = keys_.whole(t, path, "wheel", 0, kWheels - 1)) {
    motor.wheel = static_cast<int>(*wheel);
    claim(t, path, "wheel", fmt::format("wheel {}", *wheel));
  } else if (!t.contains("wheel")) {
    keys_.missing(t, path, "wheel", "0 to 3");
  }
  motor.pwm = channels(t, path, "pwm");
  motor.pwm_low = channels(t, path, "pwm_low");
  if (t.contains("pwm_low") && (motor.pwm_low.size() != 3 || motor.pwm.size() != 3)) {
    keys_.wrong(t, path, "pwm_low", "not the lower gates of three phases",
                "three channels beside three of pwm");
  }
  if (!t.contains("pwm")) keys_.missing(t, path, "pwm", "one channel, two of a bridge, or three phases");
  if (motor.pwm.size() > 3) keys_.wrong(t, path, "pwm", "too many channels", "one, two or three");
  motor.inverted = keys_.flag(t, path, "inverted").value_or(false);
  motor.direction = pin(t, path, "direction");
  if (motor.direction && motor.pwm.size() > 1) keys_.wrong(t, path, "direction", "goes with one channel", "");
  if (const auto level = keys_.word(t, path, "forward", {"high", "low"}))
    motor.direction_high_is_forward = *level == 0;
  motor.sign = keys_.flag(t, path, "reversed").value_or(false) ? -1.0 : 1.0;
  motor.enable = pin(t, path, "enable");
  motor.brake = pin(t, path, "brake");
  read_sensors(t, path, motor);
  spec_.motors.push_back(std::move(motor));
}

void Reader::read_sensors(const toml::table& t, const std::string& path, MotorEntry& motor) {
  motor.encoder_timer = keys_.text(t, path, "encoder").value_or("");
  if (!motor.encoder_timer.empty()) {
    if (names_ && !names_->has_inputs(motor.encoder_timer, 2)) {
      keys_.wrong(t, path, "encoder", "no timer with two inputs", names_->timers_with_inputs(2));
    } else {
      claim(t, path, "encoder", motor.encoder_timer + " inputs");
    }
  }
  for (const std::string& word : keys_.texts(t, path, "encoder_pins")) {
    if (const auto p = pin_word(t, path, "encoder_pins", word)) motor.encoder_pins.push_back(*p);
  }
  if (t.contains("encoder_pins") && motor.encoder_pins.size() != 2)
    keys_.wrong(t, path, "encoder_pins", "not two pins", "two pins: A, B"), motor.encoder_pins.clear();
  motor.encoder_sign = keys_.flag(t, path, "encoder_reversed").value_or(false) ? -1.0 : 1.0;
  motor.hall_timer = keys_.text(t, path, "hall").value_or("");
  if (!motor.hall_timer.empty()) {
    if (names_ && !names_->has_inputs(motor.hall_timer, 3)) {
      keys_.wrong(t, path, "hall", "no timer with three inputs", names_->timers_with_inputs(3));
    } else {
      claim(t, path, "hall", motor.hall_timer + " inputs");
    }
  }
  for (const std::string& word : keys_.texts(t, path, "hall_pins")) {
    if (const auto p = pin_word(t, path, "hall_pins", word)) motor.hall_pins.push_back(*p);
  }
  if (t.contains("hall_pins") && motor.hall_pins.size() != 3) {
    keys_.wrong(t, path, "hall_pins", "not three pins", "three pins: H1, H2, H3");
  }
  motor.hall_inverted = keys_.flag(t, path, "hall_inverted").value_or(false);
  const bool hall = !motor.hall_timer.empty() || !motor.hall_pins.empty();
  motor.hall_pole_pairs = static_cast<unsigned>(keys_.whole(t, path, "pole_pairs", 1, 60).value_or(0));
  if (hall && !t.contains("pole_pairs")) keys_.missing(t, path, "pole_pairs", "1 to 60");
}

void Reader::read_device(const toml::table& t, const std::string& path) {
  keys_.only(
      t, path,
      {"kind", "name", "bus", "select", "pins", "settings", "breaks", "wheel", "shaft", "image", "writable"});
  DeviceEntry device;
  std::string kinds;
  for (const DeviceKind* kind : all_devices()) kinds += (kinds.empty() ? "" : ", ") + std::string(kind->name);
  if (const auto kind = keys_.text(t, path, "kind")) {
    device.kind = find_device(*kind);
    if (device.kind == nullptr) keys_.wrong(t, path, "kind", "unknown", kinds);
    device.name = *kind;
  } else if (!t.contains("kind")) {
    keys_.missing(t, path, "kind", kinds);
  }
  device.name = keys_.text(t, path, "name").value_or(device.name);
  device.wheel = static_cast<int>(keys_.whole(t, path, "wheel", 0, kWheels - 1).value_or(0));
  if (const auto shaft = keys_.word(t, path, "shaft", {"rotor", "wheel"}))
    device.on_wheel_shaft = *shaft == 1;
  if (device.kind != nullptr) read_device_wires(t, path, device);
  claim(t, path, "name", "device " + device.name);
  spec_.devices.push_back(std::move(device));
}

void Reader::read_device_wires(const toml::table& t, const std::string& path, DeviceEntry& device) {
  const std::unique_ptr<Device> sample = device.kind->make(DeviceWorld{});
  const bool spi = sample->spi() != nullptr, card = sample->sd() != nullptr;
  device.bus = keys_.text(t, path, "bus").value_or("");
  const bool known = names_ && (card  ? names_->has_sdmmc(device.bus)
                                : spi ? names_->has_spi(device.bus)
                                      : names_->has_i2c(device.bus));
  if (names_ && !known) {
    keys_.wrong(t, path, "bus",
                card  ? "not an SDMMC of the chip"
                : spi ? "not an SPI of the chip"
                      : "not an I2C of the chip",
                card  ? names_->sdmmcs()
                : spi ? names_->spis()
                      : names_->i2cs());
  }
  device.image = keys_.text(t, path, "image").value_or("");
  device.writable = keys_.flag(t, path, "writable").value_or(false);
  if (card && device.image.empty()) keys_.missing(t, path, "image", "the file with what the card holds");
  if (card) claim(t, path, "bus", "the card of " + device.bus);
  for (const char* key : {"image", "writable"}) {
    if (!card && t.contains(key)) keys_.wrong(t, path, key, "the device holds no file", "of an sd_card");
  }
  device.select = pin(t, path, "select");
  if (spi && !t.contains("select")) keys_.missing(t, path, "select", "the pin that selects the chip");
  if (const toml::node* node = t.get("pins")) {
    const toml::table* pins = node->as_table();
    if (pins == nullptr) keys_.wrong(t, path, "pins", "not a table", "{ irq = \"PB1\" }");
    std::vector<std::string_view> allowed(sample->inputs().begin(), sample->inputs().end());
    allowed.insert(allowed.end(), sample->outputs().begin(), sample->outputs().end());
    for (const auto& [key, value] : pins != nullptr ? *pins : toml::table{}) {
      const std::string name(key.str());
      if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
        keys_.wrong(*pins, path + ".pins", name, "the device has no such pin",
                    fmt::format("{}", fmt::join(allowed, ", ")));
      } else if (const auto p = pin(*pins, path + ".pins", name)) {
        device.pins[name] = *p;
      }
    }
  }
  device.breaks = keys_.text(t, path, "breaks").value_or("");
  const auto outs = sample->outputs();
  if (!device.breaks.empty() && std::find(outs.begin(), outs.end(), "fault") == outs.end())
    keys_.wrong(t, path, "breaks", "the device has no fault pin", "");
  if (!device.breaks.empty() && names_ && !names_->has_channel({device.breaks, 0, true}))
    keys_.wrong(t, path, "breaks", "no timer with a break input", names_->timers_with_complements());
  if (const toml::node* node = t.get("settings")) {
    const toml::table* settings = node->as_table();
    if (settings == nullptr) keys_.wrong(t, path, "settings", "not a table", "{ shunt_ohm = 0.01 }");
    for (const auto& [key, value] : settings != nullptr ? *settings : toml::table{}) {
      const std::string name(key.str());
      const auto& known_settings = device.kind->settings;
      if (std::find(known_settings.begin(), known_settings.end(), name) == known_settings.end()) {
        keys_.wrong(*settings, path + ".settings", name, "the device has no such setting",
                    fmt::format("{}", fmt::join(known_settings, ", ")));
      } else if (const auto number = keys_.number(*settings, path + ".settings", name, -1e6, 1e6)) {
        device.settings[name] = *number;
      }
    }
  }
}

void Reader::read_analog(const toml::table& t, const std::string& path) {
  keys_.only(t, path, {"adc", "channel", "signal", "wheel", "phase", "volts_per_unit", "offset_V"});
  AnalogEntry analog;
  analog.adc = keys_.text(t, path, "adc").value_or("");
  if (names_ && !names_->has_adc(analog.adc)) {
    keys_.wrong(t, path, "adc", t.contains("adc") ? "unknown" : "missing", names_->adcs());
  }
  analog.channel = static_cast<unsigned>(keys_.whole(t, path, "channel", 0, 31).value_or(0));
  if (!t.contains("channel")) keys_.missing(t, path, "channel", "0 to 31");
  const auto signal =  // in the order of AnalogSignal
      keys_.word(
          t, path, "signal",
          {"constant", "bus_voltage", "motor_current", "phase_current", "phase_voltage", "shunt_current"});
  analog.signal = static_cast<AnalogSignal>(signal.value_or(0));
  analog.phase = static_cast<int>(keys_.whole(t, path, "phase", 0, kLegs - 1).value_or(0));
  analog.wheel = static_cast<int>(keys_.whole(t, path, "wheel", 0, kWheels - 1).value_or(0));
  analog.volts_per_unit = keys_.number(t, path, "volts_per_unit", -1e3, 1e3).value_or(0.0);
  analog.offset_V = keys_.number(t, path, "offset_V", -100.0, 100.0).value_or(0.0);
  claim(t, path, "channel", fmt::format("{} channel {}", analog.adc, analog.channel));
  spec_.analog.push_back(analog);
}

void Reader::read_flash(const toml::table& t, const std::string& path) {
  keys_.only(t, path, {"address", "words", "board_number_at"});
  FlashEntry flash;
  std::uint32_t base = 0, bytes = 0xFFFFFFFF;
  for (const MemorySpec& memory : spec_.chip != nullptr ? spec_.chip->memories : std::vector<MemorySpec>{}) {
    if (memory.flash) base = memory.base, bytes = memory.bytes;
  }
  const std::int64_t end = std::int64_t{base} + bytes;
  if (const auto address = keys_.whole(t, path, "address", base, end - 4)) {
    flash.address = static_cast<std::uint32_t>(*address);
    if (flash.address % 4 != 0) keys_.wrong(t, path, "address", "not a multiple of 4", "");
  } else if (!t.contains("address")) {
    keys_.missing(t, path, "address", "an address in flash");
  }
  const toml::array* words = t.get_as<toml::array>("words");
  if (words == nullptr || words->empty()) {
    keys_.wrong(t, path, "words", "not a list of words", "[0x3F800000, 12]");
  } else {
    for (const toml::node& node : *words) {
      const auto word = node.value_exact<std::int64_t>();
      if (!word || *word < 0 || *word > 0xFFFFFFFFLL) {
        keys_.wrong(t, path, "words", "not all are words", "0 to 0xFFFFFFFF");
        break;
      }
      flash.words.push_back(static_cast<std::uint32_t>(*word));
    }
    if (std::int64_t{flash.address} + 4 * static_cast<std::int64_t>(flash.words.size()) > end) {
      keys_.wrong(t, path, "words", "reach beyond the end of flash", fmt::format("up to 0x{:08x}", end));
    }
  }
  const auto last_word = static_cast<std::int64_t>(flash.words.size()) - 1;
  if (last_word >= 0) {
    flash.board_number_at =
        static_cast<int>(keys_.whole(t, path, "board_number_at", 0, last_word).value_or(-1));
  }
  spec_.flash.push_back(std::move(flash));
}

void Reader::read_radio() {
  const toml::node* node = top_.get("radio");
  if (node == nullptr) return;
  const toml::table* t = node->as_table();
  if (t == nullptr) return keys_.wrong(top_, "", "radio", "not a table", "[radio]");
  keys_.only(*t, "radio", {"format", "via"});
  spec_.radio_format = keys_.radio_format(*t, context_.radio);
  spec_.radio_via = keys_.text(*t, "radio", "via").value_or("");
  bool found = names_ && names_->has_serial(spec_.radio_via);
  for (const DeviceEntry& device : spec_.devices) {
    if (device.name != spec_.radio_via || device.kind == nullptr) continue;
    found = device.kind->make(DeviceWorld{})->is_radio();
  }
  if (!found) {
    keys_.wrong(
        *t, "radio", "via", t->contains("via") ? "no radio and no serial port of that name" : "missing",
        "a [[device]] that is a radio, or " + (names_ ? names_->serials() : std::string("a serial port")));
  }
}

// Wheels 0 to n - 1 on the first board, n to 2 n - 1 on the second, and so on.
void Reader::read_wheel_commands() {
  const auto motors = static_cast<int>(spec_.motors.size());
  const auto boards = keys_.whole(top_, "", "boards_per_robot", 1, kWheels);
  spec_.boards_per_robot = static_cast<int>(boards.value_or(1));
  if (spec_.boards_per_robot > 1 && spec_.boards_per_robot * motors > kWheels) {
    keys_.wrong(top_, "", "boards_per_robot", "more wheels than a robot has",
                fmt::format("{} wheels", kWheels));
  }
  for (const MotorEntry& motor : spec_.motors) {
    if (spec_.boards_per_robot == 1 || motor.wheel < motors) continue;
    keys_.wrong(top_, "", "boards_per_robot",
                fmt::format("the board's motors are not wheels 0 to {}", motors - 1),
                "wheels counted from 0 on each board");
  }
  spec_.wheel_commands =
      mcu::read_wheel_commands(top_, keys_, names_.get(), {motors, spec_.coupling_ns}, context_.find_dialect);
}

// An input that never changes: a level, or a bit of the robot's number.
void Reader::read_pin(const toml::table& t, const std::string& path) {
  keys_.only(t, path, {"pin", "level", "robot_id_bit", "break_beam", "inverted"});
  const auto p = pin(t, path, "pin");
  if (!t.contains("pin")) keys_.missing(t, path, "pin", "a pin, such as PC13");
  const bool has_level = t.contains("level"), has_bit = t.contains("robot_id_bit"),
             has_beam = t.contains("break_beam");
  if (!has_level && !has_bit && !has_beam)
    keys_.missing(t, path, "level", "true, false, or instead a robot_id_bit or a break_beam");
  if (has_level && has_bit) keys_.wrong(t, path, "robot_id_bit", "beside a level", "one of the two");
  if (has_beam && (has_level || has_bit))
    keys_.wrong(t, path, "break_beam", "beside a level or robot_id_bit", "one of the three");
  const auto level = keys_.flag(t, path, "level");
  const auto id_bit = keys_.whole(t, path, "robot_id_bit", 0, 7);
  const auto beam = keys_.text(t, path, "break_beam");
  const bool inverted = keys_.flag(t, path, "inverted").value_or(false);
  if (inverted && !has_bit) keys_.wrong(t, path, "inverted", "without a robot_id_bit", "beside one");
  if (beam && *beam != "high" && *beam != "low")
    keys_.wrong(t, path, "break_beam", "is neither",
                "\"high\" or \"low\": the level while the ball is in the beam");
  if (p)
    spec_.pins.push_back({*p, beam ? *beam == "high" : level.value_or(false),
                          static_cast<int>(id_bit.value_or(-1)), beam.has_value(), inverted});
}

// What the radio or the main board hangs on leads nowhere else.
void Reader::read_port(const toml::table& t, const std::string& path) {
  keys_.only(t, path, {"of", "as", "console"});
  PortEntry port;
  port.key = path;
  port.of = keys_.text(t, path, "of").value_or("");
  port.as = keys_.text(t, path, "as").value_or("");
  const bool text_only = port.of == "semihosting" || port.of == "ITM" || port.of == "RTT";
  port.console = keys_.flag(t, path, "console").value_or(text_only);
  if (const toml::node* node = t.get("as")) port.line = node->source().begin.line;
  if (port.of == "semihosting") port.source = PortSource::kSemihosting;
  if (port.of == "ITM") port.source = PortSource::kItm;
  if (port.of == "RTT") port.source = PortSource::kRtt;
  if (names_ && names_->has_can(port.of)) port.source = PortSource::kCan;
  if (!names_ || text_only || names_->has_serial(port.of) || names_->has_can(port.of)) {
    claim(t, path, "of", port.of + " as a port");
  } else {
    keys_.wrong(t, path, "of", t.contains("of") ? "no such port" : "missing",
                names_->serials() + ", " + names_->cans() + ", semihosting, ITM, RTT");
  }
  if (!port.of.empty() && (port.of == spec_.radio_via || port.of == spec_.wheel_commands.via))
    keys_.wrong(t, path, "of", "the robot's commands come in by it", "another port");
  if ((port.source == PortSource::kSemihosting || port.source == PortSource::kItm) && !port.as.empty())
    keys_.wrong(t, path, "as", "its text leads out of the board only", "console = true");
  if (port.source == PortSource::kCan && port.console)
    keys_.wrong(t, path, "console", "a CAN has no text", "false");
  constexpr std::string_view kBus = "bus:";
  if (port.as.starts_with(kBus)) {
    port.bus = port.as.substr(kBus.size());
    port.as.clear();
    if (port.bus.empty()) keys_.wrong(t, path, "as", "a bus without a name", "bus:wheels");
    if (names_ && port.source != PortSource::kCan)
      keys_.wrong(t, path, "as", "a bus between boards is a CAN", names_->cans());
    if (spec_.boards_per_robot < 2)
      keys_.wrong(t, path, "as", "a bus between boards of a robot that has one",
                  "boards_per_robot = 2 or more");
  }
  if (port.as.empty() && port.bus.empty() && !port.console)
    keys_.missing(t, path, "as", "a wire such as pty:./console (omnihil wires), or console = true");
  spec_.ports.push_back(std::move(port));
}

BoardSpec Reader::read() {
  read_top();
  for (const auto& [t, path] : keys_.tables(top_, "", "motor")) read_motor(*t, path);
  if (spec_.motors.empty())
    keys_.missing(top_, "", "motor", "[[motor]], one per wheel that the board drives");
  for (const auto& [t, path] : keys_.tables(top_, "", "device")) read_device(*t, path);
  for (const auto& [t, path] : keys_.tables(top_, "", "analog")) read_analog(*t, path);
  for (const auto& [t, path] : keys_.tables(top_, "", "flash")) read_flash(*t, path);
  for (const auto& [t, path] : keys_.tables(top_, "", "pin")) {
    read_pin(*t, path);
  }
  read_radio();
  read_wheel_commands();
  for (const auto& [t, path] : keys_.tables(top_, "", "port")) read_port(*t, path);
  return std::move(spec_);
}
}  // namespace

std::optional<BoardSpec> read_board(std::string_view text, const std::string& file,
                                    std::vector<BoardProblem>& problems, const BoardContext& context) {
  return read_board_by<Reader>(text, file, problems, context);
}

}  // namespace omnihil::mcu
