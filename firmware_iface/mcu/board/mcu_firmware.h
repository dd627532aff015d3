// An unmodified image on an emulated board, as an omnihil::Firmware in lock-step with the plant.
//
//   auto firmware = std::make_unique<mcu::McuFirmware>(spec, image, robot_config);
//   firmware->shafts(exact);  RobotDrive drive = firmware->tick(sensors);      // every coupling period
//
// tick() at t lets the board run from t to t + control_period_ns(), with shafts turning on at their speed,
// and gives the mean of what the bridges did in that time, which the plant then holds for the same time: no
// delay is added. The grid of ticks is absolute, so results do not depend on the loop step. Boards with
// three-phase bridges run from PWM period to PWM period of the plant (phase_period.h). Effects of the model
// on encoders act as the difference between sensed and exact counts at each tick. A robot may have several
// boards with the same image, each driving the next wheels. Commands reach the
// image as radio frames, which it decodes itself, or as wheel speeds by eq. (5) in the words of its main
// board (wheel_words.h); a command older than a quarter of a second is speed 0. Cannot represent: ripple
// within a coupling period, kicker and dribbler (they have no wires yet), duties to boards that take wheel
// commands.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/ports.h"

namespace omnihil::mcu {

// What the memory card of a board holds; throws std::invalid_argument.
using CardOpener = std::function<CardImage(const DeviceEntry& card, int board)>;

class McuFirmware final : public Firmware {
 public:
  // Throws std::invalid_argument if the image does not fit the chip.
  McuFirmware(const BoardSpec& spec, const ElfImage& image, const RobotConfig& config,
              const CardOpener& cards = {});

  std::string_view name() const override { return name_; }
  std::string_view radio_format() const override { return spec_.radio_format; }
  std::int64_t control_period_ns() const override { return spec_.coupling_ns; }
  void command(const RobotCommand& command, std::int64_t now_ns) override;
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override;
  std::size_t radio_transmit(std::span<std::uint8_t> out) override;
  bool set_gains(const RobotGains&) override { return false; }
  RobotGains gains() const override { return {}; }
  void shafts(const RobotShafts& exact) override { exact_ = exact; }
  RobotDrive tick(const RobotSensors& sensors) override;
  // A part is a board; of three-phase boards, which run on in phase_period(), one with nothing to do.
  std::size_t tick_parts() const override { return phases_ ? 1 : boards_.size(); }
  void begin_tick(const RobotSensors& sensors) override;
  void run_part(std::size_t part) override;
  RobotDrive end_tick() override;
  RobotFeedback feedback() const override { return feedback_; }
  bool drives_phases() const override { return phases_; }
  bool runs_in_phase_periods() const override { return phases_; }
  PhaseLegs phase_period(const PhasePeriod& period) override;
  // Updates of the board's control timer that came before the image had taken the last one.
  std::uint64_t missed_control_periods() const override;

  int boards() const { return static_cast<int>(boards_.size()); }
  McuBoard& board(int i = 0) { return *boards_[static_cast<std::size_t>(i)]; }
  const McuBoard& board(int i = 0) const { return *boards_[static_cast<std::size_t>(i)]; }
  std::uint64_t commands_ignored() const { return commands_ignored_; }

 private:
  void look(const RobotSensors& sensors);
  void show_world();
  void speak(std::int64_t now_ns);
  std::array<double, kWheels> commanded_wheels_rad_s(std::int64_t now_ns) const;
  MotorWire* wire(int wheel) const;  // of whichever board drives it; null: none

  std::string name_;
  RobotConfig config_;
  BoardSpec spec_;
  int wheels_per_board_ = kWheels;
  std::vector<std::unique_ptr<McuBoard>> boards_;
  RobotCommand command_{};
  std::int64_t command_at_ns_ = 0;
  bool commanded_ = false;
  bool phases_ = false;
  RobotShafts exact_{};
  WorldState world_;
  RobotFeedback feedback_{};
  std::uint64_t commands_ignored_ = 0;
};

// Why the image is no use any more: it has locked up, only faults and is reset, or stays in the handler of a
// fault; empty: it is of use.
std::string board_failure(const McuBoard& board, const ElfImage& image);

// What the run of an image has shown: unmodelled registers, null pointers, faults, stack, load. For people,
// line by line; empty when there is nothing to say.
std::vector<std::string> board_report(const McuBoard& board, const ElfImage& image);

}  // namespace omnihil::mcu
