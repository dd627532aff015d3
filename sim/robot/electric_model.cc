#include "sim/robot/electric_model.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/law/effect_set.h"

namespace omnihil {
namespace {

void check_heat(const HeatModel& h, std::vector<std::string>& out) {
  const auto positive = [&](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      out.push_back(
          fmt::format("thermal.{} = {}: must be more than 0 once the thermal model is on", name, value));
    }
  };
  positive("housing_to_ambient_K_per_W", h.housing_to_ambient_K_per_W);
  positive("winding_time_constant_s", h.winding_time_constant_s);
  positive("housing_time_constant_s", h.housing_time_constant_s);
}

void check_battery(const ElectricModel& e, std::vector<std::string>& out) {
  if (!(e.battery.capacity_C > 0.0)) {
    out.push_back(fmt::format("battery.capacity_C = {}: must be more than 0", e.battery.capacity_C));
  }
  if (!(e.battery.resistance_ohm > 0.0)) {
    out.push_back(fmt::format("battery.resistance_ohm = {}: must be more than 0", e.battery.resistance_ohm));
  }
  if (!(e.battery_charge_ratio > 0.0 && e.battery_charge_ratio <= 1.0)) {
    out.push_back(
        fmt::format("battery.charge_ratio = {}: must be more than 0 and at most 1", e.battery_charge_ratio));
  }
  if (!e.battery.takes_charge && !(e.bus_capacitance_F > 0.0)) {
    out.push_back(
        "battery.refuses_charge: what braking gives back needs a place; supply.capacitance_F must be more "
        "than 0");
  }
}

void check_drive(const RobotModel& m, std::vector<std::string>& out) {
  const ElectricModel& e = electrics_of(m);
  for (const std::string& p : problems_of(e.inverter)) out.push_back("drive." + p);
  if (!(m.motor.inductance_H > 0.0)) {
    out.push_back(
        fmt::format("motor.inductance_H = {}: a three-phase drive needs more than 0", m.motor.inductance_H));
  }
  if (m.motor.pole_pairs < 1) {
    out.push_back(
        fmt::format("motor.pole_pairs = {}: a three-phase drive needs 1 or more", m.motor.pole_pairs));
  }
  if (e.kind == DriveKind::kDq && e.back_emf.shape != BackEmfShape::kSine) {
    out.push_back("motor.back_emf = trapezoid: drive.kind = dq is sinusoidal; allowed with switched");
  }
  if (e.kind == DriveKind::kSwitched &&
      (e.saliency_ratio != 1.0 || e.inductance_saturation_per_A != 0.0 || e.flux_saturation_per_A != 0.0)) {
    out.push_back(
        "motor.saliency_ratio, inductance_saturation_per_A, flux_saturation_per_A: drive.kind = switched "
        "does not know them; allowed with dq");
  }
}

// Effects that act inside the DC-equivalent drive, which is not there any more.
void check_effects(const RobotModel& m, std::vector<std::string>& out) {
  if (m.effects == nullptr) return;
  for (const EffectUse& use : *m.effects) {
    const Place place = use.entry->info->place;
    if (place > Place::kShaft || is_neutral(use)) continue;
    out.push_back(
        fmt::format("effects.{}: acts in the DC-equivalent drive ({}), which drive.kind, [battery] and "
                    "[thermal] replace; "
                    "there, effects of contact, body, sensor and timing act",
                    use.entry->info->id, place_name(place)));
  }
}

}  // namespace

const ElectricModel& electrics_of(const RobotModel& model) {
  static const ElectricModel kNone;
  return model.electric != nullptr ? *model.electric : kNone;
}

Commutation own_commutation(const ElectricModel& electric) {
  return electric.kind == DriveKind::kDq ? Commutation::kSinusoidal : Commutation::kBlock;
}

PhaseMotor<double> phase_motor(const RobotModel& model) {
  const ElectricModel& e = electrics_of(model);
  Commutation given = own_commutation(e);
  if (e.constant_for != ConstantFor::kAsDriven) {
    given = e.constant_for == ConstantFor::kBlock ? Commutation::kBlock : Commutation::kSinusoidal;
  }
  PhaseMotor<double> m = phase_motor_of(model.motor, given, e.back_emf);
  // (L_d + L_q) / 2 = L,  L_q = ratio L_d
  m.inductance_d_H *= 2.0 / (1.0 + e.saliency_ratio);
  m.inductance_q_H = e.saliency_ratio * m.inductance_d_H;
  m.inductance_saturation_per_A = e.inductance_saturation_per_A;
  m.flux_saturation_per_A = e.flux_saturation_per_A;
  return m;
}

std::vector<std::string> electric_problems(const RobotModel& model) {
  std::vector<std::string> out;
  const ElectricModel& e = electrics_of(model);
  if (e.three_phase()) check_drive(model, out);
  if (e.has_battery()) check_battery(e, out);
  if (e.bus_capacitance_F != 0.0 && !e.has_battery()) {
    out.push_back(
        fmt::format("supply.capacitance_F = {}: says nothing on a constant bus voltage; needs a [battery]",
                    e.bus_capacitance_F));
  }
  if (e.has_heat()) check_heat(e.heat, out);
  if (e.any()) check_effects(model, out);
  if ((model.motor_loop == MotorLoop::kFoc || model.motor_loop == MotorLoop::kSixStep) && !e.three_phase()) {
    out.push_back(
        "firmware.motor_loop: sets the legs of three phases; drive.kind must be \"dq\" or \"switched\"");
  }
  return out;
}

}  // namespace omnihil
