// What every iteration of the selection uses, made once per dataset: predictor, whitened residuals per split,
// fitted base model, simulated null, bootstrap.
//
//   SelectionContext context(dataset, nominal, {.seed = 1, .jobs = 2});
//   context.fit_base(stop);  context.simulate();
//   Iteration iteration = selection_iteration(context.task(not_applicable), context.base());
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "identify/select/selection_iteration.h"

namespace omnihil {

struct SelectionOptions {
  std::uint64_t seed = 1;
  int jobs = 1;
};

class SelectionContext {
 public:
  SelectionContext(const Dataset& dataset, const Candidate& nominal, const SelectionOptions& options);
  SelectionContext(const SelectionContext&) = delete;
  SelectionContext& operator=(const SelectionContext&) = delete;

  const Predictor& predictor() const { return *predictor_; }
  const ComparedChannels& channels() const { return channels_; }
  const Splits& splits() const { return splits_; }
  const Splits& unweighted() const { return unweighted_; }  // in the channels' own units
  const NullModel& null() const { return null_; }
  const Fitted& base() const { return base_; }
  const Candidate& nominal() const { return nominal_; }

  // Options of a refit; coarse: for rankings, few iterations and a rough covariance.
  RefitSetup setup(bool coarse, const std::function<bool()>& stop) const;
  // False: no fit runs, or the model does not stay finite. `start`: where the base parameters ended elsewhere.
  bool fit_base(const std::function<bool()>& stop) { return fit_base(stop, nominal_); }
  bool fit_base(const std::function<bool()>& stop, const Candidate& start);
  // The base parameters' intervals, by their profiles. The search asks for none.
  void profile_base(const std::function<bool()>& stop);
  // A better fit of the same model.
  void take_base(Fitted base) { base_ = std::move(base); }
  // After fit_base.
  void simulate();
  // After simulate; effects that cannot act here go to `not_applicable` with why.
  SelectionTask task(std::vector<std::string>& not_applicable) const;

 private:
  const Dataset& dataset_;
  const Candidate& nominal_;
  SelectionOptions options_;
  std::unique_ptr<Predictor> predictor_;
  ComparedChannels channels_;
  Splits splits_;
  Splits unweighted_;
  NullModel null_;
  std::vector<BlockBootstrap> bootstrap_;
  Fitted base_;
};

}  // namespace omnihil
