// What a robot's model says about its electrics beyond the DC-equivalent motor: kind of drive, bridge, Hall
// and angle sensors, current sensing, battery, bus capacitor, heat. Neutral: none of it is there.
//
//   RobotModel m = model;
//   set_electrics(m, [](ElectricModel& e) { e.kind = DriveKind::kDq; });
//   electrics_of(m).three_phase();                  // of any model; all neutral where it says nothing
//   PhaseMotor<double> motor = phase_motor(m);      // the three-phase motor of the same terminal values
//
// dc        one winding on an averaged bridge (sim/drive): what there is without these numbers
// dq        three phases, averaged over each PWM period, in the rotor's frame: inductances of both axes,
//           saturation, dead time; sinusoidal back-EMF. A floating or chopped leg is taken to the averaged
//           circuit (averaged_drive.h), which knows neither.
// switched  every edge of the bridge (switched_drive.h), floating phases, diodes, ripple, any back-EMF
// The torque constant of the model belongs to the commutation with which the drive itself runs (dq:
// sinusoidal, switched: block) unless constant_for says otherwise. Laws, sources and limits: sim/drive.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/drive/absolute_encoder.h"
#include "sim/drive/current_sensor.h"
#include "sim/drive/hall_sensors.h"
#include "sim/drive/inverter.h"
#include "sim/drive/phase_motor.h"
#include "sim/drive/supply.h"
#include "sim/drive/thermal.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

enum class DriveKind : std::uint8_t { kDc, kDq, kSwitched };
enum class ConstantFor : std::uint8_t { kAsDriven, kBlock, kSinusoidal };

// Winding and housing as a data sheet gives them; winding_to_housing 0: no heat is reckoned.
struct HeatModel {
  double winding_to_housing_K_per_W = 0.0;
  double housing_to_ambient_K_per_W = 0.0;
  double winding_time_constant_s = 0.0;
  double housing_time_constant_s = 0.0;
  double copper_per_K = kCopperPerK;
  double magnet_per_K = kNeodymiumPerK;
};

struct ElectricModel {
  DriveKind kind = DriveKind::kDc;
  Inverter inverter;
  PwmMode pwm_mode = PwmMode::kComplementary;  // of a switched drive that commutates by itself
  BackEmf back_emf;
  ConstantFor constant_for = ConstantFor::kAsDriven;
  double saliency_ratio = 1.0;  // L_q / L_d; their mean is half the terminal inductance
  double inductance_saturation_per_A = 0.0;
  double flux_saturation_per_A = 0.0;
  HallParams hall;
  AbsoluteEncoderParams angle{.bits = 0};     // of the electrical angle; 0 bits: not rounded
  CurrentSensor current_sensor{.bits = 0};    // 0 bits: not rounded
  double current_sample_ratio = 0.0;          // instant within the PWM period; 0.5: middle of the on-time
  BatteryParams<double> battery{.cells = 0};  // 0 cells: the bus voltage is constant
  double battery_charge_ratio = 1.0;          // at the start
  double bus_capacitance_F = 0.0;
  HeatModel heat;

  bool three_phase() const { return kind != DriveKind::kDc; }
  bool has_battery() const { return battery.cells > 0; }
  bool has_heat() const { return heat.winding_to_housing_K_per_W > 0.0; }
  // False: the plant's DC-equivalent drive on a constant bus, as if these numbers did not exist.
  bool any() const { return three_phase() || has_battery() || has_heat(); }
};

const ElectricModel& electrics_of(const RobotModel& model);

// Copies of the model keep what they had.
template <typename Change>
void set_electrics(RobotModel& model, Change&& change) {
  auto next = std::make_shared<ElectricModel>(electrics_of(model));
  change(*next);
  model.electric = std::move(next);
}

// How the drive commutates when it is given a duty.
Commutation own_commutation(const ElectricModel& electric);

// The three-phase motor with the model's terminal values, cold.
PhaseMotor<double> phase_motor(const RobotModel& model);

// Everything that is wrong with it, one sentence each, with name, value and what is allowed.
std::vector<std::string> electric_problems(const RobotModel& model);

}  // namespace omnihil
