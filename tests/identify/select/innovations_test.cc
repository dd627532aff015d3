// A fast effect beside a slow structure that no law explains.
#include "identify/select/innovations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/select/diagnosis.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// Slow turning of the stand under the drive, as no law of the catalogue has it: 0.3 rad at 0.8 Hz, another phase each run.
constexpr double kSway_rad = 0.3, kSway_Hz = 0.8;

Bench swaying_bench(std::vector<std::string> hidden) {
  BenchRecipe recipe;
  recipe.with = std::move(hidden);
  recipe.excitations = {Excitation::kSteps, Excitation::kPrbs, Excitation::kSteps};
  recipe.duration_s = 5.0;
  Bench bench = simulated_bench(recipe);
  double phase = 0.0;
  for (Run& run : bench.dataset.runs) {
    phase += 2.0;
    std::vector<double>& counts = run.signals.at("encoder");
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double turn = kSway_rad * std::sin(2.0 * std::numbers::pi * kSway_Hz * run.time_s[k] + phase);
      counts[k] += std::round(turn * recipe.counts_per_turn / (2.0 * std::numbers::pi));
    }
  }
  return bench;
}

Diagnosis diagnosed(const Bench& bench) {
  DiagnoseOptions options;
  options.jobs = 2;
  return diagnose(bench.dataset, bench.nominal, options);
}

TEST(SlowInnovationsTest, NameAnEccentricityBesideASway) {
  const Diagnosis d = diagnosed(swaying_bench({"encoder_eccentricity.amplitude_rad=0.004"}));
  EXPECT_EQ(d.effects, std::vector<std::string>{"encoder_eccentricity"});
  EXPECT_EQ(d.outcome, Outcome::kMoreRemains);
}

TEST(SlowInnovationsTest, NameNothingWhereNothingButTheSwayIsThere) {
  const Diagnosis d = diagnosed(swaying_bench({}));
  EXPECT_EQ(d.effects, std::vector<std::string>{});
}

TEST(SlowInnovationsTest, ShowWhatThePlainResidualHides) {
  const Bench bench =
      swaying_bench({"encoder_eccentricity.amplitude_rad=0.004", "encoder_eccentricity.phase_rad=1"});
  const PreparedSelection selection(bench.dataset, bench.nominal, {.seed = 1, .jobs = 2});
  const Iteration plain = selection_iteration(selection.task, selection.context.base());
  const Innovations view(selection.task, selection.context.base());
  const std::vector<Screened> screened = view.screened(plain.screened);
  const auto share = [&](const std::vector<Screened>& of, const char* name) {
    return std::ranges::find(of, name, &Screened::name)->share;
  };
  EXPECT_GT(share(screened, "encoder_eccentricity"), 10.0 * share(plain.screened, "encoder_eccentricity"));
  for (const Screened& s : screened) EXPECT_LE(s.share, share(screened, "encoder_eccentricity")) << s.name;
}

}  // namespace
}  // namespace omnihil
