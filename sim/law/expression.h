// Effects that a user writes as a formula.
//
//   [effects.expression.fan]
//   adds_to = "torque_Nm"
//   formula = "-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)"
//   a = { value = 2e-8, lower = 0, upper = 1e-6, unit = "N m s2/rad2" }
//
// `adds_to` chooses the place; the signals of that place and the section's own parameters are what the
// formula may use (expression_signals.h, `omnihil effects expression`). Each becomes an EffectUse like any
// other: simulated, fitted with exact derivatives, written back.
//
// Which parameters turn it off: the fewest, later ones first spared, for which the formula is zero at every
// signal when they are 0 (tried at 64 points; 0 must be within their bounds). Where there are none it gets a
// parameter `share` of its own, 0 to 1, that multiplies the whole.
// Cannot: memory, random numbers, delays.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "sim/law/effect_set.h"
#include "sim/law/formula.h"

namespace omnihil {

struct ExpressionParam {
  std::string name;
  std::string unit = "1";
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

struct ExpressionText {
  std::string name;
  std::string adds_to;
  std::string formula;
  std::vector<ExpressionParam> params;
  bool linear = false;  // a linear axis: torque_N for torque_Nm, v_rotor … as everywhere
};

struct Expression {
  ExpressionText text;
  Formula formula;
  int target = 0;       // index in the targets of its place
  bool shared = false;  // its last parameter is `share`
  std::vector<EffectParam> rows;
  EffectInfo info;
  EffectEntry entry;
};

// Null when there are faults; those of `adds_to` are at position -1.
std::shared_ptr<const Expression> make_expression(ExpressionText text, std::vector<FormulaFault>& faults);

EffectUse use_of_expression(std::shared_ptr<const Expression> expression);
// What made this use; null where it is no formula.
const Expression* expression_of(const EffectUse& use);

// "expression.fan.a=2e-8": changes one that the model has. "" or what is wrong.
std::string override_expression(std::string_view text, std::vector<EffectUse>& uses);
// One section as text of a model file.
std::string write_expression(const EffectUse& use);

// Places, what can be added to there and what can be read, with units: for people.
std::string expression_help();
// Quadratic drag, as a formula: what `omnihil effects expression` shows.
std::shared_ptr<const Expression> example_expression();

}  // namespace omnihil
