#include "sim/law/expression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/model/effect_reader.h"
#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr char kDrag[] =
    "[effects.expression.fan]\n"
    "adds_to = \"torque_Nm\"\n"
    "formula = \"-a*omega_rotor_rad_s*abs(omega_rotor_rad_s)\"\n"
    "a = { value = 2e-7, lower = 0, upper = 1e-5, unit = \"N m s2/rad2\" }\n";

struct Reading {
  std::vector<EffectUse> uses;
  std::vector<ModelProblem> problems;
};

Reading read(const std::string& text, bool linear = false) {
  Reading r;
  const auto document = parse_document(text, "bench.toml", r.problems);
  if (document) r.uses = read_effects(*document, {.linear = linear}, r.problems);
  return r;
}

Formula compiled(const std::string& text, const std::vector<std::string>& names) {
  std::vector<FormulaFault> faults;
  auto f = compile_formula(text, names, faults);
  EXPECT_TRUE(f.has_value()) << text;
  return f ? *f : Formula();
}

double number(const std::string& text, double x = 0.0) {
  return compiled(text, {"x"}).value<double>([&](int) { return x; });
}

TEST(Formula, KnowsTheOrderOfOperations) {
  EXPECT_DOUBLE_EQ(number("1+2*3^2"), 19.0);
  EXPECT_DOUBLE_EQ(number("-x^2", 3.0), -9.0);
  EXPECT_DOUBLE_EQ(number("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(number("2^3^2"), 512.0);
  EXPECT_DOUBLE_EQ(number("7-4-2"), 1.0);
  EXPECT_DOUBLE_EQ(number("8/4/2"), 1.0);
  EXPECT_DOUBLE_EQ(number("1.5e2+.5"), 150.5);
  EXPECT_DOUBLE_EQ(number("2*pi"), 2.0 * M_PI);
}

TEST(Formula, KnowsConditionsWithinConditions) {
  const std::string text = "(x > 0 ? (x > 5 ? 1 : 2) : 3) + 10";
  EXPECT_DOUBLE_EQ(number(text, 6.0), 11.0);
  EXPECT_DOUBLE_EQ(number(text, 1.0), 12.0);
  EXPECT_DOUBLE_EQ(number(text, -1.0), 13.0);
  EXPECT_DOUBLE_EQ(number("x >= 1 && x <= 2 || x == 5", 1.5), 1.0);
  EXPECT_DOUBLE_EQ(number("x >= 1 && x <= 2 || x == 5", 3.0), 0.0);
  EXPECT_DOUBLE_EQ(number("x != 3", 3.0), 0.0);
}

TEST(Formula, HasExactDerivativesOfAllItsFunctions) {
  for (const std::string_view name : formula_functions()) {
    const bool two = name == "atan2" || name == "hypot" || name == "min" || name == "max";
    const std::string text = std::string(name) + (two ? "(x, 0.4)" : "(x)") + "*x^2.5/(1+x)";
    const Formula f = compiled(text, {"x"});
    for (const double x : {0.2, 0.7}) {
      const auto at = [&](double y) { return f.value<double>([&](int) { return y; }); };
      const Jet jet = f.value<Jet>([&](int) { return Jet(x, 0); });
      EXPECT_NEAR(jet.v[0], (at(x + 1e-6) - at(x - 1e-6)) / 2e-6, 1e-7) << text;
      EXPECT_DOUBLE_EQ(jet.a, at(x)) << text;
    }
  }
}

TEST(Formula, NamesThePositionOfEveryUnknownName) {
  std::vector<FormulaFault> faults;
  const std::vector<std::string> names{"omega_rotor_rad_s", "a"};
  EXPECT_FALSE(compile_formula("-a*omega_roto_rad_s + zzzzzz", names, faults));
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].position, 3);
  EXPECT_EQ(faults[0].found, "omega_roto_rad_s");
  EXPECT_EQ(faults[0].allowed, "did you mean \"omega_rotor_rad_s\"?");
  EXPECT_EQ(faults[1].position, 22);
}

