// The longitudinal tyre curve of a robot from a recording of straight pushes, with what it cannot tell.
//
//   TyreIdentification t = identify_tyre(dataset, nominal, {.jobs = 2});
//   if (t.faults.empty()) t.numbers[1].value;          // extremum_value, with sigma and 90 % interval
//
// First the paper's way (tyre_points.h): a cloud of force over slip, and a curve through it. Then the whole robot is run
// forward with that curve as a start and every number of the model that has a tolerance free, among them wheel radius,
// mass and motor constants (fit.h): there, slip is what the motion needs, so that errors of measured slip do not flatten
// the curve. What the forward model leaves decides: more than kWorst_sigmas in the mean, and the points' own figures
// are the answer: the grip that the wheels carried without sliding and an upper bound on the slip there.
// Cannot: the lateral curve beyond what the fit moves of it; a curve of another form than tyre.h's (kWorst_sigmas says
// so); forces that no run came near: then the largest force is a lower bound, and said to be.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "identify/estimate/fit.h"
#include "identify/tyre/tyre_curve_fit.h"

namespace omnihil {

enum class TyreOutcome : std::uint8_t {
  kCurve,      // all of it, by the forward fit
  kGripAlone,  // largest grip and an upper bound of its slip
  kNoPeak,     // no run came near the largest grip: it is at least this
  kNothing,    // see faults
};

struct TyreNumber {
  std::string path;  // "tyre.longitudinal.extremum_slip"
  double value = 0.0, sigma = 0.0;
  double from = 0.0, to = 0.0;  // 90 %
  bool determined = true;
};

struct TyreIdentification {
  static constexpr double kWorst_sigmas =
      2.0;  // a choice: rms over the motion's signals, each by its noise: 1 is perfect
  TyreOutcome outcome = TyreOutcome::kNothing;
  std::vector<std::string> faults;  // why nothing, each with what would help
  TyrePoints points;
  TyreCurveFit by_points;
  StickingGrip sticking;
  std::array<TyreNumber, 4> numbers;  // kCurve: extremum slip and value, asymptote slip and value
  FitResult fit;                      // of kCurve; else of the attempt
  double pooled_sigmas = 0.0;         // what the forward fit leaves on the fit runs
  double most_ratio = 0.0;            // largest force over load that the points show
  std::string sentence;

  TyreCurve curve() const;  // of the outcome
  // Half width of the 90 % band of the curve at this slip, from the fit's covariance; 0 where there is none.
  double band(double slip) const;
};

TyreIdentification identify_tyre(const Dataset& dataset, const Candidate& nominal, const FitOptions& options);

}  // namespace omnihil
