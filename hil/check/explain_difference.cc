#include "hil/check/explain_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hil/check/explain_candidates.h"
#include "hil/check/measured_series.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {

constexpr std::size_t kBlocks = 10;  // Künsch 1989: few long blocks, each longer than the loop's memory
constexpr double kT9 = 2.262;        // two-sided 5 % of Student's t with nine degrees of freedom
constexpr double kT9OfMany =
    4.781;  // one-sided 5 % over 100 candidates (Bonferroni), nine degrees of freedom
constexpr double kLeastShare = 0.1;   // a choice: what removes less is no explanation of the difference
constexpr double kLeastNoise = 1e-4;  // of a series' RMS: 13 bits of a converter; less is no sensor
constexpr std::size_t kRefined = 6;   // candidates of the screening that are run again at their size
constexpr int kSteps = 8;             // of Gauss-Newton at most; it ends when the error no longer falls
constexpr double kMoreRemains = 2.0;  // left over noise: 1 is nothing, below 2 no eye sees structure

// The differences of all series in one vector, already by their noise, with each one's block of time.
struct Weighted {
  std::vector<double> r;
  std::vector<std::size_t> block;
};

using Trajectories = std::vector<std::vector<double>>;  // series by series, at the measured times

// White noise from second differences: the variance of x[i-1] - 2 x[i] + x[i+1] is 6 sigma^2. Steps of a slow signal
// and single peaks count in full: a series that has them weighs less.
double white_noise(const std::vector<double>& x) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) sum += std::pow(x[i - 1] - 2.0 * x[i] + x[i + 1], 2);
  return x.size() < 3 ? 0.0 : std::sqrt(sum / (6.0 * static_cast<double>(x.size() - 2)));
}

double rms(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return x.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(x.size()));
}

// Resolution of a series: of its field, or the least step between two values.
double quantum(const MeasuredSeries& series) {
  double least = 0.0;
  for (std::size_t i = 1; i < series.value.size(); ++i) {
    const double step = std::abs(series.value[i] - series.value[i - 1]);
    if (step > 0.0 && (least == 0.0 || step < least)) least = step;
  }
  return std::max(series.step, least);
}

class Search {
 public:
  Search(const Recording& recording, const RadioFormat& format, const ReplayOptions& options)
      : recording_(recording),
        format_(format),
        options_(options),
        by_(measured_by(recording)),
        measured_(measured_series(recording, format, by_)) {
    for (const MeasuredSeries& series : measured_) end_s_ = std::max(end_s_, series.time_s.back());
  }

  const std::vector<MeasuredSeries>& measured() const { return measured_; }

  // The model's values of every series at the measured times.
  Trajectories run(const ModelBundle& model) const {
    ReplayOptions options = options_;
    options.model = model;
    const ReplayRun run = run_again(recording_, options);
    if (!run.firmware_failure.empty()) throw std::runtime_error(run.firmware_failure);
    const std::vector<MeasuredSeries> answer = measured_series(run.answer, format_, by_);
    Trajectories values;
    for (const MeasuredSeries& series : measured_) {
      const auto same = std::ranges::find_if(answer, [&](const MeasuredSeries& other) {
        return other.name == series.name && other.robot_id == series.robot_id;
      });
      values.push_back(same == answer.end() ? std::vector<double>(series.time_s.size(), std::nan(""))
                                            : values_at(*same, series.time_s));
    }
    return values;
  }

  // The noise of each series, from its difference to the model as it stands.
  void weigh_by(const Trajectories& base) {
    sigma_.clear();
    for (std::size_t s = 0; s < measured_.size(); ++s) {
      std::vector<double> difference;
      for (std::size_t i = 0; i < base[s].size(); ++i) {
        const double d = measured_[s].value[i] - base[s][i];
        if (std::isfinite(d)) difference.push_back(d);
      }
      sigma_.push_back(std::max({white_noise(difference), quantum(measured_[s]) / std::sqrt(12.0),
                                 kLeastNoise * rms(measured_[s].value), 1e-12}));
    }
  }

  // measured - values, by the noise.
  Weighted residual(const Trajectories& values) const {
    Trajectories measured;
    for (const MeasuredSeries& series : measured_) measured.push_back(series.value);
    return by_noise(measured, values, 1.0);
  }
  // (moved - values) by the noise, over `step`.
  Weighted sensitivity(const Trajectories& moved, const Trajectories& values, double step) const {
    return by_noise(moved, values, step);
  }

 private:
  Weighted by_noise(const Trajectories& a, const Trajectories& b, double step) const {
    Weighted out;
    for (std::size_t s = 0; s < measured_.size(); ++s) {
      for (std::size_t i = 0; i < measured_[s].value.size(); ++i) {
        // What one run has no value for counts as no difference: the places of all runs are the same.
        const double difference = a[s][i] - b[s][i];
        out.r.push_back(std::isfinite(difference) ? difference / (sigma_[s] * step) : 0.0);
        const double place = measured_[s].time_s[i] / end_s_ * double{kBlocks};
        out.block.push_back(std::min(kBlocks - 1, static_cast<std::size_t>(place)));
      }
    }
    return out;
  }

