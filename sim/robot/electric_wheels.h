// The wheels of one robot whose electrics are more than a DC-equivalent motor on a constant bus: three-phase
// drives, a battery, warm windings. Period by period of the drive, all wheels on one bus.
//
//   ElectricWheels wheels(model, electrical_step_s, step_s, seed, robot);
//   ElectricMemory memory = wheels.initial_memory();
//   wheels.begin_step(memory, inputs, now_ns, control, steps);       // one mechanical step; steps to it
//   // … mechanics advances one step …
//   double omega_wheel_rad_s = wheels.end_wheel(i, steps[i], omega_before_rad_s, omega_after_rad_s);
//
// Law: within a mechanical step the floor's torque of its start is held. Per period (PWM period with three
//   phases, electrical sub-step without): each winding by wheel_electrics.h at the bus voltage of the
//   period's start; then the bus by supply.h with the current of all wheels. Dry friction acts per period: a
//   rotor at rest is held while |motor + floor| <= level (motor: mean of the period before); one that passes
//   zero stops there. The mechanics gets, as constant torque of the step, the one that gives the rotor the
//   change of speed it had:  T = J (omega_end - omega_start) / h + floor + b mean omega.
//   Then the temperatures by thermal.h with the step's winding losses.
//   A firmware that sets the legs (MotorControl) is called after each period with what its sensors saw in it;
//   what it gives acts from the next one on. One that runs within the periods is shown each as it would be with
//   the legs that it begins with; a wheel whose legs change then has it anew with the legs' means.
// Coupling to the mechanics: held torques on either side, first order in the mechanical step.
// Cannot represent: effects that act in the drive (validate.h refuses them), the winding's response to a
//   departure from the predicted speed within a mechanical step.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "sim/robot/electric_ports.h"
#include "sim/robot/robot_effects.h"
#include "sim/robot/robot_faults.h"
#include "sim/robot/wheel_electrics.h"

namespace omnihil {

// Plain bytes.
struct ElectricMemory {
  PerWheel<WheelElectricState> wheel{};
  SupplyState<double> supply{};
  MotorSensors seen{};  // in the last period
  MotorDrive legs{};    // in force
  EnergyBook book{};
  double supply_ratio = 1.0;  // robot_faults.h
  PerWheel<bool> encoder_stuck{};
  double other_current_A = 0.0;  // on the bus beside the wheels: dribbler, the kicker's charger

  double at_bridges_V() const { return supply_ratio * supply.bus_voltage_V; }
};

class ElectricWheels {
 public:
  ElectricWheels(const RobotModel& model, double electrical_step_s, double step_s, std::uint64_t seed,
                 std::size_t robot);

  ElectricMemory initial_memory() const;
  // Supply, encoders and warm windings; the others reach it through its inputs. A winding whose rise was
  // `before` is left to the heat model.
  void set_faults(const RobotFaults& faults, const RobotFaults& before, ElectricMemory& memory) const;
  // `control` may be null: the legs of memory stay in force.
  void begin_step(ElectricMemory& memory, const PerWheel<WheelDriveInput>& inputs, std::int64_t now_ns,
                  MotorControl* control, PerWheel<WheelStep>& steps);
  double end_wheel(std::size_t wheel, const WheelStep& step, double omega_wheel_before_rad_s,
                   double omega_wheel_after_rad_s) const;
  ElectricTruth truth(const ElectricMemory& memory) const;
  double motor_current_A(const ElectricMemory& memory, std::size_t wheel) const;  // torque-equivalent, now

 private:
  struct StepIntegrals;  // of one wheel through a mechanical step
  PeriodFlow advance_wheel(ElectricMemory& memory, std::size_t wheel, const WheelDriveInput& in,
                           std::int64_t now_ns, double sample_ratio, StepIntegrals& integrals) const;
  void advance_bus(ElectricMemory& memory, double bus_charge_C) const;
  void advance_within(ElectricMemory& memory, const PerWheel<WheelDriveInput>& inputs, std::int64_t begin_ns,
                      std::int64_t end_ns, MotorControl& control, PerWheel<StepIntegrals>& integrals,
                      PerWheel<PeriodFlow>& flows) const;
  void see(ElectricMemory& memory, const PerWheel<PeriodFlow>& flows, std::int64_t at_ns) const;
  double measured_A(const PeriodSample& sample, std::size_t wheel, std::size_t phase,
                    std::int64_t at_ns) const;
  int hall(std::size_t wheel, double theta_rotor_rad, std::int64_t at_ns) const;

  RobotModel model_;
  ElectricModel electric_;
  std::vector<WheelElectrics> wheels_;  // each with its own temperature
  ThermalParams<double> thermal_;
  int periods_ = 1;
  double step_s_ = 0.0;
  std::uint64_t seed_ = 0;
  std::size_t robot_ = 0;
  PerWheel<double> friction_Nm_{};  // level of the last step
};

}  // namespace omnihil
