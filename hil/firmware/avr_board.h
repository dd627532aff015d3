// One board of a robot of AVR boards: a chip in a process of its own with its wires, asked line by line.
//
//   AvrBoard board(spec, spec.motors[2], image, config, 10.0);   // throws std::invalid_argument
//   board.begin(world, end_ns);                                 // let it run
//   board.finish();                                             // wait for it; false: it pauses where it was told to
//   board.drive();                                              // what the bridge did on the mean
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/avr/avr_board.h"
#include "firmware_iface/mcu/avr/avr_image.h"
#include "firmware_iface/mcu/board/motor_wire.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "hil/firmware/avr_process.h"

namespace omnihil {

struct AvrBytes {  // of data memory
  std::uint32_t address = 0, count = 0;
};

class AvrBoard {
 public:
  AvrBoard(const mcu::AvrBoardSpec& spec, const mcu::AvrMotor& motor, const mcu::AvrImage& image,
           const RobotConfig& config, double deadline_s);

  int wheel() const { return motor_.wheel; }
  void receive(std::span<const std::uint8_t> frame);  // by the radio, before the next begin()
  void begin(const mcu::WorldState& world, std::int64_t end_ns);
  bool finish();
  // Once it comes to this byte of the flash finish() says false, and go_on() lets it run again.
  void pause_at(std::uint32_t address);
  void go_on();
  // Bytes of its data memory, before begin() or while it pauses. ask() may be said to all boards before read()
  // waits for one. False: it does not have them.
  void ask(std::span<const AvrBytes> places);
  bool read(std::vector<std::uint8_t>& bytes);
  bool write(std::uint32_t address, std::span<const std::uint8_t> bytes);
  mcu::BridgeDrive drive() const { return drive_; }
  std::uint64_t missed_control_periods() const { return missed_; }
  std::vector<std::vector<std::uint8_t>>& sent() { return sent_; }  // frames, to be taken
  const std::vector<std::string>& notes() const { return notes_; }
  const std::string& failure() const { return failure_; }

 private:
  void wire(const mcu::AvrBoardSpec& spec, const RobotConfig& config);
  void program(const mcu::AvrImage& image, const mcu::AvrBoardSpec& spec);
  void fail(const std::string& why);
  void take(const std::string& line, bool& done);
  bool answer(std::string_view verb, std::string& rest);

  mcu::AvrMotor motor_;
  std::vector<mcu::AnalogEntry> analog_;
  AvrProcess process_;
  bool running_ = false;
  mcu::BridgeDrive drive_;
  std::uint64_t missed_ = 0;
  std::vector<int> shown_mV_;
  std::vector<std::vector<std::uint8_t>> sent_;
  std::vector<std::string> notes_;
  std::string failure_;
};

}  // namespace omnihil