TEST(Formula, RefusesWhatIsNoFormula) {
  for (const char* text : {"", "a*", "(a", "a)", "a a", "sin(a,a)", "min(a)", "a=3", "a,a", "a ? a", "3a",
                           "\"a\"", "a : a", "a $ a", "()", "sin"}) {
    std::vector<FormulaFault> faults;
    EXPECT_FALSE(compile_formula(text, std::vector<std::string>{"a"}, faults)) << text;
    EXPECT_EQ(faults.size(), 1u) << text;
  }
}

// tau = -2e-7 * 100 * 100.
TEST(Expression, AddsItsFormula) {
  const Reading r = read(kDrag);
  ASSERT_EQ(r.uses.size(), 1u);
  const EffectUse& use = r.uses[0];
  EXPECT_EQ(use.name, "fan");
  EXPECT_EQ(use.entry->info->place, Place::kTorque);
  TorquePort<double> port;
  port.omega_rotor_rad_s = -100.0;
  use.entry->simulate.torque(use.entry->context, use.values.data(), nullptr, port);
  EXPECT_DOUBLE_EQ(port.tau_Nm, 2e-3);
}

TEST(Expression, IsAbsentAtNeutral) {
  EffectUse use = read(kDrag).uses.at(0);
  EXPECT_FALSE(is_neutral(use));
  use.values[0] = 0.0;
  EXPECT_TRUE(is_neutral(use));
  EXPECT_TRUE(with({use}).none());
}

TEST(Expression, OutlivesTheUsesThatASetWasMadeOf) {
  const EffectSet<double> set = with(read(kDrag).uses);
  const auto out = run_axis(small_drive(), set, held(CommandKind::kDuty, 0.5, 0.5));
  EXPECT_LT(out.back().omega_rotor_rad_s, 230.0);
}

// Signature: settled, k i = b omega + a omega^2: what the current does not explain is the formula.
TEST(Expression, ShowsAsItsFormulaOverTheSpeed) {
  const DriveParams<double> p = small_drive();
  const auto set = with(read(kDrag).uses);
  for (const double duty : {0.2, 0.5, -0.9}) {
    const auto s = run_axis(p, set, held(CommandKind::kDuty, duty, 3.0)).back();
    const double w = s.omega_rotor_rad_s;
    EXPECT_NEAR(p.torque_constant_Nm_per_A * s.motor_current_A - p.viscous_friction_Nm_s_per_rad * w,
                2e-7 * w * std::abs(w), 1e-9);
  }
}

// Inverse dynamics has to solve for the motor's torque only where the formula looks at it.
TEST(Expression, SaysWhetherItReadsTheMotorsTorque) {
  const auto reads = [](const std::string& target, const std::string& formula, bool linear) {
    const Reading r = read("[effects.expression.x]\nadds_to = \"" + target + "\"\nformula = \"" + formula +
                               "\"\na = { value = 0.1, lower = -1.0, upper = 1.0 }\n",
                           linear);
    for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
    return EffectSet<double>(r.uses).reads_motor_torque();
  };
  EXPECT_TRUE(reads("torque_Nm", "-a*abs(tau_motor_Nm)", false));
  EXPECT_FALSE(reads("torque_Nm", "-a*omega_rotor_rad_s", false));
  EXPECT_TRUE(reads("torque_N", "-a*abs(tau_motor_N)", true));
  EXPECT_FALSE(reads("torque_N", "-a*omega_rotor_m_s", true));
}

// A parameter of a formula is fitted like any other: the whole response has its derivative.
TEST(Expression, HasAnExactDerivativeOfTheWholeResponse) {
  const AxisInput in = excite(Excitation::kSteps, 0.6, 1.0);
  EffectUse use = read(kDrag).uses.at(0);
  const double a = use.values[0];
  const auto at = [&](double value) {
    use.values[0] = value;
    return run_axis(small_drive(), with({use}), in);
  };
  const auto up = at(a + 1e-10), down = at(a - 1e-10);
  const std::vector<Jet> unknown{Jet(a, 0)};
  const auto jets =
      run_axis(drive_params_as<Jet>(small_drive()), EffectSet<Jet>(std::vector{use}, unknown), in);
  for (std::size_t n = 100; n < up.size(); n += 100) {
    const double slope = (up[n].omega_rotor_rad_s - down[n].omega_rotor_rad_s) / 2e-10;
    EXPECT_NEAR(jets[n].omega_rotor_rad_s.v[0], slope, 1e-4 * std::abs(slope) + 1.0);
  }
}

