// A board on motors of their own: bridges, windings, rotors and what the board's sensors see of them.
//
//   MotorsOnBoard bench(*board, 24.0, 4000);
//   bench.add({.wheel = 0, .drive = make_switched_drive(motor, inverter, {})});
//   bench.period();                       // once per PWM period: sensors to the board, legs to the bridges
//
// All bridges have one PWM period. Nothing else is between board and motors: no robot, no battery.
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
    world_.at_ns = board_.now_ns();
    for (const MotorOnBoard& motor : motors) {
      const auto w = static_cast<std::size_t>(motor.wheel);
      world_.theta_rotor_rad[w] = motor.theta_rad();
      world_.omega_rotor_rad_s[w] = motor.omega_rad_s();
      world_.motor_current_A[w] = motor.shunt_A;
      world_.phase_current_A[w] = motor.phase_A;
      world_.leg_V[w] = motor.leg_V;
    }
    board_.set_world(world_);
    for (MotorOnBoard& motor : motors) turn(motor);
    ++periods_;
    const double at_ns = static_cast<double>(periods_) * motors[0].drive.period_s * 1e9;
    board_.run_until_ns(start_ns_ + std::llround(at_ns));
  }

  std::vector<MotorOnBoard> motors;

 private:
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
};

}  // namespace omnihil
