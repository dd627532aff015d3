// What a model file believes of a number, as a probability: value and tolerance make a prior.
//
//   const PriorForm form = prior_form(1.0, false);                // log-normal: 100 %, and never zero
//   prior_z(form, 8.0, 8.0, 80.0);                                // 3.3 standard deviations, not 9
//
// Up to a tolerance of 50 % the prior is normal, sigma = tolerance * value. From there on the number is known
// by its order of magnitude rather: log-normal, sigma of the logarithm ln(1 + tolerance), so that one
// tolerance up is one standard deviation either way of writing it (Gelman and others, Bayesian Data Analysis,
// 3rd ed. 2013, ch. 2: scale parameters). A number that may be zero (friction) cannot be log-normal: above
// its value it is, below it stays normal.
// Cannot: lower and upper tolerances that differ.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace omnihil {

enum class PriorForm : std::uint8_t { kNormal, kLogNormal, kLogNormalAbove };

// Tolerance from which a belief is one about the order of magnitude: there normal and log-normal differ by
// half a standard deviation at twice the value (1 / 0.5 = 2 and ln 2 / ln 1.5 = 1.7); a choice.
inline constexpr double kOrderOfMagnitude = 0.5;  // a choice

// Of the mean, in place of zero, whose logarithm is none: 30 standard deviations at a tolerance of 100 %.
inline constexpr double kLeastOfMean = 1e-9;  // a choice

inline PriorForm prior_form(double tolerance, bool may_be_zero) {
  if (tolerance < kOrderOfMagnitude) return PriorForm::kNormal;
  return may_be_zero ? PriorForm::kLogNormalAbove : PriorForm::kLogNormal;
}

inline bool is_logarithmic(PriorForm form, double mean, double x) {
  return mean > 0.0 && (form == PriorForm::kLogNormal || (form == PriorForm::kLogNormalAbove && x > mean));
}

// Prior deviation of x in standard deviations; `sigma` = tolerance * mean > 0.
inline double prior_z(PriorForm form, double mean, double sigma, double x) {
  if (!is_logarithmic(form, mean, x)) return (x - mean) / sigma;
  return std::log(std::max(x / mean, kLeastOfMean)) / std::log1p(sigma / mean);
}

// Its derivative by x, in 1 / the unit of x.
inline double prior_dz(PriorForm form, double mean, double sigma, double x) {
  if (!is_logarithmic(form, mean, x)) return 1.0 / sigma;
  return 1.0 / (std::max(x, kLeastOfMean * mean) * std::log1p(sigma / mean));
}

// The same of anything that carries its prior (Unknown, ParameterEstimate); 0 where it has none.
template <typename P>
double prior_z(const P& p, double x) {
  return p.prior_sigma > 0.0 ? prior_z(p.prior_form, p.prior_mean, p.prior_sigma, x) : 0.0;
}
template <typename P>
double prior_dz(const P& p, double x) {
  return p.prior_sigma > 0.0 ? prior_dz(p.prior_form, p.prior_mean, p.prior_sigma, x) : 0.0;
}

}  // namespace omnihil
