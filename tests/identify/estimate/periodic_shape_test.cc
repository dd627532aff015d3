// A shape that goes round has no bound that means anything, whatever it is called: phase, direction.
#include <gtest/gtest.h>

#include <cmath>

#include "identify/estimate/fit.h"
#include "identify/estimate/fit_starts.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {
namespace {

// A record that says nothing of the effect, whose only numbers are the unknowns.
struct Silent {
  explicit Silent(std::string_view id) {
    EffectUse use = typical_use(*find_effect(id));
    candidate.effects.push_back(use);
    unknowns = unknowns_of(candidate);
    auto& run = fake.add(Split::kTraining, {1.0, -1.0, 1.0, -1.0}, {0.0, 0.0, 0.0, 0.0});
    run.prediction.derivatives.push_back(
        Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(unknowns.size())));
  }
  std::size_t place_of(const std::string& path) const {
    for (std::size_t n = 0; n < unknowns.size(); ++n) {
      if (unknowns[n].path == path) return n;
    }
    ADD_FAILURE() << path << " is no unknown";
    return 0;
  }

  Candidate candidate;
  std::vector<Unknown> unknowns;
  FakePredictor fake;
};

struct Periodic {
  const char* id;
  const char* path;
};

class PeriodicShape : public ::testing::TestWithParam<Periodic> {};

TEST_P(PeriodicShape, AtTheEndOfItsRangeIsAtNoBound) {
  Silent silent(GetParam().id);
  const std::size_t n = silent.place_of(GetParam().path);
  silent.unknowns[n].start = silent.unknowns[n].upper;
  const FitResult r = fit(silent.fake, silent.candidate, silent.unknowns, {});
  ASSERT_EQ(r.parameters[n].value, silent.unknowns[n].upper);
  EXPECT_FALSE(r.parameters[n].at_bound) << r.parameters[n].sentence;
}

// A quarter turn off is another effect: 1.5 rad of spread, wherever the start is (1-sigma, a choice).
TEST_P(PeriodicShape, IsDrawnAllRoundInFurtherStarts) {
  Silent silent(GetParam().id);
  const auto n = static_cast<Eigen::Index>(silent.place_of(GetParam().path));
  silent.unknowns[static_cast<std::size_t>(n)].start = 0.0;
  FitProblem problem(silent.fake, silent.candidate, silent.unknowns, 1);
  Eigen::VectorXd given(static_cast<Eigen::Index>(silent.unknowns.size()));
  for (std::size_t u = 0; u < silent.unknowns.size(); ++u)
    given[static_cast<Eigen::Index>(u)] = silent.unknowns[u].start;
  ASSERT_TRUE(problem.reweigh(given));
  constexpr int kSeeds = 400;
  double square = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::vector<Eigen::VectorXd> starts =
        fit_starts(problem, given, 2, static_cast<std::uint64_t>(seed));
    ASSERT_EQ(starts.size(), 2u);
    square += std::pow(starts[1][n], 2) / kSeeds;
  }
  // the mean of 400 squares of normal draws: 1-sigma sqrt(2 / 400) of the square
  EXPECT_NEAR(square, 1.5 * 1.5, 3.0 * std::sqrt(2.0 / kSeeds) * 1.5 * 1.5);
}

INSTANTIATE_TEST_SUITE_P(Each, PeriodicShape,
                         ::testing::Values(Periodic{"gravity_load", "gravity_load.phase_rad"},
                                           Periodic{"floor_tilt", "floor_tilt.direction_rad"}),
                         [](const auto& given) { return std::string(given.param.id); });

}  // namespace
}  // namespace omnihil
