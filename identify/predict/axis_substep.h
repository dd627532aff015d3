// Electrical sub-step of an axis: as long as its error stays small beside the noise of what is compared.
//
//   AxisSubstep substep(nominal, setups, 100e-6, error);
//   run_axis<double>(params, law, setups[run].input, {.step_s = substep.of(candidate, run)});
//
// Law: of the longest step, its half, its quarter …, the first whose error against a quarter of it stays below 7 %
// of the noise sigma in the trial runs (0.5 % of the error energy, a sixth of what an effect has to take to be
// named: DECISIONS 42). The base model is tried at its nominal values; a law that is faster than a millisecond
// (kStiff) or changes within a sample (kFine), and in steps of more than a millisecond every law, at its typical size, and with
// all strengths, then each shape, at a quarter and at four times that, when a model first has it.
// A spring softer than those sizes has a slower mode: its steps grow with the root of its compliance.
// Cannot: see an error that only sizes far from these have, or that only comes after the trial's seconds; vary
// the step within a run. A law with impacts has no order of convergence: it takes the shortest step.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "identify/predict/axis_setup.h"
#include "identify/predict/candidate.h"

namespace omnihil {

// Is there an effect with this numerical property (NumericsBit) that is not neutral? A neutral one changes no bit.
bool acts(const Candidate& candidate, std::uint32_t numerics);

class AxisSubstep {
 public:
  // Of `model` in a run: the rms change of its signals from step h to h / 4, over their noise sigma; NaN: no
  // trial run.
  using Error = std::function<double(const Candidate& model, int run, double step_s)>;

  AxisSubstep() = default;
  AxisSubstep(const Candidate& nominal, const std::vector<AxisSetup>& setups, double shortest_s,
              const Error& error);

  double of(const Candidate& candidate, int run) const;  // s

 private:
  double longest_step(const std::vector<Candidate>& models, double longest_s) const;
  double step_of(const EffectEntry& entry, int run) const;

  // Filled as laws are asked for: most uses of a predictor see a few of them.
  struct Measured {
    std::mutex mutex;
    std::map<const EffectEntry*, double> step_s;  // before coarser_
  };

  Candidate nominal_;
  Error error_;
  std::shared_ptr<Measured> measured_ = std::make_shared<Measured>();
  double shortest_s_ = 100e-6;
  double base_s_ = 100e-6;
  std::vector<double> coarser_;  // per run, times the step
};

}  // namespace omnihil
