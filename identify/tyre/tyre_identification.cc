#include "identify/tyre/tyre_identification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/compare/comparison.h"

namespace omnihil {
namespace {

constexpr std::array<const char*, 4> kPaths{
    "tyre.longitudinal.extremum_slip", "tyre.longitudinal.extremum_value", "tyre.longitudinal.asymptote_slip",
    "tyre.longitudinal.asymptote_value"};
constexpr double k90 = 1.645;  // two-sided 90 % of a normal: derived
constexpr double kFree = 1.0;  // tolerance where the model gives none: hardly a belief; a choice
constexpr double kNear = 0.9;  // of the curve's largest grip, that some point must have carried; a choice
constexpr double kGood_sigmas = 1.5;   // pooled: no further start is tried; a choice
constexpr double kBeyondCurve = 1.5;   // noise and quasi-static loads: a fifth at most; a choice
constexpr double kUndetermined = 0.5;  // sigma over value: no figure; a choice

// The model with the tyre of the points, each number of it free.
Candidate begin_with(const Candidate& nominal, const TyreCurve& c, std::vector<std::string>& faults) {
  Candidate start = nominal;
  const std::array<double, 4> values{c.extremum_slip, c.extremum_value, c.asymptote_slip, c.asymptote_value};
  for (std::size_t i = 0; i < kPaths.size(); ++i) {
    if (const std::string wrong = start.file.parameters.set(kPaths[i], values[i]); !wrong.empty())
      faults.push_back(wrong);
    Parameter* const p = start.file.parameters.find(kPaths[i]);
    if (p == nullptr) continue;
    if (p->origin == Origin::kDefault) p->origin = Origin::kSet;
    // A belief about the tyre is what is to be found out.
    p->tolerance = kFree;
    p->fitted.reset();
  }
  return start;
}

// Of the forward fit, whose sliding wheels make it stop in other minima: the points' curve, the model's own, and between.
std::vector<TyreCurve> starts_of(const Candidate& nominal, const TyreCurve& points) {
  const ParameterTable& table = nominal.file.parameters;
  const TyreCurve own{table.value_or(kPaths[0], kDefaultTyreLongitudinal.extremum_slip),
                      table.value_or(kPaths[1], kDefaultTyreLongitudinal.extremum_value),
                      table.value_or(kPaths[2], kDefaultTyreLongitudinal.asymptote_slip),
                      table.value_or(kPaths[3], kDefaultTyreLongitudinal.asymptote_value)};
  TyreCurve stiffer = points, softer = points;
  stiffer.extremum_slip *= 0.6;
  softer.extremum_slip *= 1.6;
  softer.asymptote_slip = std::max(points.asymptote_slip, 1.2 * softer.extremum_slip);
  return {points, own, stiffer, softer};
}

// Over the signals that a tyre moves; a supply that drifts is another story.
double motion_sigmas(const Comparison& comparison) {
  if (!comparison.diverged.empty()) return std::numeric_limits<double>::infinity();
  double sum2 = 0.0;
  int count = 0;
  for (const SignalError& e : comparison.errors) {
    if (e.split != Split::kTraining || e.signal == "bus_voltage") continue;
    sum2 += e.in_sigmas * e.in_sigmas;
    ++count;
  }
  return count > 0 ? std::sqrt(sum2 / count) : std::numeric_limits<double>::infinity();
}

std::string grip_sentence(const TyreIdentification& t, const std::string& why) {
  return fmt::format("largest grip {:.3g} of the load, at a slip of at most {:.2g} (95 %); {}",
                     t.sticking.most_ratio, t.sticking.slip_bound_95, why);
}

std::string curve_sentence(const TyreIdentification& t) {
  std::string text =
      fmt::format("largest grip {:.3g} +- {:.1g} of the load at a slip of {:.3g} +- {:.1g}",
                  t.numbers[1].value, t.numbers[1].sigma, t.numbers[0].value, t.numbers[0].sigma);
  if (t.numbers[3].determined)
    text += fmt::format("; sliding, {:.3g} +- {:.1g} from a slip of {:.3g} on", t.numbers[3].value,
                        t.numbers[3].sigma, t.numbers[2].value);
  else
    text += "; what a sliding wheel carries is not told by these data";
  return text;
}

}  // namespace

TyreCurve TyreIdentification::curve() const {
  if (outcome != TyreOutcome::kCurve) return by_points.curve;
  return {numbers[0].value, numbers[1].value, numbers[2].value, numbers[3].value};
}

double TyreIdentification::band(double slip) const {
  if (outcome != TyreOutcome::kCurve || fit.covariance.size() == 0) return 0.0;
  std::array<Eigen::Index, 4> at{-1, -1, -1, -1};
  for (std::size_t u = 0; u < fit.unknowns.size(); ++u)
    for (std::size_t i = 0; i < kPaths.size(); ++i)
      if (fit.unknowns[u].path == kPaths[i]) at[i] = static_cast<Eigen::Index>(u);
  const TyreCurve c = curve();
  constexpr std::array<double TyreCurve::*, 4> kMembers{&TyreCurve::extremum_slip, &TyreCurve::extremum_value,
                                                        &TyreCurve::asymptote_slip,
                                                        &TyreCurve::asymptote_value};
  std::array<double, 4> slope{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (at[i] < 0) continue;
    const double h = 1e-4 * std::max(1e-6, std::abs(c.*kMembers[i]));
    TyreCurve more = c, less = c;
    more.*kMembers[i] += h;
    less.*kMembers[i] -= h;
    slope[i] = (grip<double>(more, slip) - grip<double>(less, slip)) / (2.0 * h);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      if (at[i] >= 0 && at[j] >= 0) variance += slope[i] * slope[j] * fit.covariance(at[i], at[j]);
  return k90 * std::sqrt(std::max(0.0, variance));
}

TyreIdentification identify_tyre(const Dataset& dataset, const Candidate& nominal,
                                 const FitOptions& options) {
  TyreIdentification t;
  t.points = tyre_points(dataset, nominal, t.faults);
  if (!t.faults.empty()) return t;
  constexpr std::size_t kLeastPoints = 200;  // 2 s of a run; a choice
  if (t.points.all.size() < kLeastPoints) {
    t.faults.push_back(
        fmt::format("{} points of force over slip; needed: {} (pushes of half a second, forward and "
                    "back, several levels)",
                    t.points.all.size(), kLeastPoints));
    return t;
  }
  t.by_points = fit_tyre_curve(t.points.all);
  t.sticking = sticking_grip(t.points);
  std::vector<double> sizes;
  for (const TyrePoint& p : t.points.all) sizes.push_back(std::abs(p.ratio));
  std::ranges::sort(sizes);
  t.most_ratio = sizes[static_cast<std::size_t>(0.995 * static_cast<double>(sizes.size() - 1))];

  // Wheels that carry more than the points' curve holds do so at slips below what these data resolve: the forward fit
  // would start, and end, nowhere.
  if (t.sticking.most_ratio > kBeyondCurve * t.by_points.curve.extremum_value) {
    t.outcome = TyreOutcome::kGripAlone;
    t.sentence = grip_sentence(t, "the slip itself drowns in the noise of these data");
    return t;
  }
  const auto predictor = make_predictor(dataset, nominal, {});
  t.pooled_sigmas = std::numeric_limits<double>::infinity();
  for (const TyreCurve& curve : starts_of(nominal, t.by_points.curve)) {
    const Candidate start = begin_with(nominal, curve, t.faults);
    if (!t.faults.empty()) return t;
    FitResult found = fit(*predictor, start, unknowns_of(start), options);
    const double left = motion_sigmas(compare(*predictor, found.model));
    if (left < t.pooled_sigmas || t.fit.parameters.empty()) {
      t.fit = std::move(found);
      t.pooled_sigmas = left;
    }
    if (t.pooled_sigmas < kGood_sigmas || t.fit.stopped) break;
  }
  for (const ParameterEstimate& p : t.fit.parameters)
    for (std::size_t i = 0; i < kPaths.size(); ++i) {
      if (p.path != kPaths[i]) continue;
      TyreNumber& n = t.numbers[i];
      n = {p.path, p.value, p.sigma, p.value - k90 * p.sigma, p.value + k90 * p.sigma, true};
      n.determined = p.identifiable && !p.at_bound && p.sigma < kUndetermined * std::abs(p.value);
    }
  const bool explains = std::isfinite(t.pooled_sigmas) && t.pooled_sigmas < TyreIdentification::kWorst_sigmas;
  if (explains && t.numbers[0].determined && t.numbers[1].determined &&
      t.most_ratio >= kNear * t.numbers[1].value) {
    t.outcome = TyreOutcome::kCurve;
    t.sentence = curve_sentence(t);
    return t;
  }
  if (explains && (!t.numbers[1].determined || t.most_ratio < kNear * t.numbers[1].value)) {
    t.outcome = TyreOutcome::kNoPeak;
    t.sentence = fmt::format(
        "the wheels never came near their largest grip: it is above {:.3g} of the load; push "
        "harder, in steps, until they slide",
        t.most_ratio);
    return t;
  }
  t.outcome = TyreOutcome::kGripAlone;
  t.sentence = grip_sentence(
      t, explains ? "the slip itself drowns in the noise of these data"
                  : fmt::format("the forward model leaves {:.3g} times the noise, so no more is said",
                                t.pooled_sigmas));
  return t;
}

}  // namespace omnihil
