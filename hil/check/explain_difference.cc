#include "hil/check/explain_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hil/check/explain_candidates.h"
#include "hil/check/explain_pair.h"
#include "hil/check/explain_search.h"
#include "hil/check/explain_size.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {

constexpr double kT9OfMany =
    4.781;  // one-sided 5 % over 100 candidates (Bonferroni), nine degrees of freedom
constexpr double kLeastShare = 0.1;   // a choice: what removes less is no explanation of the difference
constexpr std::size_t kRefined = 6;   // candidates of the screening that are run again at their size
constexpr int kSteps = 8;             // of Gauss-Newton at most; it ends when the error no longer falls
constexpr double kMoreRemains = 2.0;  // left over noise: 1 is nothing, below 2 no eye sees structure

struct Screened {
  const CandidateSlope* slope = nullptr;
  double share = 0.0;  // predicted by the linear model
};

// Two digits; none where it is not known.
std::string error_text(double half_width) {
  return std::isfinite(half_width) ? fmt::format("{:.2g}", half_width) : "?";
}

std::string change_text(const ExplainedBy& by) {
  const double half_width = kExplainT * by.sigma;
  if (by.is_effect || by.was == 0.0)
    return fmt::format("{} = {:.4g} +- {} {}", by.name, by.is, error_text(half_width), by.unit);
  return fmt::format("{} {:.4g} -> {:.4g} {} ({:+.2f} % +- {} %)", by.name, by.was, by.is, by.unit,
                     100.0 * (by.is / by.was - 1.0), error_text(100.0 * std::abs(half_width / by.was)));
}

// Its size is beyond chance, of as many candidates as there are.
bool is_certain(const ExplainedBy& by) { return std::abs(by.is - by.was) > kT9OfMany * by.sigma; }

void decide(DifferenceExplained& out, std::vector<ExplainedBy> tried, const Weighted& r0) {
  const std::vector<double> as_it_stands = block_errors(r0);
  std::erase_if(tried, [&](const ExplainedBy& by) {
    return by.share < kLeastShare || !(is_certain(by) || better(by.block_error, as_it_stands));
  });
  std::ranges::sort(tried, std::greater<>{}, &ExplainedBy::share);
  if (tried.empty()) {
    out.headline = fmt::format("nothing found: none of {} candidates explains the difference", out.tried);
    return;
  }
  const double count = static_cast<double>(r0.r.size());
  out.left_over_noise = std::sqrt(sum_of(tried.front().block_error) / count);
  for (ExplainedBy& by : tried) {
    if (out.found.empty() || !better(out.found.front().block_error, by.block_error))
      out.found.push_back(std::move(by));
  }
  const ExplainedBy& best = out.found.front();
  const char* word = !is_certain(best)                    ? "perhaps"
                     : out.left_over_noise > kMoreRemains ? "found, but more remains"
                                                          : "found";
  out.headline =
      fmt::format("{}: {}; it removes {:.0f} % of the squared difference, {:.1f} times the noise is left",
                  word, change_text(best), 100.0 * best.share, out.left_over_noise);
}

// Where the best is certain: is there a second one beside it?
void decide_pair(DifferenceExplained& out, ExplainSearch& search, const std::vector<CandidateSlope>& slopes,
                 const std::vector<ExplainedBy>& tried) {
  if (out.found.empty() || !is_certain(out.found.front())) return;
  FittedCandidate best;
  std::vector<FittedCandidate> others;
  for (const ExplainedBy& by : tried) {
    const auto of =
        std::ranges::find_if(slopes, [&](const CandidateSlope& s) { return s.candidate->name == by.name; });
    const FittedCandidate fitted{of->candidate, by.is};
    if (by.name == out.found.front().name) {
      best = fitted;
    } else {
      others.push_back(fitted);
    }
  }
  const bool left = out.left_over_noise > kMoreRemains;
  auto pair = explain_second(search, best, others, slopes);
  if (!pair || (!pair->certain && !left)) {
    if (left) out.headline += "; no second one is found";
    return;
  }
  out.left_over_noise = pair->left_over_noise;
  const bool more = pair->left_over_noise > kMoreRemains;
  out.headline = fmt::format(
      "{}{}: {}, and {}{}; the second removes {:.0f} % of what the first leaves, {:.1f} times the noise is "
      "left",
      pair->certain ? "found" : "found one", more ? ", but more remains" : "", change_text(pair->first),
      pair->certain ? "" : "perhaps ", change_text(pair->second), 100.0 * pair->second.share,
      pair->left_over_noise);
  out.found = {std::move(pair->first)};
  out.second = {std::move(pair->second)};
  for (ExplainedBy& by : pair->instead) out.second.push_back(std::move(by));
  out.second_certain = pair->certain;
}

}  // namespace

