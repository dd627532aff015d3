// Optimal experiment design: the excitation that best tells rival models apart, or that most reduces a
// parameter's uncertainty, within what the user's bench allows.
//
//   ExperimentPlan plan = plan_experiment(dataset, {{"stribeck_friction", a}, {"dead_time", b}}, {}, options);
//   plan.run->time_s; plan.run->duty[0];
//   plan.expected_sigmas; plan.given_sigmas; plan.generic_sigmas;
//   NextExperiment next = propose_experiment(dataset, rivals, options);     // its sentence alone
//
// Every excitation of a menu (experiment_menu.h) is simulated with one rival as the truth, and the other is
// refitted to it: the remaining residual, in units of the noise, is their separation by the run. Refitted:
// all its unknowns are free, with their priors and the given data's information on them:
//     d^2 = min over x of |(y_truth - y_rival(x)) / s|^2 + (x - x_given)' P (x - x_given)
// by Gauss and Newton, P the information of the given data with the priors. The smaller of the two directions
// counts, but for a model that nests the other: refitted, it predicts whatever that one does. s is the noise,
// or the rms residual of the fitted models in the given data if that is more. For a parameter (`shrink`): its
// sigma after the run, sqrt of its entry in (P + J' J)^-1 (c-optimality). Source: Hunter and Reiner 1965
// (discrimination by the distance of refitted predictions); Ljung 1999 sec. 13. Cannot: plan what needs other
// sensors, other loads or another supply; the answer is as good as the rivals.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"
#include "identify/record/progress.h"

namespace omnihil {

struct NextExperiment {
  std::string what;  // one sentence
  std::string
      command;  // that plans it on this bench, run by run within its limits; empty: nothing to be planned
  std::vector<std::string> separates;
  double expected_sigmas = 0.0;  // distance of the rivals' predictions in it, simulated; 0: not computed
};

struct Rival {
  std::string name;  // effect, or what the model is
  Candidate model;   // fitted to the given data, its beliefs noted (fit_note.h)
};

// 0: no limit but the drive's own.
struct ExperimentLimits {
  double voltage_V = 0.0;
  double current_A = 0.0;    // of one motor
  double speed_rad_s = 0.0;  // of the rotor; of a linear axis m/s
  double travel =
      0.0;  // from the start, in either direction: rad at the output, m of a linear axis or a robot
  double duration_s = 20.0;
};

struct ExperimentQuestion {
  std::string
      shrink;  // unknown of the first rival, by path, to be estimated better; empty: separate the rivals
};

struct ExperimentOptions {
  ExperimentLimits limits;
  double rate_Hz = 1000.0;
  int jobs = 1;
  std::uint64_t seed = 1;
  bool coarse = false;                            // a short menu, no refinement: within a diagnosis
  std::function<bool(const Progress&)> progress;  // false: stop with the best so far
};

// The drive's input over time; of a robot, all four.
struct PlannedRun {
  std::string excitation;  // "creep", …
  std::string words;       // "ramps slowly through zero, ±10 % duty, 16 s a period"
  // Or "motor_voltage", "position_target", as the given data have it; "velocity": of a bench that imposes the motion;
  // "command_vx": m/s ahead, m/s to the left, rad/s; "command_wheel_1": rad/s of four wheels.
  std::string input = "duty";
  std::vector<double> time_s;             // n samples
  std::vector<std::vector<double>> duty;  // [drive][sample] in the input's unit; one drive, or one per wheel
};

struct TriedRun {
  std::string excitation;
  std::string words;
  double sigmas = 0.0;  // of separation; of `shrink`: sigma before over sigma after
  std::string refused;  // which limit the simulated run would break; empty: none
};

struct ExperimentPlan {
  NextExperiment next;
  std::optional<PlannedRun> run;  // none: every one was refused, or there are no rivals to separate
  double expected_sigmas = 0.0;
  double generic_sigmas = 0.0;  // of the usual steps within the same limits
  double given_sigmas = 0.0;    // in the given data
  // of `shrink`
  double sigma_before = 0.0, sigma_after = 0.0;
  double largest_current_A = 0.0, largest_speed_rad_s = 0.0, largest_travel = 0.0;  // simulated
  std::vector<TriedRun> tried;                                                      // the best first
  std::string problem;                                                              // why there is no run
};

ExperimentPlan plan_experiment(const Dataset& dataset, const std::vector<Rival>& rivals,
                               const ExperimentQuestion& question, const ExperimentOptions& options);

// The plan's sentence and expected separation alone, from a coarse menu.
NextExperiment propose_experiment(const Dataset& dataset, const std::vector<Rival>& rivals,
                                  const ExperimentOptions& options);

}  // namespace omnihil
