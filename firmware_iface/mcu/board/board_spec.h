// What a board file says: the chip, and what hangs on its timers, pins and buses. For people:
// docs/mcu-boards.md.
//
//   std::vector<BoardProblem> problems;
//   std::optional<BoardSpec> spec = read_board(text, "boards/mine.toml", problems);
//
// The reader knows the chip: a timer, channel, pin or bus that the chip lacks is a problem, and so is
// everything that two entries claim. All problems come at once.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board_context.h"
#include "firmware_iface/mcu/board/board_problem.h"
#include "firmware_iface/mcu/stm32/sd_bus.h"
#include "firmware_iface/motor_bus/wheel_words.h"

namespace omnihil::mcu {

struct ChipSpec;
struct DeviceKind;

struct PinName {  // "PA3"
  char port = 'A';
  unsigned pin = 0;
};

struct ChannelName {  // "TIM1.3", its complementary output "TIM1.3N"
  std::string timer;
  unsigned channel = 0;  // from 0
  bool complement = false;
  bool by_letter = false;  // "PWM3.A"
};

// One motor: one channel with or without a direction pin, two channels (a bridge's halves), or three
// (phases).
struct MotorEntry {
  int wheel = 0;
  std::vector<ChannelName> pwm;
  std::vector<ChannelName> pwm_low = {};  // of three phases: the lower switches' own gates, as wired
  bool inverted = false;                  // the driver's input is active low
  std::optional<PinName> direction;
  bool direction_high_is_forward = true;
  double sign = 1.0;                       // -1: the motor's leads are swapped
  std::optional<PinName> enable;           // low: the bridge is off
  std::optional<PinName> brake = {};       // low: all lower switches are closed
  std::string encoder_timer;               // empty: none
  std::vector<PinName> encoder_pins = {};  // instead: its lines A and B on pins
  double encoder_sign = 1.0;
  std::string hall_timer;          // empty: none; its channels 1 to 3
  std::vector<PinName> hall_pins;  // the same lines as pins
  unsigned hall_pole_pairs = 0;
  bool hall_inverted = false;  // the sensors pull their lines low where the plant's are high
};

struct DeviceEntry {
  const DeviceKind* kind = nullptr;
  std::string name;  // as the radio names it
  std::string bus;   // "SPI1", "I2C2"
  std::optional<PinName> select;
  std::map<std::string, PinName, std::less<>> pins;
  std::string breaks = {};  // a timer whose break input its fault pin is at; empty: none
  std::map<std::string, double, std::less<>> settings;
  int wheel = 0;  // of an angle sensor
  bool on_wheel_shaft = false;
  std::string image = {};  // of a memory card: its file, as the board file says it; {id}, {board}: numbers
  bool writable = false;   // what is written on the card goes to the file at the end
  CardImage card = {};     // the file's contents, by whoever opens it
};

enum class AnalogSignal : std::uint8_t {
  kConstant,
  kBusVoltage,
  kMotorCurrent,
  kPhaseCurrent,
  kPhaseVoltage,
  kShuntCurrent
};

struct AnalogEntry {
  std::string adc;
  unsigned channel = 0;
  AnalogSignal signal = AnalogSignal::kConstant;
  int wheel = 0;
  int phase = 0;
  double volts_per_unit = 0.0, offset_V = 0.0;
};

struct PinEntry {
  PinName pin;
  bool level = false;
  int robot_id_bit = -1;    // not negative: this bit of the robot's number instead
  bool break_beam = false;  // the break beam's receiver instead: at `level` while the ball is in the beam
  bool inverted = false;    // of robot_id_bit: a one is low
};

struct FlashEntry {
  std::uint32_t address = 0;
  std::vector<std::uint32_t> words;
  int board_number_at = -1;  // not negative: this word is the board's number instead
};

// A serial port or a CAN that leads out of the bench, or a console whose text is kept.
enum class PortSource : std::uint8_t { kSerial, kCan, kSemihosting, kItm, kRtt };
struct PortEntry {
  PortSource source = PortSource::kSerial;
  std::string of;        // "USART2", "CAN1", "semihosting", "ITM", "RTT"
  std::string as;        // a wire's URL; empty: none
  std::string bus;       // instead: of "bus:NAME" the name; of a CAN that the robot's boards share
  bool console = false;  // what it says is text, kept line by line
  std::string key;       // "port[0]", in messages
  unsigned line = 0;

  bool reads() const {
    return source == PortSource::kSerial || source == PortSource::kRtt;
  }  // bytes, not frames
};

// A board that drives wheels as the robot's main board tells it, which the bench stands in for.
struct WheelCommands {
  WheelWords words;     // of a dialect or of the board file itself; no period: there are none
  bool serial = false;  // `via` is a serial port, else a CAN
  std::string via;
  double sign = 1.0;  // -1: its forward is the plant's backward
};

struct BoardSpec {
  std::string name;
  const ChipSpec* chip = nullptr;
  std::string chip_name;  // as the file has it: the chip's or that of one that is the same here
  double crystal_Hz = 8e6;
  double cpi_scale = 1.0;
  std::optional<std::uint32_t> boot_address = {};  // BOOT_ADD0 of chips that have it; else as delivered
  std::int64_t coupling_ns = 500'000;              // the plant and the board meet this often
  double adc_reference_V = 3.3;
  std::string control_timer;  // whose update starts a control period; empty: not said
  std::string radio_format;   // empty: none
  std::string radio_via;      // a device's name, or a serial port
  int boards_per_robot = 1;   // of several, each drives the next wheels
  WheelCommands wheel_commands;
  std::vector<MotorEntry> motors;
  std::vector<DeviceEntry> devices;
  std::vector<AnalogEntry> analog;
  std::vector<PinEntry> pins;
  std::vector<FlashEntry> flash;
  std::vector<PortEntry> ports;
};

std::optional<BoardSpec> read_board(std::string_view text, const std::string& file,
                                    std::vector<BoardProblem>& problems, const BoardContext& context = {});

}  // namespace omnihil::mcu
