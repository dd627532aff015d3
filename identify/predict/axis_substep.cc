#include "identify/predict/axis_substep.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace omnihil {
namespace {

constexpr double kLongestStep_s = 2e-3;  // a choice (DECISIONS 213); taken where it is fine enough
constexpr double kPlain_s = 1e-3;  // to which a law that is not marked (NumericsBit) is taken for fine enough
constexpr std::array kSizes = {0.25, 4.0};  // of the typical one, tried beside it; a choice
constexpr int kTrialRuns = 4;               // bounds the cost; a choice

// Of a run whose rows are far apart (one per step of a staircase): the motion between them is not seen, and
// longest_step() holds these steps to its bound too.
double coarser(const AxisSetup& s) {
  constexpr double kStepsPerRow = 128.0;  // a choice
  constexpr double kMost = 8.0;  // a third of a small drive's mechanical time constant of 25 ms; a choice
  if (s.steady || s.input.time_s.size() < 2) return 1.0;
  return std::clamp(median_period_s(s.input.time_s) / (kStepsPerRow * kLongestStep_s), 1.0, kMost);
}

std::vector<Candidate> sizes_of(const EffectEntry& entry, const Candidate& nominal) {
  const DriveParams<double> drive = drive_of(nominal);
  const EffectUse typical = typical_use(entry, &drive);
  std::vector<Candidate> out;
  const auto add_scaled = [&](auto&& is_meant, double by) {
    EffectUse use = typical;
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = entry.info->params[i];
      if (is_meant(i)) use.values[i] = std::clamp(use.values[i] * by, row.lower, row.upper);
    }
    out.push_back(nominal);
    out.back().effects.push_back(use);
  };
  add_scaled([](std::size_t) { return false; }, 1.0);
  for (const double by : kSizes) {
    add_scaled([&](std::size_t i) { return entry.info->params[i].role == ParamRole::kStrength; }, by);
    for (std::size_t shape = 0; shape < typical.values.size(); ++shape) {
      const EffectParam& row = entry.info->params[shape];
      if (row.role == ParamRole::kShape && row.trait == ParamTrait::kPlain)
        add_scaled([&](std::size_t i) { return i == shape; }, by);
    }
  }
  return out;
}

// How many times longer than at the stiffest size tried a spring's steps may be: its mode is slower by the square root of its
// compliance (Meirovitch 2001), what its damping takes away decays as fast as at any compliance. In powers of two, so that a fit
// seldom crosses from one step to the next.
double softer(const EffectUse& use, const Candidate& nominal) {
  const EffectInfo& info = *use.entry->info;
  if (info.place != Place::kShaft || (info.numerics & (kStiff | kImpacts)) != kStiff) return 1.0;
  const DriveParams<double> drive = drive_of(nominal);
  const auto over_typical = [&](std::size_t i) { return use.values[i] / start_of(info.params[i], &drive); };
  double times = std::sqrt(over_typical(first_strength(info)) / kSizes.front());
  for (std::size_t i = 0; i < use.values.size(); ++i) {
    if (info.params[i].power_of_size < 0.0) times = std::min(times, kSizes.back() / over_typical(i));
  }
  return times > 1.0 ? std::exp2(std::floor(std::log2(times))) : 1.0;
}

}  // namespace

bool acts(const Candidate& c, std::uint32_t numerics) {
  return std::any_of(c.effects.begin(), c.effects.end(), [&](const EffectUse& use) {
    return (use.entry->info->numerics & numerics) != 0 && !is_neutral(use);
  });
}

AxisSubstep::AxisSubstep(const Candidate& nominal, const std::vector<AxisSetup>& setups, double shortest_s,
                         const Error& error)
    : nominal_(nominal), error_(error), shortest_s_(shortest_s), base_s_(shortest_s) {
  double longest_s = shortest_s;
  for (const AxisSetup& s : setups) {
    coarser_.push_back(coarser(s));
    const std::vector<double>& t = s.input.time_s;
    if (!s.steady && t.size() > 1) longest_s = std::max(longest_s, std::min(kLongestStep_s, t[1] - t[0]));
  }
  base_s_ = longest_step({nominal}, longest_s);
}

double AxisSubstep::longest_step(const std::vector<Candidate>& models, double longest_s) const {
  constexpr double kShareOfNoise = 0.07;  // DECISIONS 42
  const auto is_fine = [&](double h) {
    int tried = 0;
    for (int n = 0; n < static_cast<int>(coarser_.size()) && tried < kTrialRuns; ++n) {
      bool ran = false;
      for (const Candidate& m : models) {
        const double e = error_(m, n, h * coarser_[static_cast<std::size_t>(n)]);
        if (std::isnan(e)) break;
        if (e > kShareOfNoise) return false;
        ran = true;
      }
      tried += ran ? 1 : 0;
    }
    return tried > 0;
  };
  double h = longest_s;
  while (h > shortest_s_ * 1.01) {
    if (is_fine(h)) return h;
    h *= 0.5;
  }
  return shortest_s_;
}

double AxisSubstep::step_of(const EffectEntry& entry, int n) const {
  if ((entry.info->numerics & kImpacts) != 0) return std::min(base_s_, shortest_s_);
  const std::scoped_lock lock(measured_->mutex);
  auto at = measured_->step_s.find(&entry);
  if (at == measured_->step_s.end())
    at = measured_->step_s.emplace(&entry, longest_step(sizes_of(entry, nominal_), base_s_)).first;
  return at->second * coarser_[static_cast<std::size_t>(n)];
}

double AxisSubstep::of(const Candidate& c, int n) const {
  double h = base_s_ * coarser_[static_cast<std::size_t>(n)];
  for (const EffectUse& use : c.effects) {
    const bool is_plain = (use.entry->info->numerics & (kStiff | kFine)) == 0;
    if (is_neutral(use) || (is_plain && base_s_ <= kPlain_s)) continue;
    h = std::min(h, softer(use, nominal_) * step_of(*use.entry, n));
  }
  return h;
}

}  // namespace omnihil
