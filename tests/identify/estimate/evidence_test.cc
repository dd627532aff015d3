#include "identify/estimate/evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/random.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {
namespace {

constexpr int kSamples = 40000;

Eigen::VectorXd white(double sigma, std::uint64_t stream) {
  Eigen::VectorXd out(kSamples);
  for (int i = 0; i < kSamples; ++i) out[i] = sigma * gaussian(1, stream, static_cast<std::uint64_t>(i));
  return out;
}

struct Runs : ZeroRuns {
  Runs() : ZeroRuns({Split::kTraining, Split::kValidation}, kSamples) {}
};

// AR(1), x' = phi x + e: rho(k) = phi^k, tau = (1 + phi) / (1 - phi). The estimate's standard error is about
// tau sqrt(2 (2 W + 1) / n), W = 5 tau (Sokal 1997).
TEST(EvidenceTest, AutocorrelationTimeOfAFirstOrderProcess) {
  const Runs runs;
  Eigen::VectorXd x = white(1.0, 3);
  EXPECT_NEAR(autocorrelation_time(runs.training, x, 0), 1.0, 0.1);
  for (const double phi : {0.5, 0.8, 0.98}) {
    x = white(1.0, 4);
    for (int i = 1; i < kSamples; ++i) x[i] += phi * x[i - 1];
    const double tau = (1.0 + phi) / (1.0 - phi);
    EXPECT_NEAR(autocorrelation_time(runs.training, x, 0), tau, 3.0 * tau * std::sqrt(20.0 * tau / kSamples))
        << phi;
  }
}

// White residuals: n log(ratio) + k log n.
TEST(EvidenceTest, BicOfWhiteResidualsIsSchwarzs) {
  const Runs runs;
  const Eigen::VectorXd parent = white(1.0, 5), child = std::sqrt(0.9) * parent;
  const double n = kSamples / autocorrelation_time(runs.training, child, 0);
  const Evidence e = evidence_of(runs.training, {parent, child}, runs.validation, {parent, child}, 2);
  EXPECT_NEAR(e.delta_bic, n * std::log(0.9) + 2.0 * std::log(n), 1e-6 * n);
  EXPECT_LT(evidence_of(runs.training, {parent, parent}, runs.validation, {parent, parent}, 2).delta_elpd,
            1e-9);
  EXPECT_GT(evidence_of(runs.training, {parent, parent}, runs.validation, {parent, parent}, 2).delta_bic,
            0.0);
}

// A child whose held-out residual is the parent's predicts no better, however well it fits: with variances 1 and 0.5 of
// the fit runs, 0.5 n (1 - 2 + log 2) per n independent samples.
TEST(EvidenceTest, ElpdPunishesAnOverfittedVariance) {
  const Runs runs;
  const Eigen::VectorXd parent = white(1.0, 6), child = std::sqrt(0.5) * parent, held = white(1.0, 7);
  const Evidence e = evidence_of(runs.training, {parent, child}, runs.validation, {held, held}, 1);
  const double n = kSamples / autocorrelation_time(runs.validation, held, 0);
  EXPECT_NEAR(e.delta_elpd, 0.5 * n * (1.0 - 2.0 + std::log(2.0)), 0.02 * n);
  EXPECT_LT(e.delta_elpd, -2.0 * e.delta_elpd_se);
}

TEST(EvidenceTest, ADivergedRunGivesNone) {
  const Runs runs;
  const Eigen::VectorXd parent = white(1.0, 8), none;
  EXPECT_EQ(evidence_of(runs.training, {parent, none}, runs.validation, {parent, none}, 1).delta_bic, 0.0);
}

}  // namespace
}  // namespace omnihil
