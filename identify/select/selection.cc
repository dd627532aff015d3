#include "identify/select/selection.h"

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kSameGain = 0.03;   // of the best one's gain: within it two gains are one
constexpr double kTwinGain = 0.12;   // so near, an effect may be meant instead, if it is known to be confused
constexpr double kPerNumber = 0.01;  // of the gain
constexpr double kLeastLeft = 0.002;  // of what was above the floor: less is left by chance
constexpr double kFloorError = 0.05;  // of the floor, that the simulated null may be off
constexpr double kSameLeft = 1.15;    // what one leaves over what the best one leaves
constexpr double kTwinLeft = 1.5;
constexpr double kListedLeft =
    20.0;  // effects that are known to be confused: their forms differ from the truth's
constexpr double kConfoundedCosine = 0.98;  // cosine of signals that no refit can part
constexpr double kNothing = 0.01;           // gain below which a draw goes to "none"
constexpr double kLeastToPart =
    0.03;  // of the error energy: smaller gains are told apart as if they were this
constexpr double kUndecided =
    0.1;  // share of the bootstrap's draws that an effect wins: it may be meant instead
constexpr std::size_t kMostTwins = 3;

int numbers(const CandidateEffect& c) {
  int count = 0;
  for (const ParameterEstimate& p : c.fitted.fit.parameters) {
    if (p.path.starts_with(c.screened.name + ".")) ++count;
  }
  return count;
}

// What decides: held-out runs and fit runs alike; without held-out runs the latter.
double gain_of(const CandidateEffect& c, bool has_holdout) {
  const double fit = 1.0 - c.acceptance.fit.ratio;
  return has_holdout ? 0.5 * (fit + 1.0 - c.acceptance.holdout.ratio) : fit;
}

// The share of the sensors' noise in what that gain is counted of.
double floor_of(const CandidateEffect& c, bool has_holdout) {
  const double fit = c.acceptance.fit.floor;
  return has_holdout ? 0.5 * (fit + c.acceptance.holdout.floor) : fit;
}

void set_selection_frequencies(const SelectionTask& task, const Fitted& parent, Iteration& iteration) {
  const std::size_t split = (*task.splits)[kValidation].empty() ? kTraining : kValidation;
  const BlockBootstrap* bootstrap = task.acceptance_context.bootstrap[split];
  if (bootstrap == nullptr || bootstrap->empty() || iteration.candidates.empty()) return;
  std::vector<Eigen::VectorXd> draws;
  for (const CandidateEffect& c : iteration.candidates) {
    draws.emplace_back();
    if (!c.fitted.finite) continue;
    const Eigen::VectorXd &before = parent.residual[split], &after = c.fitted.residual[split];
    draws.back() =
        bootstrap->ratios(before, after, weights_for((*task.splits)[split], *task.null, before, after));
  }
  const Eigen::Index count = bootstrap->draws();
  // Where no gain decides, what lets a base parameter come back has the draws that go to "none" otherwise.
  const auto by = [&](bool belief) {
    return std::count_if(
        iteration.candidates.begin(), iteration.candidates.end(),
        [&](const CandidateEffect& c) { return c.acceptance.accepted && c.acceptance.by_prior == belief; });
  };
  if (by(false) == 0 && by(true) > 0) {
    for (CandidateEffect& c : iteration.candidates)
      c.probability = c.acceptance.accepted ? 1.0 / static_cast<double>(by(true)) : 0.0;
    return;
  }
  for (Eigen::Index d = 0; d < count; ++d) {
    double best = 1.0;
    for (const Eigen::VectorXd& r : draws) best = r.size() > 0 ? std::min(best, r[d]) : best;
    if (1.0 - best < kNothing) continue;
    std::vector<double> votes(draws.size(), 0.0);
    double all = 0.0;
    for (std::size_t c = 0; c < draws.size(); ++c) {
      if (draws[c].size() == 0 || draws[c][d] > best + kSameGain * (1.0 - best)) continue;
      votes[c] = 1.0;
      all += 1.0;
    }
    for (std::size_t c = 0; c < votes.size(); ++c) {
      // What failed the judgement may still be the truth, badly seen; its vote counts a fifth, the rest is
      // "none".
      const double worth = iteration.candidates[c].acceptance.accepted ? 1.0 : 0.2;
      iteration.candidates[c].probability += worth * votes[c] / all / static_cast<double>(count);
    }
  }
}

}  // namespace

