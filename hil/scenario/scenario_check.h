// What a run is held to: each check measured, wheel by wheel where it has wheels.
//
//   for (const CheckResult& r : check_scenario(scenario, run)) if (!r.passed) std::cout << r.name << r.measured_text();
//
// Measures, of a signal y with commanded value r (at the window's end) and start y_0 (at from_s):
//   rise_time       first t with (y - y_0) / (r - y_0) >= 0.9, less from_s
//   overshoot       max (y - r) sgn(r - y_0) / |r - y_0|, at least 0
//   settling_time   first t after which |y - r| <= band |r - y_0| to the end, less from_s
//   steady_error    |mean(y - r)| / |r| over the last fifth (of |r - y_0| where r is 0)
//   wind_up         max (y - r) sgn(r) / |r| from the release on, at least 0
//   wheel_order     the order p of the wheels that has the least sum of (|mean y_w| - |mean r_p(w)|)^2 over the last
//                   half is their own, and no wheel is further off than half the smallest difference of two |r|
// Sampled at the firmware's control periods: what lies between two is not seen.
#pragma once
#include <string>
#include <vector>

#include "hil/scenario/scenario.h"
#include "hil/scenario/scenario_run.h"

namespace omnihil {

struct CheckResult {
  std::string name;  // "rise_time", or the signal of a `signal` check
  int line = 0;      // in the scenario's file
  int wheel = -1;    // -1: of the robot
  bool passed = false;
  bool reached = true;                      // false: the run broke off before its window was over
  std::optional<double> measured, allowed;  // none: it never came to it
  bool at_least = false;                    // `allowed` is the least
  std::string unit;
  double at_s = 0.0;  // instant of the measured value
  double from_s = 0.0, to_s = 0.0;
  std::string note;                  // in words, where numbers do not say it
  std::vector<std::string> signals;  // to plot

  std::string measured_text() const;  // "0.082 s", "never"
  std::string allowed_text() const;   // "at most 0.3 s"
};

// A run that broke off fails the check "runs_to_the_end" besides all it did not get to.
std::vector<CheckResult> check_scenario(const Scenario& scenario, const ScenarioRun& run);

}  // namespace omnihil
