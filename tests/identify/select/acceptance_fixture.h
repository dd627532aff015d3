// Three runs of noise, one per use, and models that leave noise of given sizes: what the acceptance test decides on.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "identify/select/acceptance.h"
#include "sim/law/random.h"
#include "tests/identify/fake_residuals.h"

namespace omnihil {

inline constexpr int kSamples = 4000;

inline std::vector<double> noise_of(double sigma, std::uint64_t stream) {
  std::vector<double> out;
  for (int i = 0; i < kSamples; ++i)
    out.push_back(sigma * gaussian(1, stream, static_cast<std::uint64_t>(i)));
  return out;
}

// Runs of noise, one per use; residuals are made by the tests.
inline const FakePredictor& three_runs() {
  static const FakePredictor kRuns = [] {
    FakePredictor fake;
    for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
      fake.add(split, noise_of(1.0, 5), std::vector<double>(kSamples, 0.0));
    return fake;
  }();
  return kRuns;
}

struct AcceptanceFixture : FakeResiduals {
  AcceptanceFixture() : FakeResiduals(three_runs()) {}

  // A model that leaves noise of these sizes.
  Fitted leaving(double fit, double holdout, double extrapolation) const {
    Fitted out;
    out.finite = true;
    const std::array<double, kSplits> sizes{fit, holdout, extrapolation};
    for (std::size_t u = 0; u < kSplits; ++u) {
      const std::vector<double> r = noise_of(sizes[u], 7);
      out.residual[u] = Eigen::Map<const Eigen::VectorXd>(r.data(), kSamples);
      out.unweighted[u] = (*splits)[u].mean_square(out.residual[u]);
    }
    return out;
  }
};

}  // namespace omnihil
