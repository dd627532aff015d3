// The ids of the effects: they stand in model files, recordings and reports, and so are fixed for good.
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "sim/law/effect_registry.h"
#include "sim/model/model_rows.h"

namespace omnihil {
namespace {

constexpr std::string_view kIds[] = {"back_emf_missing",
                                     "coulomb_friction",
                                     "stribeck_friction",
                                     "lugre_friction",
                                     "friction_asymmetry",
                                     "load_dependent_friction",
                                     "gear_efficiency",
                                     "quadratic_drag",
                                     "grease_drag",
                                     "coast_mode",
                                     "cogging",
                                     "torque_ripple",
                                     "winding_heating",
                                     "magnet_weakening",
                                     "saturation",
                                     "dead_time",
                                     "pwm_dead_band",
                                     "battery_sag",
                                     "current_limit",
                                     "duty_limit",
                                     "target_speed_limit",
                                     "actuator_delay",
                                     "winding_inductance",
                                     "backlash",
                                     "shaft_compliance",
                                     "encoder_eccentricity",
                                     "encoder_missed_counts",
                                     "sampling_delay",
                                     "sample_jitter",
                                     "hall_speed_estimator",
                                     "commutation_misalignment",
                                     "gravity_load",
                                     "imbalance",
                                     "constant_load",
                                     "thermal_derating",
                                     "wheel_slip",
                                     "lateral_roller_friction",
                                     "roller_ripple",
                                     "rolling_resistance",
                                     "center_of_mass_offset",
                                     "payload",
                                     "floor_tilt",
                                     "wheel_radius_mismatch",
                                     "motor_mismatch",
                                     "dribbler_drag",
                                     "vision_delay",
                                     "hall_speed_period",
                                     "command_low_pass",
                                     "command_rate_limit",
                                     "speed_low_pass",
                                     "current_low_pass",
                                     "expression"};

TEST(EffectIds, EveryIdThatFilesMayNameIsThere) {
  for (const std::string_view id : kIds) EXPECT_NE(find_effect(id), nullptr) << id;
}

TEST(EffectIds, NoIdIsThereThatIsNotInThisList) {
  for (const EffectEntry* entry : all_effects()) {
    EXPECT_NE(std::find(std::begin(kIds), std::end(kIds), entry->info->id), std::end(kIds))
        << entry->info->id;
  }
}

TEST(EffectIds, ModelFilesMayNameExactlyTheEffectsThereAre) {
  EXPECT_EQ(effect_names().size(), all_effects().size());
}

}  // namespace
}  // namespace omnihil
