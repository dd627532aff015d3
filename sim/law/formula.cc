#include "sim/law/formula.h"

#include <fmt/format.h>
#include <muParserBase.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <numbers>

#include "sim/law/spelling.h"

namespace omnihil {
namespace {

struct Function {
  std::string_view name;
  int arguments;
  FormulaOp op;
};

constexpr Function kFunctions[] = {
    {"sin", 1, FormulaOp::kSin},     {"cos", 1, FormulaOp::kCos},     {"tan", 1, FormulaOp::kTan},
    {"asin", 1, FormulaOp::kAsin},   {"acos", 1, FormulaOp::kAcos},   {"atan", 1, FormulaOp::kAtan},
    {"sinh", 1, FormulaOp::kSinh},   {"cosh", 1, FormulaOp::kCosh},   {"tanh", 1, FormulaOp::kTanh},
    {"exp", 1, FormulaOp::kExp},     {"ln", 1, FormulaOp::kLn},       {"log10", 1, FormulaOp::kLog10},
    {"sqrt", 1, FormulaOp::kSqrt},   {"abs", 1, FormulaOp::kAbs},     {"sign", 1, FormulaOp::kSign},
    {"atan2", 2, FormulaOp::kAtan2}, {"hypot", 2, FormulaOp::kHypot}, {"min", 2, FormulaOp::kMin},
    {"max", 2, FormulaOp::kMax},
};
constexpr std::string_view kPi = "pi";

// muParser calls these once while it reads; what a formula gives is computed by Formula::value.
double unused1(void*, double a) { return a; }
double unused2(void*, double a, double) { return a; }
double negate(double a) { return -a; }

class Reader : public mu::ParserBase {
 public:
  Reader() {
    InitCharSets();
    InitFun();
    InitConst();
    InitOprt();
    EnableOptimizer(false);  // so that only plain operations come
  }

 private:
  void InitCharSets() override {
    DefineNameChars("0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    DefineOprtChars("-+*^/?<>=!&|:");
    DefineInfixOprtChars("-+");
  }
  void InitFun() override {
    for (const Function& f : kFunctions) {
      void* mark = const_cast<Function*>(&f);
      if (f.arguments == 1) {
        DefineFunUserData(std::string(f.name), unused1, mark, false);
      } else {
        DefineFunUserData(std::string(f.name), unused2, mark, false);
      }
    }
    AddValIdent(read_number);
  }
  void InitConst() override { DefineConst(std::string(kPi), std::numbers::pi); }
  void InitOprt() override { DefineInfixOprt("-", negate, mu::prINFIX, false); }

  static int read_number(const char* text, int* read, double* value) {
    char* end = nullptr;
    const bool starts = std::isdigit(static_cast<unsigned char>(*text)) || *text == '.';
    if (!starts) return 0;
    *value = std::strtod(text, &end);
    *read += static_cast<int>(end - text);
    return end == text ? 0 : 1;
  }
};

std::string_view say(mu::EErrorCodes code) {
  switch (code) {
    case mu::ecUNEXPECTED_OPERATOR:
      return "an operator where a value is needed";
    case mu::ecUNEXPECTED_EOF:
      return "the formula ends too early";
    case mu::ecUNEXPECTED_ARG_SEP:
      return "a comma outside a function's arguments";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
      return "an operator is missing before it";
    case mu::ecUNEXPECTED_PARENS:
      return "a bracket that does not belong here";
    case mu::ecMISSING_PARENS:
      return "a bracket is not closed";
    case mu::ecTOO_MANY_PARAMS:
      return "too many arguments";
    case mu::ecTOO_FEW_PARAMS:
      return "too few arguments";
    case mu::ecEMPTY_EXPRESSION:
      return "the formula is empty";
    case mu::ecMISSING_ELSE_CLAUSE:
      return "a ? without its :";
    case mu::ecMISPLACED_COLON:
      return "a : without its ?";
    default:
      return "cannot be read";
  }
}

}  // namespace

class FormulaCompiler {
 public:
  FormulaCompiler(const std::string& text, std::span<const std::string> variables,
                  std::vector<FormulaFault>& faults)
      : text_(text), names_(variables), faults_(faults), values_(variables.size(), 1.0) {}

  std::optional<Formula> compile() {
    const std::size_t before = faults_.size();
    check_names();
    if (faults_.size() > before) return std::nullopt;
    try {
      Reader reader;
      for (std::size_t i = 0; i < names_.size(); ++i) reader.DefineVar(names_[i], &values_[i]);
      reader.SetExpr(text_);
      reader.Eval();
      if (reader.GetNumResults() != 1) fault(0, "", "gives more than one number", "one formula, no comma");
      translate(reader.GetByteCode());
    } catch (const mu::ParserError& e) {
      const int last = static_cast<int>(text_.size());
      const int at = e.GetPos() < 0 ? 0 : std::min(e.GetPos(), last);
      fault(at, e.GetToken(), std::string(say(e.GetCode())), "");
    }
    if (faults_.size() > before) return std::nullopt;
    return formula_;
  }

