#include "hil/loop/reference_firmware.h"

#include <algorithm>
#include <map>

#include "firmware_iface/host_firmware.h"
#include "sim/robot/electric_model.h"

namespace omnihil {

MotorConfig motor_config(const RobotModel& driven) {
  const RobotModel& model = driven.told ? *driven.told : driven;
  const ElectricModel& electric = electrics_of(model);
  const PhaseMotor<double> motor = phase_motor(model);
  MotorConfig config{};
  config.pole_pairs = static_cast<std::uint32_t>(motor.pole_pairs);
  config.back_emf =
      motor.back_emf.shape == BackEmfShape::kSine ? OMNIHIL_BACK_EMF_SINE : OMNIHIL_BACK_EMF_TRAPEZOID;
  config.pwm_frequency_Hz = electric.inverter.pwm_frequency_Hz;
  config.current_sample_ratio = electric.current_sample_ratio;
  config.phase_resistance_ohm = motor.resistance_ohm + electric.inverter.switch_resistance_ohm;
  config.phase_inductance_d_H = motor.inductance_d_H;
  config.phase_inductance_q_H = motor.inductance_q_H;
  config.flux_linkage_Wb = motor.flux_linkage_Wb;
  config.rotor_inertia_kg_m2 = motor.rotor_inertia_kg_m2;
  config.current_limit_A = model.motor.current_limit_A;
  return config;
}

Session::FirmwareMaker reference_firmware_for(const SessionConfig& session) {
  std::map<std::uint32_t, RobotModel> models;
  for (std::size_t i = 0; i < std::min(session.robots.size(), session.robot_ids.size()); ++i) {
    models.emplace(static_cast<std::uint32_t>(session.robot_ids[i]), session.robots[i]);
  }
  // Opponents with an id of ours: as that robot. Where they differ: opponents_alone().
  const Opponents& others = session.opponents;
  for (std::size_t i = 0; i < std::min(others.robots.size(), others.robot_ids.size()); ++i)
    models.emplace(static_cast<std::uint32_t>(others.robot_ids[i]), others.robots[i]);
  return [models = std::move(models)](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    const RobotModel& model = models.at(config.robot_id);
    if (model.motor_loop == MotorLoop::kFoc) return make_foc_firmware(config, motor_config(model));
    if (model.motor_loop == MotorLoop::kSixStep) return make_six_step_firmware(config, motor_config(model));
    if (model.motor_loop == MotorLoop::kEmotional) return make_emotional_firmware(config);
    return make_reference_firmware(config);
  };
}

}  // namespace omnihil