  const Recording& recording_;
  const RadioFormat& format_;
  const ReplayOptions& options_;
  MeasuredBy by_;
  std::vector<MeasuredSeries> measured_;
  std::vector<double> sigma_;
  double end_s_ = 1e-9;
};

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<double> block_errors(const Weighted& w) {
  std::vector<double> error(kBlocks);
  for (std::size_t i = 0; i < w.r.size(); ++i) error[w.block[i]] += w.r[i] * w.r[i];
  return error;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

// Paired t of the blocks: `a` has the smaller error.
bool better(const std::vector<double>& a, const std::vector<double>& b) {
  double mean = 0.0, square = 0.0;
  for (std::size_t k = 0; k < kBlocks; ++k) mean += (b[k] - a[k]) / kBlocks;
  for (std::size_t k = 0; k < kBlocks; ++k) square += std::pow(b[k] - a[k] - mean, 2);
  const double error = std::sqrt(square / (kBlocks - 1) / kBlocks);
  return mean > kT9 * error;
}

// Standard error of <z, r> / <z, j> by leaving out one block at a time.
double jackknife(const Weighted& z, const Weighted& j, const Weighted& r) {
  std::vector<double> jj(kBlocks), jr(kBlocks), estimate;
  for (std::size_t i = 0; i < j.r.size(); ++i) {
    jj[j.block[i]] += z.r[i] * j.r[i];
    jr[j.block[i]] += z.r[i] * r.r[i];
  }
  const double all_jj = sum_of(jj), all_jr = sum_of(jr);
  for (std::size_t k = 0; k < kBlocks; ++k) {
    if (all_jj - jj[k] != 0.0) estimate.push_back((all_jr - jr[k]) / (all_jj - jj[k]));
  }
  const double n = static_cast<double>(estimate.size()), mean = sum_of(estimate) / n;
  double square = 0.0;
  for (const double e : estimate) square += (e - mean) * (e - mean);
  return std::sqrt(square * (n - 1.0) / n);
}

struct Screened {
  const ExplainCandidate* candidate = nullptr;
  Weighted j;
  double size = 0.0;   // of the first Gauss-Newton step
  double share = 0.0;  // predicted by the linear model
};

// Sizes by the instrument of a second sensitivity, from a step twice as large: counted encoders make of any change of
// the model another sequence of roundings, which is noise in j and would pull <j, r> / <j, j> to zero (errors in
// variables; Söderström, Errors-in-Variables Methods in System Identification, 2018, section 4.3).
std::optional<ExplainedBy> refined(const Search& search, const Screened& screened, const Weighted& r0) {
  const ExplainCandidate& c = *screened.candidate;
  const double from = c.is_effect ? c.from : c.from + (c.from - c.value), to = c.to + (c.to - c.value);
  const auto wide_from = c.model(std::clamp(from, c.lower, c.upper)),
             wide_to = c.model(std::clamp(to, c.lower, c.upper));
  if (!wide_from || !wide_to) return std::nullopt;
  const Weighted instrument =
      search.sensitivity(search.run(*wide_to), search.run(*wide_from),
                         std::clamp(to, c.lower, c.upper) - std::clamp(from, c.lower, c.upper));
  const double slope = dot(instrument.r, screened.j.r);
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
  ExplainedBy by{c.name, c.unit,         c.is_effect, c.value, value, jackknife(instrument, screened.j, r0),
                 0.0,    block_errors(r)};
  by.share = 1.0 - dot(r.r, r.r) / dot(r0.r, r0.r);
  return by;
}

std::string change_text(const ExplainedBy& by) {
  if (by.is_effect || by.was == 0.0)
    return fmt::format("{} = {:.4g} +- {:.2g} {}", by.name, by.is, by.sigma, by.unit);
  return fmt::format("{} {:.4g} -> {:.4g} {} ({:+.1f} % +- {:.1f} %)", by.name, by.was, by.is, by.unit,
                     100.0 * (by.is / by.was - 1.0), 100.0 * std::abs(by.sigma / by.was));
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

}  // namespace

DifferenceExplained explain_difference(const Recording& recording, const RadioFormat& format,
                                       const ReplayOptions& options,
                                       const std::function<void(std::size_t, std::size_t)>& progress) {
  DifferenceExplained out;
  Search search(recording, format, options);
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
  std::vector<Screened> screened;
  const std::vector<ExplainCandidate> candidates = explain_candidates(model);
  for (const ExplainCandidate& candidate : candidates) {
    if (progress) progress(out.tried, candidates.size());
    ++out.tried;
    const auto from = candidate.model(candidate.from), to = candidate.model(candidate.to);
    if (!from || !to) continue;
    try {
      Screened s{&candidate,
                 search.sensitivity(search.run(*to), search.run(*from), candidate.to - candidate.from), 0.0,
                 0.0};
      const double jj = dot(s.j.r, s.j.r), jr = dot(s.j.r, r0.r);
      if (!(jj > 0.0)) continue;
      s.size = jr / jj;
      s.share = jr * jr / (jj * dot(r0.r, r0.r));
      const double value = candidate.value + s.size;
      if (value <= candidate.lower || value >= candidate.upper) continue;
      screened.push_back(std::move(s));
    } catch (const std::runtime_error&) {
      continue;  // the state stopped being finite with it: no explanation
    }
  }
  std::ranges::sort(screened, std::greater<>{}, &Screened::share);
  if (screened.size() > kRefined) screened.resize(kRefined);
  std::vector<ExplainedBy> tried;
  for (const Screened& s : screened) {
    if (auto by = refined(search, s, r0)) tried.push_back(std::move(*by));
  }
  decide(out, std::move(tried), r0);
  return out;
}

std::string explained_text(const DifferenceExplained& explained) {
  std::string text = "model      " + explained.headline + "\n";
  if (!explained.why_not.empty()) return text;
  for (std::size_t i = 1; i < explained.found.size(); ++i)
    text += "           not told apart from " + change_text(explained.found[i]) + "\n";
  text += fmt::format("           {} candidates; RMS of the difference {:.1f} times the noise, in {}\n",
                      explained.tried, explained.error_over_noise, fmt::join(explained.series, ", "));
  return text;
}

}  // namespace omnihil
