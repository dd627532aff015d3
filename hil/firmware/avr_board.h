// One board of a robot of AVR boards: a chip in a process of its own with its wires, asked line by line.
//
//   AvrBoard board(spec, spec.motors[2], image, config, 10.0);   // throws std::invalid_argument
//   board.begin(world, end_ns);                                 // let it run
//   board.finish();                                             // wait for it
//   board.drive();                                              // what the bridge did on the mean
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "firmware_iface/mcu/avr/avr_board.h"
#include "firmware_iface/mcu/avr/avr_image.h"
#include "firmware_iface/mcu/board/motor_wire.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "hil/firmware/avr_process.h"

namespace omnihil {

class AvrBoard {
 public:
  AvrBoard(const mcu::AvrBoardSpec& spec, const mcu::AvrMotor& motor, const mcu::AvrImage& image,
           const RobotConfig& config, double deadline_s);

  int wheel() const { return motor_.wheel; }
  void receive(std::span<const std::uint8_t> frame);  // by the radio, before the next begin()
  void begin(const mcu::WorldState& world, std::int64_t end_ns);
  void finish();
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
