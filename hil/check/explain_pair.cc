#include "hil/check/explain_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "hil/check/explain_size.h"

namespace omnihil {
namespace {

constexpr double kT9OfPairs =
    5.291;  // one-sided 5 % over 200 candidates (Bonferroni), nine degrees of freedom
constexpr double kLeastShare = 0.1;   // as of one cause
constexpr std::size_t kRefined = 4;   // of the screening, fitted as pairs
constexpr int kSteps = 8;             // of Gauss-Newton at most; it ends when the error no longer falls
constexpr double kEffectStep = 0.25;  // of an effect's size, both ways: within what is linear

using Two = std::array<double, 2>;

// The model with the first candidate at a and, in that, the named one at b.
std::optional<ModelBundle> pair_model(const ExplainCandidate& first, double a, const std::string& second,
                                      double b) {
  const auto one = first.model(a);
  if (!one) return std::nullopt;
  for (const ExplainCandidate& candidate : explain_candidates(*one))
    if (candidate.name == second) return candidate.model(b);
  return std::nullopt;
}

struct Span {
  double from = 0.0, to = 0.0;
};

// Round the value that it has: of a parameter as far as it is moved for one cause, of an effect a part of its size.
Span span_at(const ExplainCandidate& c, double value, double width) {
  const double half = width * (c.is_effect && value != c.value ? kEffectStep * std::abs(value - c.value)
                                                               : 0.5 * (c.to - c.from));
  const double from = c.is_effect && value == c.value ? c.from : value - half;
  const double to = c.is_effect && value == c.value ? c.value + width * (c.to - c.value) : value + half;
  return {std::clamp(from, c.lower, c.upper), std::clamp(to, c.lower, c.upper)};
}

std::optional<Weighted> sensitivity_of(const ExplainSearch& search, const ExplainCandidate& c, Span span) {
  const auto from = c.model(span.from), to = c.model(span.to);
  if (!from || !to || span.from == span.to) return std::nullopt;
  try {
    return search.sensitivity(search.run(*to), search.run(*from), span.to - span.from);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // the state stopped being finite with it
  }
}

// What a and b change, and their instruments.
struct PairSlopes {
  Weighted j1, j2, z1, z2;
};

// Solves [<z1,j1> <z1,j2>; <z2,j1> <z2,j2>] d = [<z1,r>; <z2,r>].
std::optional<Two> solve(const PairSlopes& s, const Weighted& r) {
  const double m11 = dot(s.z1.r, s.j1.r), m12 = dot(s.z1.r, s.j2.r), m21 = dot(s.z2.r, s.j1.r),
               m22 = dot(s.z2.r, s.j2.r), v1 = dot(s.z1.r, r.r), v2 = dot(s.z2.r, r.r);
  const double det = m11 * m22 - m12 * m21;
  constexpr double kAlike = 1e-6;  // of the product of the diagonal: the two cannot be told apart at all
  if (!(std::abs(det) > kAlike * std::abs(m11 * m22))) return std::nullopt;
  return Two{(v1 * m22 - v2 * m12) / det, (m11 * v2 - m21 * v1) / det};
}

struct Start {
  const FittedCandidate* first = nullptr;
  const ExplainCandidate* second = nullptr;  // in the model that has the first
};

// Both together; nothing where they do not make it better than the first alone.
std::optional<ExplainedPair> fitted_pair(const ExplainSearch& search, const Start& start,
                                         const Weighted& alone) {
  const ExplainCandidate &c1 = *start.first->candidate, &c2 = *start.second;
  PairSlopes s;
  const auto take = [&](const ExplainCandidate& c, double value, double width, Weighted& out) {
    auto j = sensitivity_of(search, c, span_at(c, value, width));
    if (j) out = std::move(*j);
    return j.has_value();
  };
  if (!take(c1, start.first->value, 1.0, s.j1) || !take(c1, start.first->value, 2.0, s.z1) ||
      !take(c2, c2.value, 1.0, s.j2) || !take(c2, c2.value, 2.0, s.z2))
    return std::nullopt;
  Two at{start.first->value, c2.value};
  Weighted r = alone;
  for (int step = 0; step < kSteps; ++step) {
    const auto d = solve(s, r);
    if (!d) break;
    const Two next{std::clamp(at[0] + (*d)[0], c1.lower, c1.upper),
                   std::clamp(at[1] + (*d)[1], c2.lower, c2.upper)};
    const auto model = pair_model(c1, next[0], c2.name, next[1]);
    if (!model) break;
    Weighted after;
    try {
      after = search.residual(search.run(*model));
    } catch (const std::runtime_error&) {
      break;
    }
    if (dot(after.r, after.r) >= dot(r.r, r.r)) break;
    at = next;
    r = std::move(after);
  }
  if (at[1] == c2.value) return std::nullopt;
  // As of one (explain_size.h): the steps end where chance does.
  const auto half = [](const ExplainCandidate& c, double value) {
    const Span span = span_at(c, value, 1.0);
    return 0.5 * kSizeStep * (span.to - span.from);
  };
  const auto fit =
      fitted_sizes(search, {.model = [&](const auto& a) { return pair_model(c1, a[0], c2.name, a[1]); },
                            .z = {&s.z1, &s.z2},
                            .start = {at[0], at[1]},
                            .half = {half(c1, at[0]), half(c2, at[1])},
                            .lower = {c1.lower, c2.lower},
                            .upper = {c1.upper, c2.upper}});
  const auto fitted = fit ? pair_model(c1, fit->value[0], c2.name, fit->value[1]) : std::nullopt;
  Two sigma{INFINITY, INFINITY};
  if (fitted) {
    at = {fit->value[0], fit->value[1]};
    sigma = {fit->sigma[0], fit->sigma[1]};
    r = search.residual(search.run(*fitted));
  }
  ExplainedPair pair;
  pair.first = {c1.name, c1.unit, c1.is_effect, c1.value, at[0], sigma[0], 0.0, block_errors(r)};
  pair.second = {c2.name, c2.unit, c2.is_effect, c2.value, at[1], sigma[1], 0.0, block_errors(r)};
  pair.second.share = 1.0 - dot(r.r, r.r) / dot(alone.r, alone.r);
  pair.block_error = block_errors(r);
  pair.left_over_noise = rms(r.r);
  return pair;
}

// What is left of `a` beside `b`.
std::vector<double> beside(const std::vector<double>& a, const std::vector<double>& b) {
  const double part = dot(a, b) / dot(b, b);
  std::vector<double> rest = a;
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= part * b[i];
  return rest;
}

// By the sensitivities of the first round, whose weights are still in force: names of the best, in falling order.
std::vector<std::string> screened(const std::vector<CandidateSlope>& slopes, const std::string& first,
                                  const Weighted& alone) {
  const auto own =
      std::ranges::find_if(slopes, [&](const CandidateSlope& s) { return s.candidate->name == first; });
  if (own == slopes.end()) return {};
  const std::vector<double> r = beside(alone.r, own->j.r);
  std::vector<std::pair<double, std::string>> all;
  for (const CandidateSlope& s : slopes) {
    const ExplainCandidate& c = *s.candidate;
    if (c.name == first) continue;
    const std::vector<double> j = beside(s.j.r, own->j.r);
    const double jj = dot(j, j), jr = dot(j, r), value = c.value + (jj > 0.0 ? jr / jj : 0.0);
    if (jj > 0.0 && value > c.lower && value < c.upper) all.emplace_back(jr * jr / (jj * dot(r, r)), c.name);
  }
  std::ranges::sort(all, std::greater<>{});
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(kRefined, all.size()); ++i) names.push_back(all[i].second);
  return names;
}

double error_of(const ExplainedPair& pair) { return sum_of(pair.block_error); }

bool beyond_chance(const ExplainedBy& by) { return std::abs(by.is - by.was) > kT9OfPairs * by.sigma; }

}  // namespace