 private:
  void fault(int position, std::string found, std::string what, std::string allowed) {
    faults_.push_back({position, std::move(found), std::move(what), std::move(allowed)});
  }

  // Every name that is no signal, parameter, function or constant; muParser would stop at the first.
  void check_names() {
    const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t i = 0; i < text_.size();) {
      if (digit(text_[i]) || (text_[i] == '.' && i + 1 < text_.size() && digit(text_[i + 1]))) {
        char* end = nullptr;
        std::strtod(text_.c_str() + i, &end);
        i = std::max(i + 1, static_cast<std::size_t>(end - text_.c_str()));
      } else if (letter(text_[i])) {
        std::size_t end = i;
        while (end < text_.size() && (letter(text_[end]) || digit(text_[end]))) ++end;
        check_name(i, text_.substr(i, end - i));
        i = end;
      } else {
        ++i;
      }
    }
  }

  void check_name(std::size_t position, const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) {
      const int number = static_cast<int>(found - names_.begin());
      auto& used = formula_.variables_;
      if (std::find(used.begin(), used.end(), number) == used.end()) used.push_back(number);
      return;
    }
    std::vector<std::string_view> known(names_.begin(), names_.end());
    known.insert(known.end(), formula_functions().begin(), formula_functions().end());
    known.push_back(kPi);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string_view near = nearest_spelling(name, known);
    fault(static_cast<int>(position), name, "no such signal, parameter or function",
          near.empty() ? "`omnihil effects expression` lists the signals"
                       : fmt::format("did you mean \"{}\"?", near));
  }

  void translate(const mu::ParserByteCode& code) {
    if (code.GetMaxStackSize() + 1 > Formula::kMostDepth) {
      return fault(0, "", "is nested too deeply", fmt::format("at most {} levels", Formula::kMostDepth));
    }
    const mu::SToken* tokens = code.GetBase();
    for (std::size_t n = 0; n < code.GetSize() && tokens[n].Cmd != mu::cmEND; ++n) {
      translate(tokens[n]);
    }
  }

  void translate(const mu::SToken& t) {
    static constexpr struct {
      mu::ECmdCode code;
      FormulaOp op;
    } kBinary[] = {
        {mu::cmADD, FormulaOp::kAdd},         {mu::cmSUB, FormulaOp::kSubtract},
        {mu::cmMUL, FormulaOp::kMultiply},    {mu::cmDIV, FormulaOp::kDivide},
        {mu::cmPOW, FormulaOp::kPower},       {mu::cmLT, FormulaOp::kLess},
        {mu::cmLE, FormulaOp::kLessEqual},    {mu::cmGT, FormulaOp::kGreater},
        {mu::cmGE, FormulaOp::kGreaterEqual}, {mu::cmEQ, FormulaOp::kEqual},
        {mu::cmNEQ, FormulaOp::kNotEqual},    {mu::cmLAND, FormulaOp::kAnd},
        {mu::cmLOR, FormulaOp::kOr},
    };
    for (const auto& b : kBinary) {
      if (t.Cmd == b.code) return step(b.op);
    }
    switch (t.Cmd) {
      case mu::cmVAL:
        return step(FormulaOp::kNumber, 0, t.Val.data2);
      case mu::cmVAR:
        return step(FormulaOp::kVariable, static_cast<int>(t.Val.ptr - values_.data()));
      case mu::cmIF:
        return step(FormulaOp::kSkipIfZero, t.Oprt.offset);
      case mu::cmELSE:
        return step(FormulaOp::kSkip, t.Oprt.offset);
      case mu::cmENDIF:
        return step(FormulaOp::kSkip, 0);
      case mu::cmFUNC:
        if (t.Fun.cb._pUserData != nullptr)
          return step(static_cast<const Function*>(t.Fun.cb._pUserData)->op);
        return step(FormulaOp::kNegate);  // the one function without a mark
      default:
        return fault(0, "", "holds something that a formula may not", "no assignment, no text");
    }
  }

  void step(FormulaOp op, int index = 0, double number = 0.0) {
    formula_.steps_.push_back({op, index, number});
  }

  const std::string& text_;
  std::span<const std::string> names_;
  std::vector<FormulaFault>& faults_;
  std::vector<double> values_;
  Formula formula_;
};

std::optional<Formula> compile_formula(const std::string& text, std::span<const std::string> variables,
                                       std::vector<FormulaFault>& faults) {
  return FormulaCompiler(text, variables, faults).compile();
}

std::span<const std::string_view> formula_functions() {
  static const auto kNames = [] {
    std::array<std::string_view, std::size(kFunctions)> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFunctions[i].name;
    return names;
  }();
  return kNames;
}

bool is_formula_name(std::string_view name) {
  const auto fits = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 || name == kPi) return false;
  if (!std::all_of(name.begin(), name.end(), fits)) return false;
  const auto functions = formula_functions();
  return std::find(functions.begin(), functions.end(), name) == functions.end();
}

}  // namespace omnihil
