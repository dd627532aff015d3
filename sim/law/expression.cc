#include "sim/law/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/law/expression_signals.h"
#include "sim/law/param_range.h"
#include "sim/law/random.h"
#include "sim/law/spelling.h"

namespace omnihil {
namespace {

// Calls visit.operator()<Port> for every place that a formula may act at, in the order in which a step meets
// them.
template <typename T, typename Visit>
void for_each_port(Visit visit) {
  visit.template operator()<CommandPort<T>>();
  visit.template operator()<SupplyPort<T>>();
  visit.template operator()<BridgePort<T>>();
  visit.template operator()<WindingPort<T>>();
  visit.template operator()<TorquePort<T>>();
  visit.template operator()<ContactPort<T>>();
  visit.template operator()<BodyPort<T>>();
  visit.template operator()<SensorPort<T>>();
}

// "torque_Nm", or "torque_N" on a linear axis.
std::string shown(std::string_view name, bool linear) {
  EffectParam row;
  row.name = name;
  return param_key(row, linear);
}

template <typename T, typename Port>
void apply_expression(const void* context, const T* p, T*, Port& port) {
  using Table = PortTable<Port>;
  const Expression& e = *static_cast<const Expression*>(context);
  const int params = static_cast<int>(e.text.params.size());
  T sum =
      e.formula.value<T>([&](int n) { return n < params ? p[n] : Table::kSignals[n - params].read(port); });
  if (e.shared) sum *= p[params];
  const auto& target = Table::kTargets[e.target];
  if (target.level && value_of(sum) <= 0.0) return;
  port.*target.field += sum;
  if (target.also != nullptr) port.*target.also += sum;
}

template <typename T>
ApplyFunctions<T> functions_at(Place place) {
  ApplyFunctions<T> f;
  const auto set = [&]<typename Port>(ApplyFunction<T, Port>& slot) {
    if (PortTable<Port>::kPlace == place) slot = apply_expression<T, Port>;
  };
  set(f.command);
  set(f.supply);
  set(f.bridge);
  set(f.winding);
  set(f.torque);
  set(f.contact);
  set(f.body);
  set(f.sensor);
  return f;
}

// Values at which a formula is tried: parameters within their bounds or, where `off`, zero.
double trial(const ExpressionText& text, const std::vector<bool>& off, int variable, std::uint64_t point) {
  const double part = uniform(point, 11, static_cast<std::uint64_t>(variable));
  const auto i = static_cast<std::size_t>(variable);
  if (i >= text.params.size()) return (2.0 * part - 1.0) * (point % 2 == 0 ? 1.0 : 100.0);
  return off[i] ? 0.0 : text.params[i].lower + part * (text.params[i].upper - text.params[i].lower);
}

bool vanishes(const Formula& formula, const ExpressionText& text, const std::vector<bool>& off) {
  bool seen = false;
  for (std::uint64_t point = 0; point < 64; ++point) {
    const double y = formula.value<double>([&](int n) { return trial(text, off, n, point); });
    if (!std::isfinite(y)) continue;
    if (y != 0.0) return false;
    seen = true;
  }
  return seen;
}

// The parameters that turn the formula off, see the header.
std::vector<bool> strengths_of(const Formula& formula, const ExpressionText& text) {
  std::vector<bool> off(text.params.size());
  for (std::size_t i = 0; i < off.size(); ++i) {
    off[i] = text.params[i].lower <= 0.0 && text.params[i].upper >= 0.0;
  }
  if (!vanishes(formula, text, off)) return std::vector<bool>(off.size(), false);
  const auto order = formula.variables();
  for (auto n = order.rbegin(); n != order.rend(); ++n) {
    const auto i = static_cast<std::size_t>(*n);
    if (i >= off.size() || !off[i]) continue;
    off[i] = false;
    if (!vanishes(formula, text, off)) off[i] = true;
  }
  return off;
}

void add_rows(Expression& e) {
  const std::vector<bool> strength = strengths_of(e.formula, e.text);
  e.shared = std::find(strength.begin(), strength.end(), true) == strength.end();
  for (std::size_t i = 0; i < strength.size(); ++i) {
    const ExpressionParam& p = e.text.params[i];
    EffectParam row{.name = p.name, .unit = p.unit, .what = "parameter of the formula", .how = "by a fit"};
    row.role = strength[i] ? ParamRole::kStrength : ParamRole::kShape;
    row.neutral = strength[i] ? 0.0 : kNoNeutral;
    row.typical = p.value;
    row.lower = p.lower;
    row.upper = p.upper;
    row.prior_scale = strength[i] ? 0.5 * (p.upper - p.lower) : 0.0;
    // A formula has no other way to say so: its parameter "phase…" is an angle that goes round.
    if (p.name.starts_with("phase")) row.trait = ParamTrait::kPeriodic;
    e.rows.push_back(row);
  }
  if (e.shared) {
    e.rows.push_back({.name = "share",
                      .unit = "1",
                      .typical = 1.0,
                      .lower = 0.0,
                      .upper = 1.0,
                      .prior_scale = 1.0,
                      .what = "multiplies the formula",
                      .how = "by a fit"});
  }
}

void describe(Expression& e, Place place) {
  e.info.id = "expression";
  e.info.title = "Formula of one's own";
  e.info.equation = e.text.formula;
  e.info.source = "the model file";
  e.info.cannot = "memory, random numbers, delays";
  e.info.place = place;
  e.info.target = e.text.adds_to;
  e.info.reveals = "whatever moves the signals in the formula";
  e.info.visible = "depends on the formula";
  e.info.rigs = place == Place::kContact || place == Place::kBody ? kOnRobot : kOnBoth;
  e.info.params = e.rows;
}

struct Choice {
  Place place = Place::kTorque;
  int target = -1;
  std::vector<std::string> names;  // parameters, then signals
  std::vector<std::string> targets;
};

Choice choose(const ExpressionText& text) {
  Choice c;
  for_each_port<double>([&]<typename Port>() {
    using Table = PortTable<Port>;
    for (std::size_t i = 0; i < std::size(Table::kTargets); ++i) {
      c.targets.push_back(shown(Table::kTargets[i].name, text.linear));
      if (c.targets.back() != text.adds_to) continue;
      c.place = Table::kPlace;
      c.target = static_cast<int>(i);
      for (const ExpressionParam& p : text.params) c.names.push_back(p.name);
      for (const auto& s : Table::kSignals) c.names.push_back(shown(s.name, text.linear));
    }
  });
  return c;
}

bool reads(const Expression& e, const Choice& c, std::string_view signal) {
  const auto used = e.formula.variables();
  return std::any_of(used.begin(), used.end(),
                     [&](int n) { return c.names[static_cast<std::size_t>(n)] == signal; });
}

}  // namespace

std::shared_ptr<const Expression> make_expression(ExpressionText text, std::vector<FormulaFault>& faults) {
  const Choice c = choose(text);
  if (c.target < 0) {
    const std::vector<std::string_view> known(c.targets.begin(), c.targets.end());
    const std::string_view near = nearest_spelling(text.adds_to, known);
    faults.push_back({-1, text.adds_to, "nothing of this name can be added to",
                      near.empty() ? fmt::format("allowed: {}", fmt::join(known, ", "))
                                   : fmt::format("did you mean \"{}\"?", near)});
    return nullptr;
  }
  auto formula = compile_formula(text.formula, c.names, faults);
  if (!formula) return nullptr;
  auto e = std::make_shared<Expression>();
  e->text = std::move(text);
  e->formula = std::move(*formula);
  e->target = c.target;
  add_rows(*e);
  describe(*e, c.place);
  if (reads(*e, c, "temperature_rise_K")) e->info.needs = "winding_heating";
  if (reads(*e, c, shown("tau_motor_Nm", e->text.linear))) e->info.numerics |= kReadsMotorTorque;
  if (c.place == Place::kBridge && reads(*e, c, "current_A")) e->info.numerics |= kReadsCurrent;
  e->entry.info = &e->info;
  e->entry.simulate = functions_at<double>(c.place);
  e->entry.differentiate = functions_at<Jet>(c.place);
  e->entry.context = e.get();
  return e;
}

EffectUse use_of_expression(std::shared_ptr<const Expression> expression) {
  EffectUse use = typical_use(expression->entry);
  use.name = expression->text.name;
  use.tolerances.resize(use.values.size());
  use.owner = std::move(expression);
  return use;
}

const Expression* expression_of(const EffectUse& use) {
  return is_formula(*use.entry->info) ? static_cast<const Expression*>(use.entry->context) : nullptr;
}

std::string override_expression(std::string_view text, std::vector<EffectUse>& uses) {
  const std::size_t equals = text.find('='), first = text.find('.'), last = text.rfind('.', equals);
  if (equals == std::string_view::npos || first == std::string_view::npos || last <= first) {
    return fmt::format("{}: write expression.NAME.parameter=value, with NAME in the model file", text);
  }
  const std::string_view name = text.substr(first + 1, last - first - 1);
  const std::string_view param = text.substr(last + 1, equals - last - 1), number = text.substr(equals + 1);
  std::vector<std::string_view> names;
  for (const EffectUse& use : uses) {
    if (expression_of(use) != nullptr) names.push_back(use.name);
  }
  const auto use = std::find_if(uses.begin(), uses.end(), [&](const EffectUse& u) {
    return expression_of(u) != nullptr && u.name == name;
  });
  const auto hint = [](std::string_view near) {
    return near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near);
  };
  if (use == uses.end()) {
    return fmt::format("{}: the model has no formula of this name{}", name,
                       hint(nearest_spelling(name, names)));
  }
  const auto rows = use->entry->info->params;
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const EffectParam& r) { return r.name == param; });
  if (row == rows.end()) {
    std::vector<std::string_view> known;
    for (const EffectParam& r : rows) known.push_back(r.name);
    return fmt::format("{}: {} has no such parameter{}", param, name, hint(nearest_spelling(param, known)));
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  const bool whole = error == std::errc() && end == number.data() + number.size();
  if (!whole || !(value >= row->lower && value <= row->upper)) {
    return fmt::format("{}: {}; allowed: {:g} to {:g} {}", text,
                       whole ? "is out of range" : "is not a number", row->lower, row->upper, row->unit);
  }
  use->values[static_cast<std::size_t>(row - rows.begin())] = value;
  return "";
}

