// Are the parameters of a fitted addition such as a drive can have, and the base parameters such as their
// priors say?
//
//   std::string why = implausibility(parent.fit, child.fit, "cogging", false);   // empty: nothing against it
//
// Against it: a shape estimated at its bound, a phase of which the data know nothing, a sign that is not physical, a
// strength that is not significantly different from neutral (alone or jointly, Wald), a base parameter moved out of the tolerance
// that the model file states. Prior deviations are z-scores: (estimate - prior mean) / prior standard
// deviation.
#pragma once
#include <string>
#include <string_view>

#include "identify/estimate/fit.h"

namespace omnihil {

// The identifiable base parameter (motor, load, supply) that is farthest from its prior.
struct PriorDeviation {
  double sigmas = 0.0;  // absolute
  std::string path;
};
PriorDeviation largest_prior_deviation(const FitResult& fit);

// A base parameter whose prior deviation exceeds kImplausible (two-sided p = 6e-5) is suspected of absorbing
// a missing effect. An addition that brings it back within kRestored (p = 5 %), without raising the residual
// energy by more than kMostEnergyRise, is accepted as that effect. Sizes tuned on the open cases, DECISIONS
// 50; sensitivity not measured.
inline constexpr double kImplausible_sigmas = 4.0;  // tuned
inline constexpr double kRestored_sigmas = 2.0;     // tuned
inline constexpr double kMostEnergyRise = 0.01;     // tuned

// Where data cannot separate an effect from a base parameter (a payload from the mass), the priors decide:
// the effect is preferred if the base parameter's one-sided prior p-value is below 1 % (the normal
// distribution's 99 % quantile: derived, DECISIONS 56) and the total prior chi-square falls by at least the
// square of that.
inline constexpr double kPriorRejected_sigmas = 2.33;  // derived

// Absolute prior deviation of one parameter; 0: no such parameter, or it has no prior. From its value, since
// ParameterEstimate::prior_deviation_sigmas is 0 where the data do not determine a parameter.
double prior_deviation(const FitResult& fit, std::string_view path);

// Is some base parameter farther than kImplausible from its prior?
bool is_implausible(const FitResult& fit);
// Is this one farther than kPriorRejected?
bool is_prior_rejected(const FitResult& fit, std::string_view path);

// The base parameter that the child restores to its prior: the parent's largest deviation with all others
// within kRestored, or `aliased_parameter` (Screened::aliased_parameter; empty: none) by the rule of
// kPriorRejected. Empty: none.
std::string restores_prior(const FitResult& parent, const FitResult& child,
                           std::string_view aliased_parameter = {});

// What these data can tell apart in time and angle.
struct Resolution {
  double rate_Hz = 0.0;                // of the samples; 0: unknown
  double loop_period_s = 0.0;          // Capabilities::loop_period_s; 0: none
  double counts_per_rotor_turn = 0.0;  // of the encoder, seen on the rotor; 0: none
};

// Is an effect's time (a delay, an inductance over a resistance) or angle (a play) so far below what its page calls visible at
// this sampling rate and encoder that the model's sub-steps and the time stamps' resolution amount to as much? Or a time
// below a period of the described speed loop? Empty: no.
std::string below_resolution(const FitResult& child, const std::string& name, const Resolution& of);

// A parameter of the effect that ends at a bound as no result does (a strength away from neutral, a shape that is
// neither periodic nor a choice of form). Empty: none.
std::string ends_at_bound(const FitResult& child, const std::string& name);

// A number of the parent that the addition moves out of its tolerance or to a bound. `base`: before any effect was found; null: the
// parent is that.
struct MovedNumber {
  std::string path;
  std::string why;  // "it moves motor.viscous_friction_Nm_s_per_rad to its bound (-3.3 sigma, before +0.5)"
};
std::vector<MovedNumber> moved_numbers(const FitResult& parent, const FitResult& child, bool decisive,
                                       const FitResult* base);

// `decisive`: skip the significance test of the strength; the gain alone proves it, even if strength and
// shape are correlated. `base`: as above.
std::string implausibility(const FitResult& parent, const FitResult& child, const std::string& name,
                           bool decisive, const FitResult* base = nullptr);

}  // namespace omnihil