TEST(Expression, FindsWhatTurnsItOff) {
  const auto roles = [](const std::string& formula, const std::string& params) {
    const Reading r =
        read("[effects.expression.x]\nadds_to = \"torque_Nm\"\nformula = \"" + formula + "\"\n" + params);
    std::string found;
    for (const EffectParam& row : r.uses.at(0).entry->info->params) {
      found += std::string(row.name) + (row.role == ParamRole::kStrength ? "! " : " ");
    }
    return found;
  };
  const std::string a = "a = { value = 1, lower = 0, upper = 2 }\n";
  const std::string b = "b = { value = 1, lower = 0, upper = 2 }\n";
  const std::string positive_b = "b = { value = 1, lower = 0.1, upper = 2 }\n";
  EXPECT_EQ(roles("-a*sign(omega_rotor_rad_s)*exp(-(omega_rotor_rad_s/b)^2)", a + positive_b), "a! b ");
  EXPECT_EQ(roles("-a*omega_rotor_rad_s - b*omega_rotor_rad_s^3", a + b), "a! b! ");
  EXPECT_EQ(roles("a*sin(b*theta_rotor_rad)", a + b), "a! b ");
  EXPECT_EQ(roles("0.01*cos(theta_rotor_rad + b)", b), "b share! ");
  EXPECT_EQ(roles("-1e-6*omega_rotor_rad_s", ""), "share! ");
}

TEST(Expression, ActsWhereItsTargetIs) {
  const auto place = [](const std::string& target, const std::string& formula) {
    return read("[effects.expression.x]\nadds_to = \"" + target + "\"\nformula = \"" + formula + "\"\n")
        .uses.at(0)
        .entry->info->place;
  };
  EXPECT_EQ(place("voltage_V", "-0.1*current_A"), Place::kBridge);
  EXPECT_EQ(place("bus_voltage_V", "-0.1*bus_current_A"), Place::kSupply);
  EXPECT_EQ(place("force_x_N", "-0.1*v_forward_m_s"), Place::kBody);
  EXPECT_EQ(place("force_lateral_N", "-0.1*v_lateral_m_s"), Place::kContact);
  EXPECT_EQ(place("resistance_ohm", "0.001*temperature_rise_K"), Place::kWinding);
  EXPECT_EQ(place("encoder_angle_rad", "0.01*sin(theta_rotor_rad)"), Place::kSensor);
}

TEST(Expression, HoldsTheRotorAsAFrictionLevel) {
  DriveParams<double> p = small_drive();
  const auto set = with(read("[effects.expression.seal]\nadds_to = \"friction_torque_Nm\"\nformula = \"c\"\n"
                             "c = { value = 0.005, lower = 0, upper = 0.1, unit = \"N m\" }\n")
                            .uses);
  const double k = p.torque_constant_Nm_per_A;
  EXPECT_TRUE(run_axis(p, set, held(CommandKind::kMotorCurrent, 0.0049 / k, 0.1)).back().held);
  EXPECT_FALSE(run_axis(p, set, held(CommandKind::kMotorCurrent, 0.0051 / k, 0.1)).back().held);
}

TEST(Expression, AllowsSeveralAndWritesThemBack) {
  const std::string text =
      std::string(kDrag) +
      "\n[effects.expression.seal]\nadds_to = \"voltage_V\"\nformula = \"-r*current_A\"\n"
      "r = { value = 0.1, lower = 0, upper = 1, unit = \"ohm\", tolerance = 0.2 }\n";
  const Reading first = read(text);
  ASSERT_EQ(first.uses.size(), 2u);
  const Reading again = read(write_effects(first.uses, false));
  EXPECT_TRUE(again.problems.empty());
  ASSERT_EQ(again.uses.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.uses[i].name, first.uses[i].name);
    EXPECT_EQ(again.uses[i].values, first.uses[i].values);
    EXPECT_EQ(again.uses[i].tolerances, first.uses[i].tolerances);
    EXPECT_EQ(expression_of(again.uses[i])->text.formula, expression_of(first.uses[i])->text.formula);
  }
}

