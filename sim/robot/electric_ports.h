// What passes between a three-phase robot's electrics and the outside: who sets its legs, what is true of it.
//
//   struct Mine : MotorControl { MotorDrive motor_tick(const MotorSensors& s) override { return {…}; } } mine;
//   plant.set_motor_control(0, &mine);     // called once per PWM period of robot 0, within advance()
#pragma once
#include <array>
#include <cstddef>
#include <type_traits>

#include "firmware_iface/phase_period.h"
#include "sim/robot/per_wheel.h"

namespace omnihil {

// Sets the legs of three-phase bridges, once per PWM period of that robot.
class MotorControl {
 public:
  virtual ~MotorControl() = default;
  virtual MotorDrive motor_tick(const MotorSensors& sensors) = 0;
  // It touches nothing that another robot's does: both may run at once.
  virtual bool runs_aside() const { return false; }
  // It runs within the periods: phase_period() is then called in place of motor_tick().
  virtual bool runs_in_periods() const { return false; }
  virtual PhaseLegs phase_period(const PhasePeriod&) { return {}; }
};

// Who carries out pieces of work that touch nothing of each other's: one after the other, or on several cores. What comes of
// it is the same. each() comes back when all are done; where several have thrown, what the first of them threw is thrown on.
class Workers {
 public:
  virtual ~Workers() = default;

  template <class Work>
  void each(std::size_t count, Work&& work) {
    const Piece piece = [](void* of, std::size_t n) {
      (*static_cast<std::remove_reference_t<Work>*>(of))(n);
    };
    run(count, piece, &work);
  }

 protected:
  using Piece = void (*)(void* of, std::size_t n);
  virtual void run(std::size_t count, Piece piece, void* of) = 0;
};

// Where energy went since the robot was placed. source = battery heat + bus + gain of the bus capacitor;
// bus = winding + device + mechanical + gain of what the inductances hold.
struct EnergyBook {
  double source_J = 0.0, battery_heat_J = 0.0, bus_J = 0.0;
  double winding_heat_J = 0.0, device_heat_J = 0.0, mechanical_J = 0.0;
};

// What no sensor of the robot shows. All zero for a robot without electrics of its own.
struct ElectricTruth {
  PerWheel<std::array<double, kLegs>> phase_current_A{};
  PerWheel<double> winding_K{}, housing_K{};  // over ambient
  double bus_voltage_V = 0.0;
  double battery_charge_C = 0.0;
  double in_inductances_J = 0.0;
  EnergyBook book;
};

}  // namespace omnihil
