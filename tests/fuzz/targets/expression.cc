// Formulas that a user writes as effects. What compiles gives the same value on numbers and on dual numbers; not to the last
// bit where it divides (Ceres multiplies by the inverse), and a condition may then go another way.
#include "sim/law/expression.h"

#include <cmath>

#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const std::string text(text_of(bytes));
  const std::vector<std::string> variables = {"omega_rotor_rad_s", "theta_rotor_rad", "a", "b"};
  std::vector<FormulaFault> faults;
  const auto formula = compile_formula(text, variables, faults);
  demand(formula.has_value() == faults.empty(), "a formula or a fault");
  for (const FormulaFault& fault : faults) {
    demand(fault.position >= 0 && fault.position <= static_cast<int>(text.size()),
           "a fault stands in the text");
  }
  if (formula && text.find('/') == std::string::npos) {
    for (const double x : {0.0, -3.5, 1e300}) {
      const double plain = formula->value<double>([&](int n) { return x + n; });
      const Jet dual = formula->value<Jet>([&](int n) { return Jet(x + n, 0); });
      demand(same(plain, dual.a), "numbers and dual numbers agree");
    }
  }
  ExpressionText effect;
  effect.name = "fuzz";
  effect.adds_to = "torque_Nm";
  effect.formula = text;
  effect.params.push_back({.name = "a", .unit = "1", .value = 0.5, .lower = 0.0, .upper = 1.0});
  faults.clear();
  const auto made = make_expression(effect, faults);
  demand((made != nullptr) == faults.empty(), "an effect or a fault");
}
