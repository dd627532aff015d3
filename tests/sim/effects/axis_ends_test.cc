// Inputs that have nothing to do with one another, one after another in the same drive.
#include <gtest/gtest.h>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

void expect_same(const AxisSample<double>& a, const AxisSample<double>& b) {
  EXPECT_EQ(a.position_rad, b.position_rad);
  EXPECT_EQ(a.velocity_rad_s, b.velocity_rad_s);
  EXPECT_EQ(a.motor_current_A, b.motor_current_A);
  EXPECT_EQ(a.load_torque_Nm, b.load_torque_Nm);
  EXPECT_EQ(a.winding_rise_K, b.winding_rise_K);
  EXPECT_EQ(a.bus_voltage_V, b.bus_voltage_V);
  EXPECT_EQ(a.held, b.held);
}

// Laws that remember: commands, bristles, heat, readings that are late, a spring behind which the output swings.
TEST(VisitAxisEnds, NothingIsLeftOfTheInputBefore) {
  std::vector<EffectUse> uses;
  for (const char* id :
       {"actuator_delay", "lugre_friction", "winding_heating", "sampling_delay", "battery_sag"})
    uses.push_back(typical_use(*find_effect(id)));
  std::vector<AxisInput> inputs = {excite(Excitation::kSteps, 0.8, 0.3), held(CommandKind::kDuty, 0.1, 0.05),
                                   held(CommandKind::kDuty, 0.0, 0.05),
                                   excite(Excitation::kSteps, -0.5, 0.2)};
  inputs[1].initial_velocity_rad_s = 20.0;
  inputs[2].imposed_velocity_rad_s.assign(inputs[2].time_s.size(), 5.0);
  inputs[3].bus_voltage_V.assign(inputs[3].time_s.size(), 11.0);
  for (const bool springs : {false, true}) {
    if (springs) uses.push_back(typical_use(*find_effect("shaft_compliance")));
    std::size_t seen = 0;
    visit_axis_ends<double>(
        small_drive(), with(uses), inputs.size(),
        [&](std::size_t n) -> const AxisInput& { return inputs[n]; }, {},
        [&](std::size_t n, const AxisSample<double>& last) {
          SCOPED_TRACE(n);
          expect_same(last, run_axis(small_drive(), with(uses), inputs[n]).back());
          ++seen;
        });
    EXPECT_EQ(seen, inputs.size());
  }
}

TEST(VisitAxis, HandsOverEverySampleInOrder) {
  const AxisInput in = excite(Excitation::kSteps, 0.8, 0.1);
  const auto all = run_axis(small_drive(), nothing(), in);
  std::size_t next = 0;
  visit_axis<double>(small_drive(), nothing(), in, {}, [&](std::size_t k, const AxisSample<double>& sample) {
    ASSERT_EQ(k, next++);
    expect_same(sample, all[k]);
  });
  EXPECT_EQ(next, in.time_s.size());
}

}  // namespace
}  // namespace omnihil::test
