// The map of validity: what lies in which cell, on a predictor whose answers are known.
#include "identify/compare/validity_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace omnihil {
namespace {

// Two runs, one to fit and one held out; "velocity" measured as zero, the model off by a step of the axes.
class Known : public Predictor {
 public:
  Known() {
    for (int r = 0; r < 2; ++r) {
      Run run;
      run.file = r == 0 ? "fit.csv" : "held.csv";
      run.split = r == 0 ? kTraining : kValidation;
      ComparedSignal s;
      s.name = "velocity";
      s.unit = "rad/s";
      RegimeTrack speed{"speed", "rad/s", {}}, current{"abs_current", "A", {}};
      for (int i = 0; i < kN; ++i) {
        s.time_s.push_back(0.001 * i);
        s.measured.push_back(i % 2 == 0 ? 1.0 : -1.0);
        speed.value.push_back(i % 120);        // 0 … 119: ten in each of twelve cells
        current.value.push_back(i / 120 % 8);  // 0 … 7
      }
      run.time_s = s.time_s;
      runs_.push_back(run);
      compared_.push_back({s});
      tracks_.push_back({speed, current, {"time", "s", s.time_s}});
    }
  }
  static constexpr int kN = 120 * 8 * 3;
  Method method() const override { return Method::kForward; }
  int run_count() const override { return 2; }
  const Run& run(int r) const override { return runs_[static_cast<std::size_t>(r)]; }
  const std::vector<ComparedSignal>& compared(int r) const override {
    return compared_[static_cast<std::size_t>(r)];
  }
  std::vector<RegimeTrack> regimes(const Candidate&, int r) const override {
    return tracks_[static_cast<std::size_t>(r)];
  }
  // The held-out run is off by 2 where the speed is at least 60, the fit run by 100 everywhere.
  Prediction predict(const Candidate&, int r) const override {
    Prediction p;
    p.values.resize(1);
    for (int i = 0; i < kN; ++i) {
      const double off = r == 0 ? 100.0 : i % 120 >= 60 ? 2.0 : 0.0;
      p.values[0].push_back(compared_[0][0].measured[static_cast<std::size_t>(i)] + off);
    }
    return p;
  }
  Prediction predict_with_derivatives(const Candidate& c, std::span<const Unknown>, int r) const override {
    return predict(c, r);
  }
  std::unique_ptr<Predictor> simulated(const Candidate&, std::uint64_t) const override { return nullptr; }
  Capabilities capabilities() const override { return {}; }

 private:
  std::vector<Run> runs_;
  std::vector<std::vector<ComparedSignal>> compared_;
  std::vector<std::vector<RegimeTrack>> tracks_;
};

class ValidityMaps : public ::testing::Test {
 protected:
  Known predictor_;
  Candidate candidate_;
  std::vector<Prediction> predictions_{predictor_.predict(candidate_, 0), predictor_.predict(candidate_, 1)};
};

TEST_F(ValidityMaps, SpeedAndCurrentAreTheAxesWhereThereAreBoth) {
  const auto axes = validity_axes(predictor_, candidate_);
  EXPECT_EQ(axes[0], "speed");
  EXPECT_EQ(axes[1], "abs_current");
}

TEST_F(ValidityMaps, EverySampleIsInACellOrCounted) {
  const ValidityMap map =
      validity_map(predictor_, candidate_, predictions_, "velocity", {"speed", "abs_current"});
  std::size_t in_cells = 0;
  for (const ValidityCell& cell : map.cells) in_cells += cell.fitted + cell.unseen;
  EXPECT_EQ(in_cells, map.samples);
  EXPECT_EQ(map.samples + map.outside, 2u * Known::kN);
  EXPECT_EQ(map.columns() * map.rows(), map.cells.size());
}

TEST_F(ValidityMaps, TheErrorIsThatOfUnseenRunsAlone) {
  const ValidityMap map =
      validity_map(predictor_, candidate_, predictions_, "velocity", {"speed", "abs_current"});
  for (std::size_t row = 0; row < map.rows(); ++row) {
    EXPECT_NEAR(map.at(1, row).rmse, 0.0, 1e-12);  // the fit run's 100 is not in it
    EXPECT_NEAR(map.at(map.columns() - 2, row).rmse, 2.0, 1e-12);
    EXPECT_NEAR(map.at(map.columns() - 2, row).bias, 2.0, 1e-12);
    EXPECT_GT(map.at(1, row).fitted, 0u);
  }
  EXPECT_NEAR(map.spread, 1.0, 1e-12);  // of +-1
}

TEST_F(ValidityMaps, AnUnknownAxisGivesNoCells) {
  EXPECT_TRUE(
      validity_map(predictor_, candidate_, predictions_, "velocity", {"speed", "luck"}).cells.empty());
  EXPECT_TRUE(
      validity_map(predictor_, candidate_, predictions_, "torque", {"speed", "abs_current"}).cells.empty());
}

TEST_F(ValidityMaps, ADivergedRunIsLeftOut) {
  predictions_[1].finite = false;
  const ValidityMap map =
      validity_map(predictor_, candidate_, predictions_, "velocity", {"speed", "abs_current"});
  EXPECT_EQ(map.samples + map.outside, static_cast<std::size_t>(Known::kN));
  for (const ValidityCell& cell : map.cells) EXPECT_EQ(cell.unseen, 0u);
}

}  // namespace
}  // namespace omnihil
