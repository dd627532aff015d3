// What every search works with, made once per dataset: predictor, evidence per use, fitted base model,
// simulated null, bootstrap.
//
//   Workbench bench(dataset, nominal, {.seed = 1, .jobs = 2});
//   bench.fit_base(stop);  bench.simulate();
//   Round r = addition_round(bench.search(), bench.base());
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "identify/select/addition_round.h"

namespace omnihil {

struct WorkbenchOptions {
  std::uint64_t seed = 1;
  int jobs = 1;
};

class Workbench {
 public:
  Workbench(const Dataset& dataset, const Candidate& nominal, const WorkbenchOptions& options);
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  const Predictor& predictor() const { return *predictor_; }
  const SignalKinds& kinds() const { return kinds_; }
  const Uses& uses() const { return uses_; }
  const Uses& seen() const { return seen_; }  // not whitened
  const NullModel& null() const { return null_; }
  const Fitted& base() const { return base_; }
  const Candidate& nominal() const { return nominal_; }

  // The numbers of a refit; `quick`: for rankings.
  RefitSetup setup(bool quick, const std::function<bool()>& stop) const;
  // False: no fit runs, or the model does not stay finite.
  bool fit_base(const std::function<bool()>& stop);
  // A better fit of the same model.
  void take_base(Fitted base) { base_ = std::move(base); }
  // After fit_base.
  void simulate();
  // After simulate; effects that cannot act here go to `not_applicable` with why.
  Search search(std::vector<std::string>& not_applicable) const;

 private:
  const Dataset& dataset_;
  const Candidate& nominal_;
  WorkbenchOptions options_;
  std::unique_ptr<Predictor> predictor_;
  SignalKinds kinds_;
  Uses uses_;
  Uses seen_;
  NullModel null_;
  std::vector<BlockBootstrap> bootstrap_;
  Fitted base_;
};

}  // namespace omnihil