std::string write_expression(const EffectUse& use) {
  const Expression& e = *expression_of(use);
  std::string out = fmt::format("\n[effects.expression.{}]\nadds_to = \"{}\"\nformula = \"{}\"\n",
                                e.text.name, e.text.adds_to, e.text.formula);
  for (std::size_t i = 0; i < use.values.size(); ++i) {
    const EffectParam& row = e.rows[i];
    out += fmt::format("{} = {{ value = {}, lower = {}, upper = {}, unit = \"{}\"", row.name, use.values[i],
                       row.lower, row.upper, row.unit);
    out += annotations_text(i < use.tolerances.size() ? use.tolerances[i] : std::nullopt,
                            i < use.notes.size() ? use.notes[i] : NumberNote{});
    out += " }\n";
  }
  return out;
}

std::string expression_help() {
  std::string out;
  for_each_port<double>([&]<typename Port>() {
    using Table = PortTable<Port>;
    std::string targets, signals;
    for (const auto& t : Table::kTargets) {
      targets += fmt::format("{}{} [{}]", targets.empty() ? "" : ", ", t.name, t.unit);
    }
    for (const auto& s : Table::kSignals) {
      signals += fmt::format("{}{} [{}]", signals.empty() ? "" : ", ", s.name, s.unit);
    }
    out += fmt::format("at {}:\n  adds_to: {}\n  reads:   {}\n", place_name(Table::kPlace), targets, signals);
  });
  out += fmt::format("functions: {}; constant: pi\n", fmt::join(formula_functions(), ", "));
  out += "operators: + - * / ^, comparisons (0 or 1), && ||, condition ? a : b";
  return out;
}

std::shared_ptr<const Expression> example_expression() {
  static const std::shared_ptr<const Expression> kExample = [] {
    std::vector<FormulaFault> faults;
    auto e = make_expression({.name = "example",
                              .adds_to = "torque_Nm",
                              .formula = "-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)",
                              .params = {{"a", "N m s2/rad2", 2e-8, 0.0, 1e-5}}},
                             faults);
    return e;
  }();
  return kExample;
}

}  // namespace omnihil
