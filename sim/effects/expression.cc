// The user's own formula. What stands here is the example that documentation and tests show; the formulas of
// a model file are made by sim/law/expression.h.
#include "sim/law/expression.h"

#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct Example {
  std::shared_ptr<const Expression> expression = example_expression();
  std::string equation = expression->text.adds_to + " += " + expression->text.formula +
                         "\n\nOne section per formula, as many as needed.\n\n" + expression_help();
  EffectInfo info = expression->info;
  EffectEntry entry = expression->entry;

  Example() {
    info.equation = equation;
    info.source = "the user; grammar of muParser 2.3, derivatives by dual numbers (exact)";
    info.cannot =
        "memory, random numbers, delays; at kinks the derivative is that of one side. On a linear axis "
        "names end in _N, _m in place of _Nm, _rad";
    info.reveals = "residuals of a fit over the signal that the formula is meant for, before and after";
    info.visible = "depends on the formula: compare the fit's residual with and without it";
    info.claims = kDissipative | kOdd;
    info.plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.0, .to_s = 2.0};
    entry.info = &info;
  }
};

}  // namespace

const EffectEntry& effect_expression() {
  static const Example kExample;
  return kExample.entry;
}

}  // namespace omnihil
