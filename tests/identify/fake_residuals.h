// An acceptance test's context: residuals of a fake predictor's runs by split, a null of a hundredth of their
// energy, bootstraps.
//
//   fake.add(Split::kTraining, …);
//   FakeResiduals residuals(fake);     // residuals.context, residuals.splits, residuals.channels
#pragma once
#include <initializer_list>
#include <memory>
#include <vector>

#include "identify/select/acceptance.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {

struct FakeResiduals {
  ComparedChannels channels;
  std::unique_ptr<Splits> splits;
  NullModel null;
  std::vector<BlockBootstrap> bootstrap;
  AcceptanceContext context;

  explicit FakeResiduals(const FakePredictor& fake) : channels(compared_channels(fake)) {
    splits = std::make_unique<Splits>(Splits{WhitenedResiduals(fake, channels, Split::kTraining),
                                             WhitenedResiduals(fake, channels, Split::kValidation),
                                             WhitenedResiduals(fake, channels, Split::kExtrapolation)});
    for (std::size_t u = 0; u < kSplits; ++u) {
      null.mean_square[u] = Eigen::MatrixXd::Constant(2, channels.count(), 0.01);
      bootstrap.emplace_back((*splits)[u], 1);
    }
    context = {.splits = splits.get(),
               .null = &null,
               .channels = &channels,
               .bootstrap = {&bootstrap[kTraining], &bootstrap[kValidation], &bootstrap[kExtrapolation]}};
  }
  FakeResiduals(const FakeResiduals&) = delete;  // the context points into it
  FakeResiduals& operator=(const FakeResiduals&) = delete;
};

// Runs of zeros, one for each of `splits`: for tests that bring residuals of their own.
struct ZeroRuns {
  FakePredictor fake;
  FakeResiduals of;
  const WhitenedResiduals& training = (*of.splits)[kTraining];
  const WhitenedResiduals& validation = (*of.splits)[kValidation];

  ZeroRuns(std::initializer_list<Split> splits, std::size_t samples)
      : fake(zeros(splits, samples)), of(fake) {}

 private:
  static FakePredictor zeros(std::initializer_list<Split> splits, std::size_t samples) {
    FakePredictor out;
    for (const Split split : splits)
      out.add(split, std::vector<double>(samples, 0.0), std::vector<double>(samples, 0.0));
    return out;
  }
};

}  // namespace omnihil
