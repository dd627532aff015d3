// The settings that a screening tries: pairs of sine and cosine for a phase, orders from motor and data, sizes that show.
#include "identify/select/effect_variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/identify/linear_predictor.h"

namespace omnihil {
namespace {

const EffectEntry& cogging() { return *find_effect("cogging"); }
std::size_t row_of(const EffectEntry& e, std::string_view name) {
  return static_cast<std::size_t>(find_param(*e.info, name));
}

std::set<double> orders(const std::vector<EffectVariant>& variants) {
  std::set<double> out;
  for (const EffectVariant& v : variants) out.insert(v.shape.values[row_of(cogging(), "order")]);
  return out;
}

// A sin(x + p) = A cos p sin x + A sin p cos x: coefficients (3, 4) are an amplitude of 5 at atan2(4, 3).
TEST(EffectVariants, APhaseIsAPairOfSineAndCosine) {
  const Candidate model = axis_with_unknown_friction();
  const std::vector<EffectVariant> variants = variants_of(cogging(), model, {});
  ASSERT_EQ(variants.front().columns.size(), 2u);
  const EffectUse start = start_of(variants.front(), {3.0, 4.0}, model);
  const double size = variants.front().columns[0].size;
  EXPECT_DOUBLE_EQ(start.values[row_of(cogging(), "amplitude_Nm")], 5.0 * size);
  EXPECT_DOUBLE_EQ(start.values[row_of(cogging(), "phase_rad")], std::atan2(4.0, 3.0));
  const EffectUse sine = setting(variants.front(), variants.front().columns[0]),
                  cosine = setting(variants.front(), variants.front().columns[1]);
  EXPECT_DOUBLE_EQ(
      cosine.values[row_of(cogging(), "phase_rad")] - sine.values[row_of(cogging(), "phase_rad")],
      M_PI / 2.0);
}

// 14 poles and 12 slots: lcm 84, the slots, the poles, six per electrical turn 42.
TEST(EffectVariants, OrdersOfCoggingAreThoseOfTheMotorWhereTheDataShowNone) {
  const std::set<double> tried = orders(variants_of(cogging(), axis_with_unknown_friction(), {}));
  for (const double order : {84.0, 12.0, 14.0, 42.0}) EXPECT_EQ(tried.count(order), 1u) << order;
}

TEST(EffectVariants, OrdersOfCoggingAreThoseThatStandOutWhereTheyDo) {
  const std::set<double> tried =
      orders(variants_of(cogging(), axis_with_unknown_friction(), {.orders = {31.0, 7.0}}));
  EXPECT_EQ(tried.count(31.0), 1u);
  EXPECT_EQ(tried.count(7.0), 1u);
  EXPECT_EQ(tried.count(12.0), 0u);
}

// A spring is tried from a gear's 313 Hz down to a long arm's 7 Hz, each with the same loss: c d^2 is the same.
TEST(EffectVariants, ASoftSpringIsTriedWithTheSameLoss) {
  const EffectEntry& spring = *find_effect("shaft_compliance");
  std::vector<double> compliances, losses;
  for (const EffectVariant& v : variants_of(spring, axis_with_unknown_friction(), {})) {
    compliances.push_back(v.columns.front().size);
    losses.push_back(v.columns.front().size *
                     std::pow(v.shape.values[row_of(spring, "damping_Nm_s_per_rad")], 2));
  }
  ASSERT_GE(compliances.size(), 6u);
  const auto [stiffest, softest] = std::minmax_element(compliances.begin(), compliances.end());
  EXPECT_GT(*softest / *stiffest, std::pow(313.0 / 8.0, 2));
  for (const double loss : losses) EXPECT_NEAR(loss / losses.front(), 1.0, 1e-9);
}

// 12 and 84 have the common divisor 12: harmonics 1 and 7 of it.
TEST(EffectVariants, SeveralOrdersAtOnceAreHarmonicsOfTheirCommonDivisor) {
  const std::vector<EffectVariant> series =
      series_variants(cogging(), axis_with_unknown_friction(), {.orders = {84.0, 12.0}});
  ASSERT_EQ(series.size(), 1u);
  EXPECT_EQ(series[0].shape.values[row_of(cogging(), "order")], 12.0);
  std::set<std::string_view> raised;
  for (const VariantColumn& c : series[0].columns)
    raised.insert(cogging().info->params[static_cast<std::size_t>(c.row)].name);
  EXPECT_EQ(raised, (std::set<std::string_view>{"amplitude_Nm", "amplitude_7"}));
  EXPECT_TRUE(series_variants(cogging(), axis_with_unknown_friction(), {.orders = {84.0}}).empty());
  EXPECT_TRUE(series_variants(cogging(), axis_with_unknown_friction(), {.orders = {31.0, 37.0}})
                  .empty());  // divisor 1
}

TEST(EffectVariants, EveryEffectIsTriedWithinItsBoundsAndAwayFromNeutral) {
  const Candidate model = axis_with_unknown_friction();
  for (const EffectEntry* entry : all_effects()) {
    if (entry->info->id == "expression") continue;
    const std::vector<EffectVariant> variants =
        variants_of(*entry, model, {.top_speed_rad_s = 300.0, .top_current_A = 10.0, .duration_s = 10.0});
    ASSERT_FALSE(variants.empty()) << entry->info->id;
    for (const EffectVariant& v : variants) {
      for (const VariantColumn& c : v.columns) {
        const EffectUse use = setting(v, c);
        EXPECT_FALSE(is_neutral(use)) << entry->info->id;
        for (std::size_t i = 0; i < use.values.size(); ++i) {
          const EffectParam& row = entry->info->params[i];
          EXPECT_GE(use.values[i], row.lower) << entry->info->id << "." << row.name;
          EXPECT_LE(use.values[i], row.upper) << entry->info->id << "." << row.name;
        }
      }
    }
  }
}

TEST(EffectVariants, AStartStaysWithinTheBounds) {
  const std::vector<EffectVariant> variants =
      variants_of(*find_effect("constant_load"), axis_with_unknown_friction(), {});
  EXPECT_EQ(start_of(variants.front(), {1e9}, axis_with_unknown_friction()).values[0],
            find_effect("constant_load")->info->params[0].upper);
}

TEST(WithUse, ReplacesTheEffectOfTheSameNameAndKeepsTheOrder) {
  Candidate model = axis_with_unknown_friction();
  for (const char* id : {"quadratic_drag", "cogging", "constant_load", "cogging"})
    model = with_use(model, neutral_use(*find_effect(id)));
  std::vector<std::string> names;
  for (const EffectUse& use : model.effects) names.push_back(effect_name(use));
  EXPECT_EQ(names, (std::vector<std::string>{"cogging", "constant_load", "quadratic_drag"}));
}

}  // namespace
}  // namespace omnihil
