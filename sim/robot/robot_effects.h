// Effects of one robot: its drives through one mechanical step, its floor and body, its sensors.
//
//   RobotEffects effects(model, electrical_step_s, substeps, step_s);   // model.effects not null
//   effects.begin_step(law, memory, inputs, steps);      // all drives on one bus; steps[i] to the mechanics
//   // … mechanics advances one step …
//   double omega_wheel_rad_s = effects.end_wheel(law, memory, i, steps[i], omega_before_rad_s, omega_after_rad_s);
//
// Law: each wheel's drive is DriveSim (drive_sim.h: command, supply, bridge, winding, torque) with the
//   floor's force of the step's start held over the step. The mechanics gets the mean torque of all that is
//   inside the drive; of its profile within the step only the winding current's part is given (Simpson's rule
//   through start, mean and end), the rest as its mean. The winding's sensitivity to a departure from the
//   predicted speed is that of wheel_drive.h, with the base model's winding.
//   Supply: where an effect acts on it, the drives advance one electrical sub-step at a time and each is
//   told what the others take from the bus; all see the same dip at the same time.
//   Rolling resistance is a level of dry friction on its wheel and joins the friction of the drive, so that a
//   wheel is held by both together. A wheel that friction stopped within a step stands at its end; one that
//   passed zero against the forecast gets the settlement of wheel_drive.h with the friction in force.
// Play and compliance between rotor and wheel (Place::kShaft): the rotor is a mass of its own, advanced by
//   DriveSim with the wheel as its output (shaft_step.h); the mechanics has the wheel alone, pushed by the
//   shaft's mean torque, and goes along in the electrical step (mechanics_step_ns), because a wheel without
//   its rotor settles on the floor several times faster. Wheel and floor correct the drive's forecast of the
//   wheel after every step; shaft and wheel get the same impulse, so no momentum is lost. Rolling resistance
//   then holds the wheel, all friction of the drive the rotor.
// Cannot represent: one stage of play that all wheels share; flexing of the wheel's suspension.
#pragma once
#include <array>
#include <memory>

#include "sim/drive/drive_sim.h"
#include "sim/robot/floor_effects.h"
#include "sim/robot/plant.h"
#include "sim/robot/robot_faults.h"
#include "sim/robot/wheel_drive.h"

namespace omnihil {

// What effects remember of one robot; plain bytes.
struct RobotEffectMemory {
  PerWheel<DriveState<double>> drive{};
  std::array<double, kMaxEffectStates> timing{};  // states of timing effects; all others are the drives'
  PerWheel<double> seen_theta_rotor_rad{};        // at the last read
  PerWheel<double> charge_C{};                    // integral of the motor current
  PerWheel<double> seen_charge_C{};
  double seen_s = 0.0, read_s = 0.0;  // instant that the last read showed; instant of the last read
  double bus_voltage_V = 0.0;
};

// One wheel's input over a mechanical step.
struct WheelDriveInput {
  BridgeInput bridge;
  double omega_wheel_rad_s = 0.0, theta_wheel_rad = 0.0;
  double contact_Nm = 0.0;         // floor's torque on the rotor, as in begin_wheel_step
  double friction_rotor_Nm = 0.0;  // rolling resistance, through the gear
  bool phase_lost = false;
};

// The drive's numbers of a robot's wheel: the wheel is its load.
DriveParams<double> wheel_drive_params(const RobotModel& model);

class RobotEffects {
 public:
  RobotEffects(const RobotModel& model, double electrical_step_s, int substeps, double step_s);

  RobotEffectMemory initial_memory() const;
  // Supply and warm windings (robot_faults.h); the others reach it through its inputs.
  void set_faults(const RobotFaults& faults);
  void begin_step(const WheelDriveLaw& law, RobotEffectMemory& memory,
                  const PerWheel<WheelDriveInput>& inputs, PerWheel<WheelStep>& steps);
  double end_wheel(const WheelDriveLaw& law, RobotEffectMemory& memory, std::size_t wheel, WheelStep& step,
                   double omega_wheel_before_rad_s, double omega_wheel_after_rad_s) const;

  FloorEffects floor;
  const EffectSet<double>& set() const { return *set_; }
  bool looks_back() const { return !set_->timing.empty(); }
  // The rotors are masses of their own: their motion is in memory.drive, the wheels' in the mechanics.
  bool two_masses() const { return drives_[0].two_masses(); }

 private:
  // What the plant tells a wheel's drive, and learns from it, within its chains of effects.
  struct Link;
  struct LinkEffect;
  struct Links;
  void set_motion(const WheelDriveLaw& law, RobotEffectMemory& memory,
                  const PerWheel<WheelDriveInput>& inputs);
  void advance(RobotEffectMemory& memory, const PerWheel<WheelDriveInput>& inputs,
               PerWheel<DriveResult<double>>& results) const;

  std::shared_ptr<const EffectSet<double>> set_;
  std::shared_ptr<Links> links_;  // before the drives, which point into it
  std::vector<DriveSim<double>> drives_;
  int substeps_ = 1;
  double bus_voltage_V_ = 0.0;
  double supply_ratio_ = 1.0;
  RobotFaults built_;  // the windings of drives_
};

// The models with what body effects make of their masses; effects all at neutral are none.
std::vector<RobotModel> models_with_effects(std::span<const RobotModel> robots);

// An effect acts between the rotors and the wheels.
bool has_shaft(const RobotModel& model);
// What the mechanics moves: without the rotors (and their friction) where these are masses of their own.
std::vector<RobotModel> models_of_mechanics(std::span<const RobotModel> robots);
// The step of the mechanics: the electrical one where any robot has a shaft.
std::int64_t mechanics_step_ns(std::span<const RobotModel> robots, const PlantOptions& options);

using AllEffects = std::vector<std::unique_ptr<RobotEffects>>;  // per robot; null: it has none
AllEffects make_effects(const std::vector<RobotModel>& models, const PlantOptions& options);
std::vector<const FloorEffects*> floors_of(const AllEffects& all);

}  // namespace omnihil
