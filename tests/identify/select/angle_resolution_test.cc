// Where the rows lie too far apart to know the angle, laws of the angle are not tried; where nothing tells it, none is.
#include "identify/select/angle_resolution.h"

#include <gtest/gtest.h>

#include <limits>

#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"
#include "tests/identify/fake_residuals.h"
#include "tests/identify/simulated_robot.h"

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

constexpr double kLost = std::numeric_limits<double>::infinity();

TEST(AngleResolution, WithAnInfiniteErrorNoRowKnowsAnyPhase) {
  const AngleDrift lost = Scene().drift(kLost), late = Scene().drift(1000.0);
  for (const char* id : {"cogging", "torque_ripple", "roller_ripple", "imbalance", "gravity_load"}) {
    EXPECT_TRUE(is_never_resolved(*find_effect(id)->info, lost)) << id;
    EXPECT_DOUBLE_EQ(unresolved_share(typical(id), lost, Eigen::Vector4d(1, 0, 0, 0)), 1.0) << id;
    EXPECT_FALSE(is_never_resolved(*find_effect(id)->info, late)) << id << ": the first row begins the run";
  }
  // a direction in the field is no angle of the shaft
  for (const char* id : {"coulomb_friction", "floor_tilt"}) {
    EXPECT_FALSE(is_never_resolved(*find_effect(id)->info, lost)) << id;
    EXPECT_DOUBLE_EQ(unresolved_share(typical(id), lost, Eigen::Vector4d(3, 1, 2, 2)), 0.0) << id;
  }
}

TEST(AngleResolution, ByOrderOfTheShaftThatTheLawIsOf) {
  const Eigen::Vector4d signal(3, 1, 2, 2);
  // of a gear of 3:1, 1.1 rad of the output are more than half a turn of the rotor
  EXPECT_DOUBLE_EQ(unresolved_share(typical("imbalance"), Scene().drift(1.1), signal), 8.0 / 18.0);
  EXPECT_DOUBLE_EQ(unresolved_share(typical("gravity_load"), Scene().drift(1.1), signal), 0.0);
}

Dataset robot_without(std::string_view prefix) {
  Dataset d = test::blank_robot(0.1, true);
  std::erase_if(d.channels, [&](const Channel& c) { return c.signal.starts_with(prefix); });
  return d;
}

TEST(AngleSources, OfARobotOnlyEncodersTellTheWheelsAngles) {
  EXPECT_EQ(angle_source(robot_without("vision")), AngleSource::kSensor);
  EXPECT_EQ(angle_source(robot_without("encoder")), AngleSource::kNone);
  Dataset axis;
  axis.channels.resize(1);
  for (const auto& [signal, source] :
       {std::pair("velocity", AngleSource::kSpeed), std::pair("position", AngleSource::kSensor),
        std::pair("encoder", AngleSource::kSensor)}) {
    axis.channels[0].signal = signal;
    EXPECT_EQ(angle_source(axis), source) << signal;
  }
}

TEST(AngleSources, WhatNeedsEncodersSaysSo) {
  const auto said = [](const char* id, std::string_view without) {
    const Dataset d = robot_without(without);
    return why_not(*find_effect(id), *make_predictor(d, test::robot_candidate(), {}), d);
  };
  for (const char* id : {"cogging", "torque_ripple", "roller_ripple", "imbalance", "gravity_load"}) {
    EXPECT_EQ(said(id, "vision"), "") << id;
    EXPECT_EQ(said(id, "encoder"), "needs encoders: its phase is that of an angle") << id;
  }
  EXPECT_EQ(said("floor_tilt", "encoder"), "");
  EXPECT_EQ(said("coulomb_friction", "encoder"), "");
  EXPECT_EQ(said("vision_delay", "vision"), "needs a camera");
}

}  // namespace
}  // namespace omnihil