// Sizes by the instrument of a second sensitivity, from a step twice as large: counted encoders make of any change of
// the model another sequence of roundings, which is noise in j and would pull <j, r> / <j, j> to zero (errors in
// variables; Söderström, Errors-in-Variables Methods in System Identification, 2018, section 4.3).
std::optional<ExplainedBy> explained_by(const ExplainSearch& search, const ExplainCandidate& c,
                                        const Weighted& j, const Weighted& r0) {
  const double from = c.is_effect ? c.from : c.from + (c.from - c.value), to = c.to + (c.to - c.value);
  const auto wide_from = c.model(std::clamp(from, c.lower, c.upper)),
             wide_to = c.model(std::clamp(to, c.lower, c.upper));
  if (!wide_from || !wide_to) return std::nullopt;
  const Weighted instrument =
      search.sensitivity(search.run(*wide_to), search.run(*wide_from),
                         std::clamp(to, c.lower, c.upper) - std::clamp(from, c.lower, c.upper));
  const double slope = dot(instrument.r, j.r);
  double value = c.value;
  Weighted r = r0;
  for (int step = 0; step < kSteps && slope > 0.0; ++step) {
    const double next = std::clamp(value + dot(instrument.r, r.r) / slope, c.lower, c.upper);
    if (next == value) break;
    const auto model = c.model(next);
    if (!model) break;
    Weighted after = search.residual(search.run(*model));
    if (dot(after.r, after.r) >= dot(r.r, r.r)) break;
    value = next;
    r = std::move(after);
  }
  if (value == c.value) return std::nullopt;
  ExplainedBy by{c.name, c.unit, c.is_effect, c.value, value, INFINITY, 0.0, {}};
  // The steps end where chance does: the size itself, and its error, are taken from runs round there.
  const bool counts = 1.0 - dot(r.r, r.r) / dot(r0.r, r0.r) >= kLeastShare;
  const auto fit = counts
                       ? fitted_sizes(search, {.model = [&c](const auto& at) { return c.model(at.front()); },
                                               .z = {&instrument},
                                               .start = {value},
                                               .half = {0.5 * kSizeStep * (c.to - c.from)},
                                               .lower = {c.lower},
                                               .upper = {c.upper}})
                       : std::nullopt;
  const auto fitted = fit ? c.model(fit->value.front()) : std::nullopt;
  if (fitted) {
    by.is = fit->value.front(), by.sigma = fit->sigma.front();
    r = search.residual(search.run(*fitted));
  }
  by.block_error = block_errors(r);
  by.share = 1.0 - dot(r.r, r.r) / dot(r0.r, r0.r);
  return by;
}

DifferenceExplained explain_difference(const Recording& recording, const RadioFormat& format,
                                       const ReplayOptions& options,
                                       const std::function<void(std::size_t, std::size_t)>& progress) {
  DifferenceExplained out;
  ExplainSearch search(recording, format, options);
  if (search.measured().empty()) {
    out.why_not = "neither samples nor physical fields of telemetry";
    out.headline = "not searched: " + out.why_not;
    return out;
  }
  for (const MeasuredSeries& series : search.measured()) {
    if (std::ranges::find(out.series, series.name) == out.series.end()) out.series.push_back(series.name);
  }
  const ModelBundle model = options.model ? *options.model : session_setup(recording.header).model;
  const Trajectories base = search.run(model);
  search.weigh_by(base);
  const Weighted r0 = search.residual(base);
  out.error_over_noise = rms(r0.r);
  std::vector<CandidateSlope> slopes;
  const std::vector<ExplainCandidate> candidates = explain_candidates(model);
  for (const ExplainCandidate& candidate : candidates) {
    if (progress) progress(out.tried, candidates.size());
    ++out.tried;
    const auto from = candidate.model(candidate.from), to = candidate.model(candidate.to);
    if (!from || !to) continue;
    try {
      slopes.push_back({&candidate, search.sensitivity(search.run(*to), search.run(*from),
                                                       candidate.to - candidate.from)});
    } catch (const std::runtime_error&) {
      continue;  // the state stopped being finite with it: no explanation
    }
  }
  std::vector<Screened> screened;
  for (const CandidateSlope& slope : slopes) {
    const ExplainCandidate& c = *slope.candidate;
    const double jj = dot(slope.j.r, slope.j.r), jr = dot(slope.j.r, r0.r);
    if (!(jj > 0.0)) continue;
    const double value = c.value + jr / jj;  // of the first Gauss-Newton step
    if (value > c.lower && value < c.upper) screened.push_back({&slope, jr * jr / (jj * dot(r0.r, r0.r))});
  }
  std::ranges::sort(screened, std::greater<>{}, &Screened::share);
  if (screened.size() > kRefined) screened.resize(kRefined);
  std::vector<ExplainedBy> tried;
  for (const Screened& s : screened) {
    if (auto by = explained_by(search, *s.slope->candidate, s.slope->j, r0)) tried.push_back(std::move(*by));
  }
  decide(out, tried, r0);
  decide_pair(out, search, slopes, tried);
  return out;
}

std::string explained_text(const DifferenceExplained& explained) {
  std::string text = "model      " + explained.headline + "\n";
  if (!explained.why_not.empty()) return text;
  for (std::size_t i = 1; i < explained.found.size(); ++i)
    text += "           not told apart from " + change_text(explained.found[i]) + "\n";
  for (std::size_t i = 1; i < explained.second.size(); ++i)
    text += "           the second not told apart from " + change_text(explained.second[i]) + "\n";
  text += fmt::format("           {} candidates; RMS of the difference {:.1f} times the noise, in {}\n",
                      explained.tried, explained.error_over_noise, fmt::join(explained.series, ", "));
  return text;
}

}  // namespace omnihil
