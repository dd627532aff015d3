// A dataset as far as the first iteration of a selection: base fitted, null simulated, its task.
//
//   PreparedSelection bench(dataset, nominal, {.seed = 1, .jobs = 2});
//   Iteration first = selection_iteration(bench.task, bench.context.base());
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "identify/select/selection_context.h"

namespace omnihil {

struct PreparedSelection {
  PreparedSelection(const Dataset& dataset, const Candidate& nominal, const SelectionOptions& options)
      : context(dataset, nominal, options) {
    EXPECT_TRUE(context.fit_base([] { return false; }));
    context.simulate();
    task = context.task(not_applicable);
  }

  SelectionContext context;
  std::vector<std::string> not_applicable;
  SelectionTask task;
};

}  // namespace omnihil
