// What a judgement needs beside the models: evidence of a fake predictor's runs, a null of a hundredth of
// energy, bootstraps.
//
//   fake.add(Use::kFit, …);  FakeEvidence evidence(fake);   judge(evidence.context, parent, child, "cogging",
//   100);
#pragma once
#include <memory>
#include <vector>

#include "identify/select/acceptance.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {

struct FakeEvidence {
  SignalKinds kinds;
  std::unique_ptr<Splits> splits;
  NullModel null;
  std::vector<BlockBootstrap> bootstrap;
  AcceptanceContext context;

  explicit FakeEvidence(const FakePredictor& fake) : kinds(signal_kinds(fake)) {
    splits = std::make_unique<Splits>(Splits{Evidence(fake, kinds, Use::kFit),
                                             Evidence(fake, kinds, Use::kHoldout),
                                             Evidence(fake, kinds, Use::kExtrapolation)});
    for (std::size_t u = 0; u < kUses; ++u) {
      null.mean_square[u] = Eigen::MatrixXd::Constant(2, kinds.count(), 0.01);
      bootstrap.emplace_back((*splits)[u], 1);
    }
    context = {
        .splits = splits.get(), .null = &null, .bootstrap = {&bootstrap[0], &bootstrap[1], &bootstrap[2]}};
  }
  FakeEvidence(const FakeEvidence&) = delete;  // the context points into it
  FakeEvidence& operator=(const FakeEvidence&) = delete;
};

}  // namespace omnihil