double penalised_gain(const CandidateEffect& c, bool has_holdout) {
  const double gain = gain_of(c, has_holdout);
  return gain - kPerNumber * std::max(0, numbers(c) - 1) * std::abs(gain);
}

bool listed_as_confounded(const EffectInfo& a, const EffectInfo& b) {
  return std::find(a.twins.begin(), a.twins.end(), b.id) != a.twins.end() ||
         std::find(b.twins.begin(), b.twins.end(), a.id) != b.twins.end();
}

double cosine_similarity(const Screened& a, const Screened& b) {
  if (a.signal.size() == 0 || a.signal.size() != b.signal.size()) return 0.0;
  const double sizes = a.signal.norm() * b.signal.norm();
  return sizes > 0.0 ? std::abs(a.signal.dot(b.signal)) / sizes : 0.0;
}

void select_best(const SelectionTask& task, const Fitted& parent, Iteration& iteration) {
  const bool has_holdout = !(*task.splits)[kValidation].empty();
  set_selection_frequencies(task, parent, iteration);
  std::stable_sort(iteration.candidates.begin(), iteration.candidates.end(),
                   [&](const CandidateEffect& a, const CandidateEffect& b) {
                     if (a.acceptance.accepted != b.acceptance.accepted) return a.acceptance.accepted;
                     return penalised_gain(a, has_holdout) > penalised_gain(b, has_holdout);
                   });
  if (iteration.candidates.empty() || !iteration.candidates.front().acceptance.accepted) return;
  const CandidateEffect& best = iteration.candidates.front();
  const double most = gain_of(best, has_holdout);
  const double floor = floor_of(best, has_holdout);
  std::vector<std::size_t> equals{0};
  const auto marked = [&](const CandidateEffect& c) {
    return task.predictor->shows_signature_of(*c.screened.entry);
  };
  // Of those that leave the same, the one whose mark the readings carry, else the one with the fewest
  // numbers.
  std::size_t first = 0;
  for (std::size_t c = 1; c < iteration.candidates.size(); ++c) {
    const CandidateEffect& other = iteration.candidates[c];
    if (!other.acceptance.accepted || other.screened.extends) continue;
    // Each lets another base parameter come back: neither does the other's work.
    if (best.acceptance.by_prior && other.screened.aliased_parameter() != best.screened.aliased_parameter())
      continue;
    const double lost = (most - gain_of(other, has_holdout)) / std::max(most, kLeastToPart);
    // Both may take nearly all, and yet one leave several times what the other leaves above the sensors'
    // floor.
    const double least = std::max(kLeastLeft * (1.0 - floor), kFloorError * floor);
    const double left = std::max(1.0 - gain_of(other, has_holdout) - floor_of(other, has_holdout), least) /
                        std::max(1.0 - most - floor, least);
    const bool confused = listed_as_confounded(*best.screened.entry->info, *other.screened.entry->info);
    const bool alike = cosine_similarity(best.screened, other.screened) > kConfoundedCosine;
    const bool same = lost < kSameGain && left < kSameLeft;
    const bool twin = lost < kTwinGain && ((confused && left < kListedLeft) || (alike && left < kTwinLeft));
    const bool undecided = other.probability >= kUndecided && left < kTwinLeft;
    if (!same && !twin && !undecided) continue;
    equals.push_back(c);
    const CandidateEffect& leader = iteration.candidates[first];
    const bool simpler = left < kSameLeft && numbers(other) < numbers(leader) && equals.size() <= kMostTwins;
    if ((same || twin) && (marked(other) || (simpler && !marked(leader)))) first = c;
  }
  while (equals.size() > kMostTwins)
    equals.erase(equals.back() == first ? equals.end() - 2 : equals.end() - 1);
  std::rotate(iteration.candidates.begin(), iteration.candidates.begin() + static_cast<std::ptrdiff_t>(first),
              iteration.candidates.begin() + static_cast<std::ptrdiff_t>(first) + 1);
  iteration.chosen = 0;
  for (const std::size_t e : equals) {
    if (e != first) iteration.twins.push_back(static_cast<int>(e < first ? e + 1 : e));
  }
}

}  // namespace omnihil
