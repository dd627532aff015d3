// A board on motors of their own: bridges, windings, rotors and what the board's sensors see of them.
//
//   MotorsOnBoard bench(*board, 24.0, 4000);
//   bench.add({.wheel = 0, .drive = make_switched_drive(motor, inverter, {})});
//   bench.period();                       // once per PWM period: sensors to the board, legs to the bridges
//
// All bridges have one PWM period. Nothing else is between board and motors: no robot, no battery.
// A bridge takes what its timer's pins are at a period's begin, in the middle of its off-time, and the board sees the phases'
// currents of the middle of the period before: together 1.5 periods late. After align() neither is late.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "sim/drive/switched_drive.h"

namespace omnihil {

enum class Shunt : std::uint8_t { kPhase, kBus };  // largest phase current in the on-time; mean bus current

struct MotorOnBoard {
  int wheel = 0;
  SwitchedDrive drive;
  Shunt shunt = Shunt::kPhase;
  double load_Nm = 0.0;  // friction: against the rotation
  SwitchedState x = {};
  PhaseFlow flow = {};
  double shunt_A = 0.0;
  std::array<double, kLegs> phase_A = {};  // at the middle of the period
  std::array<double, kLegs> leg_V = {};    // means of the period
  PhaseState begin = {};                   // of the period
  BridgeCommand command = {};

  double omega_rad_s() const { return x.motor.omega_rotor_rad_s; }
  double theta_rad() const { return x.motor.theta_rotor_rad; }
};

class MotorsOnBoard {
 public:
  MotorsOnBoard(mcu::McuBoard& board, double bus_V, double counts_per_turn) : board_(board) {
    world_.bus_voltage_V = bus_V;
    world_.encoder_counts_per_rotor_turn = counts_per_turn;
    start_ns_ = board.now_ns();
  }
  void add(MotorOnBoard motor) { motors.push_back(std::move(motor)); }

  void period() {
    world_.at_ns = world_.phases_at_ns = board_.now_ns();
    for (MotorOnBoard& motor : motors) {
      const auto w = static_cast<std::size_t>(motor.wheel);
      world_.motor_current_A[w] = motor.shunt_A;
      world_.phase_current_A[w] = motor.phase_A;
      turn(motor);
      world_.theta_rotor_rad[w] = motor.begin.theta_rotor_rad;
      world_.omega_rotor_rad_s[w] = motor.begin.omega_rotor_rad_s;
      if (aligned_) go_straight(motor);
      world_.leg_V[w] = motor.leg_V;
    }
    board_.set_world(world_);
    ++periods_;
    const double at_ns = static_cast<double>(periods_) * motors[0].drive.period_s * 1e9;
    board_.run_until_ns(start_ns_ + std::llround(at_ns));
  }

  // Periods begin where this timer, which counts up and down, counts up from 0, and currents go straight from a period's begin
  // to its end, as they are without ripple.
  void align(std::string_view timer) {
    mcu::Timer& counter = *board_.chip().find<mcu::Timer>(timer);
    const auto rises = [&] {
      constexpr std::uint32_t kCount = 0x24;
      const std::uint32_t before = counter.peek(kCount);
      board_.run_until_ns(board_.now_ns() + 50);
      return counter.peek(kCount) > before;
    };
    const std::int64_t end_ns = board_.now_ns() + 1'000'000;
    while (rises() && board_.now_ns() < end_ns) continue;
    while (!rises() && board_.now_ns() < end_ns) continue;
    start_ns_ = board_.now_ns();
    periods_ = 0;
    aligned_ = true;
  }

  std::vector<MotorOnBoard> motors;

 private:
  void go_straight(const MotorOnBoard& motor) {
    const auto w = static_cast<std::size_t>(motor.wheel);
    world_.phase_current_A[w] = motor.begin.current_A;
    for (std::size_t n = 0; n < kLegs; ++n)
      world_.phase_rate_A_s[w][n] =
          (motor.x.motor.current_A[n] - motor.begin.current_A[n]) / motor.drive.period_s;
  }
  void turn(MotorOnBoard& motor) const {
    std::uint32_t leg[kLegs];
    double duty[kLegs];
    board_.wire(motor.wheel)->legs(leg, duty);
    for (std::size_t n = 0; n < 3; ++n) {
      const LegState on = leg[n] == OMNIHIL_LEG_LOW ? LegState::kLow : LegState::kHigh;
      const LegState off = leg[n] == OMNIHIL_LEG_PWM ? LegState::kLow : LegState::kOff;
      motor.command[n] = leg[n] == OMNIHIL_LEG_OFF ? LegCommand{} : LegCommand{on, off, duty[n]};
    }
    const PhaseFlow before = motor.flow;
    motor.begin = motor.x.motor;
    const double load_Nm = motor.load_Nm * std::tanh(motor.omega_rad_s());
    const PeriodSample sample =
        advance_period(motor.drive, motor.x, motor.command,
                       {.bus_voltage_V = world_.bus_voltage_V, .tau_load_Nm = load_Nm}, 0.5, motor.flow);
    std::copy_n(sample.current_A.begin(), kLegs, motor.phase_A.begin());
    for (std::size_t n = 0; n < kLegs; ++n)
      motor.leg_V[n] = (motor.flow.leg_V_s[n] - before.leg_V_s[n]) / motor.drive.period_s;
    motor.shunt_A = motor.shunt == Shunt::kBus
                        ? (motor.flow.bus_charge_C - before.bus_charge_C) / motor.drive.period_s
                        : *std::max_element(sample.current_A.begin(), sample.current_A.end());
  }

  mcu::McuBoard& board_;
  mcu::WorldState world_;
  std::int64_t start_ns_ = 0, periods_ = 0;
  bool aligned_ = false;
};

}  // namespace omnihil