TEST(Expression, SaysWhereInFileAndFormulaSomethingIsWrong) {
  const Reading r = read(
      "[effects.expression.fan]\n"
      "adds_to = \"torque_Nm\"\n"
      "formula = \"-a*omega_roto_rad_s*b\"\n"
      "a = { value = 2e-7, lower = 0, upper = 1e-5 }\n");
  ASSERT_EQ(r.problems.size(), 2u);
  EXPECT_TRUE(r.uses.empty());
  EXPECT_EQ(r.problems[0].line, 3);
  EXPECT_EQ(r.problems[0].column, 15);  // formula = "-a*o: the o is the 15th character
  EXPECT_NE(r.problems[0].text().find("bench.toml:3:15: effects.expression.fan.formula"), std::string::npos);
  EXPECT_NE(r.problems[0].text().find("position 4, \"omega_roto_rad_s\": no such signal"), std::string::npos);
  EXPECT_NE(r.problems[0].text().find("did you mean \"omega_rotor_rad_s\"?"), std::string::npos);
  EXPECT_NE(r.problems[1].text().find("position 21, \"b\""), std::string::npos);
}

TEST(Expression, RefusesBadSectionsWithAllProblemsAtOnce) {
  const Reading r = read(
      "[effects.expression.one]\nadds_to = \"torque_N_m\"\nformula = \"1\"\n"
      "[effects.expression.two]\nadds_to = \"torque_Nm\"\n"
      "[effects.expression.three]\nadds_to = \"torque_Nm\"\nformula = \"a*tau_load_Nm\"\n"
      "a = { value = 3, lower = 0, upper = 1 }\nb = { value = 0, lower = 0, upper = 1 }\n"
      "[effects.expression.four]\nadds_to = \"torque_Nm\"\nformula = \"a*(tau_load_Nm\"\na = 1\n"
      "[effects.expression.five]\nadds_to = \"torque_Nm\"\nformula = \"a\"\na = { value = 1, lower = 2, "
      "upper = 1 }\n"
      "sin = { value = 1, lower = 2, upper = 1 }\n");
  std::string all;
  for (const ModelProblem& p : r.problems) all += p.text() + "\n";
  EXPECT_NE(all.find("did you mean \"torque_Nm\"?"), std::string::npos) << all;
  EXPECT_NE(all.find("effects.expression.two.formula: is missing"), std::string::npos) << all;
  EXPECT_NE(all.find("effects.expression.three.a = 3: is out of range; allowed: 0 to 1"), std::string::npos)
      << all;
  EXPECT_NE(all.find("effects.expression.three.b"), std::string::npos) << all;
  EXPECT_NE(all.find("write { value = "), std::string::npos) << all;
  EXPECT_NE(all.find("lower bound that is not below"), std::string::npos) << all;
  EXPECT_NE(all.find("effects.expression.five.sin: cannot be a parameter's name"), std::string::npos) << all;
  EXPECT_TRUE(r.uses.empty());
}

TEST(Expression, IsChangedOnACommandLine) {
  std::vector<EffectUse> uses = read(kDrag).uses;
  EXPECT_EQ(add_override("expression.fan.a=5e-7", {}, uses), "");
  EXPECT_EQ(uses[0].values[0], 5e-7);
  EXPECT_NE(add_override("expression.fun.a=5e-7", {}, uses).find("did you mean \"fan\"?"), std::string::npos);
  EXPECT_NE(add_override("expression.fan.b=5e-7", {}, uses), "");
  EXPECT_NE(add_override("expression.fan.a=1", {}, uses).find("out of range"), std::string::npos);
}

TEST(Expression, HasForcesAndMetresOnALinearAxis) {
  const Reading r = read(
      "[effects.expression.fan]\nadds_to = \"torque_N\"\nformula = \"-a*omega_rotor_m_s\"\n"
      "a = { value = 1, lower = 0, upper = 5, unit = \"N s/m\" }\n",
      true);
  ASSERT_EQ(r.problems.size(), 0u) << r.problems[0].text();
  EXPECT_EQ(r.uses.size(), 1u);
}

TEST(Expression, TellsWhatAFormulaMayUse) {
  const std::string help(find_effect("expression")->info->equation);
  for (const char* text :
       {"torque_Nm [N m]", "voltage_V [V]", "force_x_N [N]", "omega_rotor_rad_s [rad/s]", "tanh"}) {
    EXPECT_NE(help.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace omnihil::test
