// Where the rows lie too far apart to know the angle, laws of the angle are not tried.
#include "identify/select/angle_resolution.h"

#include <gtest/gtest.h>

#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

EffectUse typical(const char* id) { return typical_use(*find_effect(id)); }

// Two rows a millisecond apart, then two a second apart, of a gear of 3:1.
struct Scene {
  FakePredictor fake;
  Candidate model;

  Scene() {
    fake.add(Split::kTraining, {1, 1, 1, 1}, {0, 0, 0, 0}).track("time", "s", {0.0, 0.001, 1.001, 2.001});
    const AxisReading r = read_axis_model(
        "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = "
        "0.5\ntorque_constant_Nm_per_A = "
        "0.03\nrotor_inertia_kg_m2 = 1e-5\npole_pairs = 7\n[gear]\nratio = 3.0\n[supply]\nvoltage_V = 24\n",
        "model.toml", nullptr);
    EXPECT_TRUE(r.model);
    if (r.model) model = candidate_of(r.model->file, r.model->effects);
  }
  AngleDrift drift(double speed_error_rad_s) const {
    const ComparedChannels channels = compared_channels(fake);
    return angle_drift(WhitenedResiduals(fake, channels, Split::kTraining), model, speed_error_rad_s);
  }
};

TEST(AngleResolution, DriftIsTheSpeedsErrorTimesTheTimeBetweenRows) {
  const AngleDrift drift = Scene().drift(0.5);
  EXPECT_NEAR((drift.output_rad - Eigen::Vector4d(0, 0.0005, 0.5, 0.5)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((drift.rotor_rad - Eigen::Vector4d(0, 0.0015, 1.5, 1.5)).norm(), 0.0, 1e-12);
}

TEST(AngleResolution, APeriodIsLostWhereTheAngleIsOffByHalfOfIt) {
  EffectUse cogging = typical("cogging");
  cogging.values[1] = 2.0;  // order: half a period is pi / 2 of the rotor
  const Eigen::Vector4d signal(3, 1, 2, 2);
  EXPECT_DOUBLE_EQ(unresolved_share(cogging, Scene().drift(0.5), signal), 0.0)
      << "3 rad of a half period of pi";
  EXPECT_DOUBLE_EQ(unresolved_share(cogging, Scene().drift(0.6), signal), 8.0 / 18.0);
  EXPECT_DOUBLE_EQ(unresolved_share(cogging, Scene().drift(0.0), signal), 0.0) << "the angle is measured";
}

TEST(AngleResolution, LawsOfTheOutputsAngleHaveOnePeriodATurn) {
  const Eigen::Vector4d signal(3, 1, 2, 2);
  EXPECT_DOUBLE_EQ(unresolved_share(typical("gravity_load"), Scene().drift(3.0), signal), 0.0);
  EXPECT_DOUBLE_EQ(unresolved_share(typical("gravity_load"), Scene().drift(3.2), signal), 8.0 / 18.0);
}

TEST(AngleResolution, LawsWithoutAnAngleAreNeverUnresolved) {
  EXPECT_DOUBLE_EQ(
      unresolved_share(typical("coulomb_friction"), Scene().drift(100.0), Eigen::Vector4d(3, 1, 2, 2)), 0.0);
}

}  // namespace
}  // namespace omnihil
