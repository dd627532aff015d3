// One PWM period between a robot's windings and an emulated board, whose timers and converters run within it.
//
//   PhasePeriod period{.begin = seen, .end_ns = end_ns};      // as it would be if no leg changed
//   PhaseLegs legs = board_firmware.phase_period(period);     // runs to its end
//   MotorDrive then = legs.end;                               // and the windings have had legs.mean
//
// Currents go straight from the period's begin to its end. Legs that have changed within it are taken on the mean, so that a
// voltage acts at its instant, and the currents of the next period's begin are the ones that it has made; between that instant
// and the end of its period the board sees the currents that there would be without it.
#pragma once
#include <cstdint>

#include "firmware_iface/robot_io.h"

namespace omnihil {

struct PhasePeriod {
  MotorSensors begin{};  // at the period's begin; leg_V: means of the period
  std::int64_t end_ns = 0;
  double end_phase_current_A[kWheels][kLegs]{};
};

struct PhaseLegs {
  MotorDrive mean{};  // of the period
  MotorDrive end{};   // at its end
};

}  // namespace omnihil