std::optional<ExplainedPair> explain_second(ExplainSearch& search, const FittedCandidate& best,
                                            const std::vector<FittedCandidate>& others,
                                            const std::vector<CandidateSlope>& slopes) {
  const auto model = best.candidate->model(best.value);
  if (!model) return std::nullopt;
  const Trajectories with_first = search.run(*model);
  const std::vector<std::string> names = screened(slopes, best.candidate->name, search.residual(with_first));
  search.weigh_by(with_first);
  const Weighted alone = search.residual(with_first);
  const std::vector<ExplainCandidate> candidates = explain_candidates(*model);
  std::vector<ExplainedPair> pairs;
  for (const std::string& name : names) {
    const auto second = std::ranges::find(candidates, name, &ExplainCandidate::name);
    if (second == candidates.end()) continue;
    if (auto pair = fitted_pair(search, {&best, &*second}, alone)) pairs.push_back(std::move(*pair));
  }
  std::erase_if(pairs, [&](const ExplainedPair& pair) {
    return pair.second.share < kLeastShare || !better(pair.block_error, block_errors(alone));
  });
  if (pairs.empty()) return std::nullopt;
  std::ranges::sort(pairs, {}, error_of);
  ExplainedPair found = pairs.front();
  for (std::size_t i = 1; i < pairs.size(); ++i)
    if (!better(found.block_error, pairs[i].block_error)) found.instead.push_back(pairs[i].second);
  // The first was chosen without the second: does another do better in its place?
  for (const FittedCandidate& other : others) {
    if (other.candidate->name == found.second.name) continue;
    const auto its_model = other.candidate->model(other.value);
    if (!its_model) continue;
    const std::vector<ExplainCandidate> its = explain_candidates(*its_model);
    const auto second = std::ranges::find(its, found.second.name, &ExplainCandidate::name);
    if (second == its.end()) continue;
    const Weighted its_alone = search.residual(search.run(*its_model));
    auto pair = fitted_pair(search, {&other, &*second}, its_alone);
    if (!pair || !better(pair->block_error, found.block_error)) continue;
    pair->second.share = 1.0 - error_of(*pair) / dot(alone.r, alone.r);
    pair->instead = found.instead;
    found = std::move(*pair);
  }
  found.certain = beyond_chance(found.first) && beyond_chance(found.second);
  return found;
}

}  // namespace omnihil
