// omnihil::models, omnihil::effects: a motor of the installed models, with dry friction added.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "sim/bench/axis_sim.h"
#include "sim/law/effect_registry.h"
#include "sim/law/effect_set.h"
#include "sim/model/axis_model.h"

namespace {

double final_speed_rad_s(const omnihil::DriveParams<double>& drive, double friction_Nm, double voltage_V) {
  const omnihil::EffectUse use{.entry = omnihil::find_effect("coulomb_friction"), .values = {friction_Nm}};
  omnihil::AxisInput in;
  in.kind = omnihil::CommandKind::kMotorVoltage;
  for (int k = 0; k <= 1000; ++k) {
    in.time_s.push_back(k * 1e-3);
    in.command.push_back(voltage_V);
  }
  const omnihil::EffectSet<double> effects(std::span(&use, 1));
  return omnihil::run_axis<double>(drive, effects, in).back().omega_rotor_rad_s;
}

}  // namespace

bool friction_slows_a_motor_by_its_formula() {
  std::ifstream file(MODELS "/motors/maxon_ec45_flat_50w.toml");
  std::ostringstream text;
  text << file.rdbuf();
  const omnihil::AxisReading reading = omnihil::read_axis_model(text.str(), "motor", {});
  for (const auto& problem : reading.problems) std::printf("%s\n", problem.text().c_str());
  if (!reading.model) return false;
  omnihil::DriveParams<double> drive = reading.model->drive;
  drive.supply_voltage_V = 24.0;
  // Steady: k (V - k omega) / R = b omega + c, so c takes c / (b + k^2 / R) of speed.
  const double k = drive.torque_constant_Nm_per_A, R = drive.resistance_ohm, c = 5e-3;
  const double expected_rad_s = c / (drive.viscous_friction_Nm_s_per_rad + k * k / R);
  const double slower_rad_s = final_speed_rad_s(drive, 0.0, 12.0) - final_speed_rad_s(drive, c, 12.0);
  std::printf("%.6f rad/s slower, expected %.6f\n", slower_rad_s, expected_rad_s);
  return std::abs(slower_rad_s - expected_rad_s) < 1e-6 * expected_rad_s;
}
