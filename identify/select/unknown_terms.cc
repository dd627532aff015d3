#include "identify/select/unknown_terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/law/expression.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// As a formula of this rig spells it.
std::string spelt(std::string_view name, bool linear) {
  EffectParam row;
  row.name = name;
  return param_key(row, linear);
}

// Sine and cosine of an angle's orders, bare and as friction that depends on the angle.
void add_orders(const std::string& angle, const std::vector<double>& orders, const std::string& direction,
                double torque, const std::string& unit, std::vector<UnknownTerm>& terms) {
  for (const double n : orders) {
    const std::string of = n == 1.0 ? angle : fmt::format("{:g}*{}", n, angle);
    for (const char* f : {"sin", "cos"}) {
      terms.push_back({.text = fmt::format("{}({})", f, of), .unit = unit, .size = torque});
      terms.push_back({.text = fmt::format("{}({})*{}", f, of, direction), .unit = unit, .size = torque});
    }
  }
}

std::vector<double> orders_to_try(const DataScale& scale) {
  std::vector<double> orders{1.0, 2.0, 3.0};
  for (const double n : scale.orders) {
    if (std::find(orders.begin(), orders.end(), n) == orders.end()) orders.push_back(n);
  }
  return orders;
}

}  // namespace

std::vector<UnknownTerm> torque_terms(const Candidate& model, const DataScale& scale, double torque_scale) {
  const bool linear = model.file.linear;
  const std::string w = spelt("omega_rotor_rad_s", linear), angle = spelt("theta_rotor_rad", linear);
  const std::string tau = spelt("tau_motor_Nm", linear);
  const double top = scale.top_speed_rad_s > 0.0 ? scale.top_speed_rad_s : 1.0;
  const std::string direction = fmt::format("tanh({}/{:.3g})", w, 0.01 * top);
  const std::string force = linear ? "N" : "N m", way = linear ? "m" : "rad";
  std::vector<UnknownTerm> terms{
      {.text = "1", .unit = force, .size = torque_scale},
      {.text = direction, .unit = force, .size = torque_scale},
      {.text = w, .unit = force + " s/" + way, .size = torque_scale / top},
      {.text = fmt::format("{0}*abs({0})", w),
       .unit = force + " s2/" + way + "2",
       .size = torque_scale / (top * top)},
      {.text = fmt::format("abs({})", w), .unit = force + " s/" + way, .size = torque_scale / top},
      {.text = fmt::format("{0}*{0}", w),
       .unit = force + " s2/" + way + "2",
       .size = torque_scale / (top * top)},
      {.text = fmt::format("{}*exp(-({}/{:.3g})^2)", direction, w, 0.05 * top),
       .unit = force,
       .size = torque_scale},
      {.text = tau, .unit = "1", .size = 0.05, .of_motor_torque = true},
      {.text = fmt::format("abs({})*{}", tau, direction), .unit = "1", .size = 0.05, .of_motor_torque = true},
      {.text = fmt::format("{0}*abs({0})", tau),
       .unit = "1/(" + force + ")",
       .size = 0.02 / torque_scale,
       .of_motor_torque = true},
  };
  if (!linear) {
    add_orders(angle, orders_to_try(scale), direction, torque_scale, force, terms);
    if (drive_of(model).gear_ratio != 1.0) {
      add_orders("theta_output_rad", {1.0, 2.0}, direction, torque_scale, force, terms);
    }
  }
  return terms;
}

std::vector<UnknownTerm> voltage_terms(const Candidate& model, const DataScale& scale) {
  const DriveParams<double> drive = drive_of(model);
  if (drive.resistance_ohm <= 0.0 || drive.supply_voltage_V <= 0.0) return {};
  const double volts = 0.02 * drive.supply_voltage_V;
  const double amperes =
      scale.top_current_A > 0.0 ? scale.top_current_A : drive.supply_voltage_V / drive.resistance_ohm;
  const double emf = drive.torque_constant_Nm_per_A * std::max(scale.top_speed_rad_s, 1.0);
  return {
      {.text = "1", .unit = "V", .size = volts},
      {.text = fmt::format("tanh(current_A/{:.3g})", 0.03 * amperes), .unit = "V", .size = volts},
      {.text = "current_A", .unit = "ohm", .size = volts / amperes},
      {.text = "current_A*abs(current_A)", .unit = "ohm/A", .size = volts / (amperes * amperes)},
      {.text = "current_A^3", .unit = "ohm/A2", .size = volts / (amperes * amperes * amperes)},
      {.text = "duty_ratio*abs(duty_ratio)", .unit = "V", .size = volts},
      {.text = "bus_voltage_V*duty_ratio", .unit = "1", .size = 0.02},
      {.text = "back_emf_V*abs(back_emf_V)", .unit = "1/V", .size = volts / (emf * emf)},
      {.text = "current_A*abs(back_emf_V)", .unit = "1/A", .size = volts / (amperes * emf)},
  };
}

EffectUse formula_use(const std::string& name, const std::string& adds_to,
                      const std::vector<UnknownTerm>& terms, const std::vector<double>& coefficients,
                      bool linear) {
  constexpr double kFree = 50.0;  // bounds, times the estimate, either sign: wide enough to be none. A guess.
  ExpressionText text;
  text.name = name;
  text.adds_to = adds_to == "torque_Nm" ? spelt(adds_to, linear) : adds_to;
  text.linear = linear;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const std::string letter(1, static_cast<char>('a' + t));
    text.formula += fmt::format("{}{}*{}", t > 0 ? " + " : "", letter, terms[t].text);
    const double bound = kFree * std::max(std::abs(coefficients[t]), terms[t].size);
    text.params.push_back(
        {.name = letter, .unit = terms[t].unit, .value = coefficients[t], .lower = -bound, .upper = bound});
  }
  std::vector<FormulaFault> faults;
  const auto expression = make_expression(std::move(text), faults);
  if (expression == nullptr) return {};
  EffectUse use = use_of_expression(expression);
  for (std::size_t t = 0; t < terms.size(); ++t) use.values[t] = coefficients[t];
  return use;
}

}  // namespace omnihil
