// The cost at a point: predicted once however often it is asked for, its derivatives too, and that by one unknown.
#include "identify/estimate/fit_problem.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/effect_registry.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {
namespace {

// One run of four samples; sample k of the prediction is the sum over unknowns u of (k + 1)^u x_u. Counts its predictions.
class Polynomial : public FakePredictor {
 public:
  explicit Polynomial(std::vector<Unknown> unknowns) : unknowns_(std::move(unknowns)) {
    add(Split::kTraining, {0.3, -1.0, 2.0, 0.5}, {0.0, 0.0, 0.0, 0.0});
  }
  Prediction predict(const Candidate& c, int) const override {
    ++predicted;
    return made(c, {});
  }
  Prediction predict_with_derivatives(const Candidate& c, std::span<const Unknown> by, int) const override {
    ++derived;
    return made(c, by);
  }

  bool is_costly() const override { return true; }

  mutable int predicted = 0, derived = 0;

 private:
  static double power(int sample, std::size_t unknown) {
    return std::pow(sample + 1.0, static_cast<double>(unknown));
  }
  Prediction made(const Candidate& c, std::span<const Unknown> by) const {
    Prediction out;
    out.values.emplace_back(4, 0.0);
    if (!by.empty())
      out.derivatives.push_back(Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(by.size())));
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      for (int k = 0; k < 4; ++k) {
        out.values[0][static_cast<std::size_t>(k)] += power(k, u) * *value_at(c, unknowns_[u].path);
        for (std::size_t j = 0; j < by.size(); ++j) {
          if (by[j].path == unknowns_[u].path)
            out.derivatives[0](k, static_cast<Eigen::Index>(j)) = power(k, u);
        }
      }
    }
    return out;
  }
  std::vector<Unknown> unknowns_;
};

struct Problem {
  Problem() {
    candidate.effects.push_back(typical_use(*find_effect("cogging")));
    unknowns = unknowns_of(candidate);
    x.resize(static_cast<Eigen::Index>(unknowns.size()));
    for (std::size_t u = 0; u < unknowns.size(); ++u) x[static_cast<Eigen::Index>(u)] = unknowns[u].start;
  }
  Candidate candidate;
  std::vector<Unknown> unknowns;
  Eigen::VectorXd x;
};

TEST(FitProblem, PredictsAPointOnceHoweverOftenItIsAskedFor) {
  Problem given;
  const Polynomial predictor(given.unknowns);
  FitProblem problem(predictor, given.candidate, given.unknowns, 1);
  ASSERT_TRUE(problem.reweigh(given.x));
  const double cost = problem.at(given.x, false).cost();
  const double noise_cost = problem.noise_cost(given.x);
  EXPECT_EQ(predictor.predicted, 1);
  Eigen::VectorXd other = given.x;
  other[0] *= 1.01;
  EXPECT_NE(problem.at(other, false).cost(), cost);
  EXPECT_EQ(predictor.predicted, 2);
  EXPECT_EQ(problem.at(given.x, false).cost(), cost);  // neither forgotten nor taken for the other
  EXPECT_EQ(problem.noise_cost(given.x), noise_cost);
  EXPECT_EQ(predictor.predicted, 2);
}

TEST(FitProblem, DerivesAPointOnceHoweverItIsWeighed) {
  Problem given;
  const Polynomial predictor(given.unknowns);
  FitProblem problem(predictor, given.candidate, given.unknowns, 1);
  ASSERT_TRUE(problem.reweigh(given.x));
  const FitPoint before = problem.at(given.x, true);
  const int passes = predictor.derived;
  Eigen::VectorXd other = given.x;
  other[0] += 0.5 * given.unknowns[0].scale;
  ASSERT_TRUE(problem.reweigh(other));
  const FitPoint again = problem.at(given.x, true);
  EXPECT_EQ(predictor.derived, passes);
  EXPECT_NE(again.cost(), before.cost());  // by the other weights
  problem.at(other, true);
  EXPECT_EQ(predictor.derived, 2 * passes);
}

// Of a linear model derivatives are the same everywhere: what is taken for a point nearby has that point's own gradient.
TEST(FitProblem, NearbyItTakesTheDerivativesThatItHas) {
  Problem given;
  const Polynomial predictor(given.unknowns);
  FitProblem exact(predictor, given.candidate, given.unknowns, 1);
  FitProblem rough(predictor, given.candidate, given.unknowns, 1, false, true);
  ASSERT_TRUE(exact.reweigh(given.x));
  ASSERT_TRUE(rough.reweigh(given.x));
  rough.at(given.x, true);
  const int passes = predictor.derived;
  Eigen::VectorXd near = given.x, far = given.x;
  near[0] += 0.09 * given.unknowns[0].scale;
  far[0] += 0.11 * given.unknowns[0].scale;
  const FitPoint there = rough.at(near, true);
  EXPECT_EQ(predictor.derived, passes);
  const FitPoint own = exact.at(near, true);
  EXPECT_EQ(predictor.derived, 2 * passes);
  EXPECT_EQ(there.cost(), own.cost());
  EXPECT_EQ(there.gradient, own.gradient);
  rough.at(far, true);
  EXPECT_EQ(predictor.derived, 3 * passes);
}

// Weighed as the first was, and without the derivatives that the first takes for those of a point nearby.
TEST(FitProblem, OneBesideAnotherHasItsWeightsAndItsOwnDerivatives) {
  Problem given;
  const Polynomial predictor(given.unknowns);
  FitProblem problem(predictor, given.candidate, given.unknowns, 1, false, true);
  ASSERT_TRUE(problem.reweigh(given.x));
  problem.at(given.x, true);
  const int passes = predictor.derived;
  const std::unique_ptr<FitProblem> own = problem.beside();
  Eigen::VectorXd near = given.x;
  near[0] += 0.09 * given.unknowns[0].scale;
  const FitPoint first = problem.at(near, true);
  EXPECT_EQ(predictor.derived, passes);
  EXPECT_EQ(own->at(near, true).cost(), first.cost());
  EXPECT_EQ(predictor.derived, 2 * passes);
}

TEST(FitProblem, AlongOneUnknownIsItsPartOfAll) {
  Problem given;
  ASSERT_GE(given.unknowns.size(), 2u);
  const Polynomial predictor(given.unknowns);
  FitProblem problem(predictor, given.candidate, given.unknowns, 1);
  ASSERT_TRUE(problem.reweigh(given.x));
  const FitPoint all = problem.at(given.x, true);
  ASSERT_TRUE(all.finite);
  for (Eigen::Index u = 0; u < given.x.size(); ++u) {
    const FitPoint one = problem.along(given.x, u);
    ASSERT_EQ(one.gradient.size(), 1);
    EXPECT_EQ(one.gradient[0], all.gradient[u]) << u;
    EXPECT_DOUBLE_EQ(one.information(0, 0), all.information(u, u)) << u;
    EXPECT_EQ(one.cost(), all.cost());
  }
}

}  // namespace
}  // namespace omnihil
