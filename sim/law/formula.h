// A formula that a user wrote, compiled: values on both scalars, so its derivatives are exact.
//
//   std::vector<FormulaFault> faults;
//   const std::vector<std::string> variables = {"w", "a"};
//   const auto f = compile_formula("-a*w*abs(w)", variables, faults);
//   f->value<Jet>([&](int variable) { return variable == 0 ? Jet(3.0) : Jet(2.0, 0); });   // -18, d/da = -9
//
// muParser 2.3 reads the text (its grammar: + - * / ^, comparisons, && ||, c ? a : b, brackets) and puts it
// in order; the order is then run here, on doubles or dual numbers alike. Functions: formula_functions();
// constant: pi. Comparisons give 0 or 1. At kinks (abs, min, a condition) the derivative is that of one side.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/scalar.h"

namespace omnihil {

struct FormulaFault {
  int position = 0;   // of the character, counted from 0
  std::string found;  // what stands there; may be empty
  std::string what;   // "no such signal or parameter"
  std::string allowed;
};

enum class FormulaOp : std::uint8_t {
  kNumber,
  kVariable,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kSkipIfZero,  // `index` steps further when the top of the stack, which goes, is 0
  kSkip,
  kNegate,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kExp,
  kLn,
  kLog10,
  kSqrt,
  kAbs,
  kSign,
  kAtan2,
  kHypot,
  kMin,
  kMax,
};

class Formula {
 public:
  static constexpr int kMostDepth = 32;

  // `variable(n)` gives the value of variable n of the list it was compiled with.
  template <typename T, typename Variable>
  T value(Variable&& variable) const;
  // The numbers of the variables in it, in the order in which they first stand in the text.
  std::span<const int> variables() const { return variables_; }

 private:
  friend class FormulaCompiler;
  struct Step {
    FormulaOp op;
    int index;
    double number;
  };
  template <typename T>
  static void combine(FormulaOp op, T& a, const T& b);
  template <typename T>
  static void change(FormulaOp op, T& a);

  std::vector<Step> steps_;
  std::vector<int> variables_;
};

// Empty when there are faults: every unknown name at once, or else the first fault of grammar.
std::optional<Formula> compile_formula(const std::string& text, std::span<const std::string> variables,
                                       std::vector<FormulaFault>& faults);

std::span<const std::string_view> formula_functions();

// Letters, digits and underscores, no digit first, and no function's or constant's name.
bool is_formula_name(std::string_view name);

// ---------------------------------------------------------------------------------------------------------

template <typename T>
void Formula::combine(FormulaOp op, T& a, const T& b) {
  using std::atan2, std::hypot, std::pow;
  const double x = value_of(a), y = value_of(b);
  switch (op) {
    case FormulaOp::kAdd:
      a += b;
      return;
    case FormulaOp::kSubtract:
      a -= b;
      return;
    case FormulaOp::kMultiply:
      a *= b;
      return;
    case FormulaOp::kDivide:
      a /= b;
      return;
    case FormulaOp::kPower:
      a = is_exactly(b, y) ? T(pow(a, y)) : T(pow(a, b));
      return;
    case FormulaOp::kLess:
      a = T(x < y ? 1.0 : 0.0);
      return;
    case FormulaOp::kLessEqual:
      a = T(x <= y ? 1.0 : 0.0);
      return;
    case FormulaOp::kGreater:
      a = T(x > y ? 1.0 : 0.0);
      return;
    case FormulaOp::kGreaterEqual:
      a = T(x >= y ? 1.0 : 0.0);
      return;
    case FormulaOp::kEqual:
      a = T(x == y ? 1.0 : 0.0);
      return;
    case FormulaOp::kNotEqual:
      a = T(x != y ? 1.0 : 0.0);
      return;
    case FormulaOp::kAnd:
      a = T(x != 0.0 && y != 0.0 ? 1.0 : 0.0);
      return;
    case FormulaOp::kOr:
      a = T(x != 0.0 || y != 0.0 ? 1.0 : 0.0);
      return;
    case FormulaOp::kAtan2:
      a = atan2(a, b);
      return;
    case FormulaOp::kHypot:
      a = hypot(a, b);
      return;
    case FormulaOp::kMin:
      if (y < x) a = b;
      return;
    default:  // kMax
      if (y > x) a = b;
      return;
  }
}

template <typename T>
void Formula::change(FormulaOp op, T& a) {
  using std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::sinh, std::cosh, std::tanh,
      std::exp, std::log, std::log10, std::sqrt, std::abs;
  switch (op) {
    case FormulaOp::kNegate:
      a = -a;
      return;
    case FormulaOp::kSin:
      a = sin(a);
      return;
    case FormulaOp::kCos:
      a = cos(a);
      return;
    case FormulaOp::kTan:
      a = tan(a);
      return;
    case FormulaOp::kAsin:
      a = asin(a);
      return;
    case FormulaOp::kAcos:
      a = acos(a);
      return;
    case FormulaOp::kAtan:
      a = atan(a);
      return;
    case FormulaOp::kSinh:
      a = sinh(a);
      return;
    case FormulaOp::kCosh:
      a = cosh(a);
      return;
    case FormulaOp::kTanh:
      a = tanh(a);
      return;
    case FormulaOp::kExp:
      a = exp(a);
      return;
    case FormulaOp::kLn:
      a = log(a);
      return;
    case FormulaOp::kLog10:
      a = log10(a);
      return;
    case FormulaOp::kSqrt:
      // the slope at 0 is infinite; none is taken instead, so that a start from rest has a derivative
      a = value_of(a) == 0.0 ? T(0) : T(sqrt(a));
      return;
    case FormulaOp::kAbs:
      a = abs(a);
      return;
    default:  // kSign
      a = T(sign_of(a));
      return;
  }
}

template <typename T, typename Variable>
T Formula::value(Variable&& variable) const {
  T stack[kMostDepth];
  int depth = -1;
  const int count = static_cast<int>(steps_.size());
  for (int n = 0; n < count; ++n) {
    const Step& s = steps_[static_cast<std::size_t>(n)];
    if (s.op == FormulaOp::kNumber) {
      stack[++depth] = T(s.number);
    } else if (s.op == FormulaOp::kVariable) {
      stack[++depth] = variable(s.index);
    } else if (s.op == FormulaOp::kSkip ||
               (s.op == FormulaOp::kSkipIfZero && value_of(stack[depth--]) == 0.0)) {
      n += s.index;
    } else if (s.op >= FormulaOp::kNegate && s.op <= FormulaOp::kSign) {
      change(s.op, stack[depth]);
    } else if (s.op != FormulaOp::kSkipIfZero) {
      --depth;
      combine(s.op, stack[depth], stack[depth + 1]);
    }
  }
  return stack[depth];
}

}  // namespace omnihil
