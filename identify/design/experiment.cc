#include "identify/design/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "identify/design/experiment_distance.h"
#include "identify/design/experiment_menu.h"
#include "identify/design/experiment_truth.h"
#include "identify/estimate/fit_problem.h"
#include "identify/record/parallel.h"
#include "identify/record/rig.h"
#include "sim/model/rolling_model.h"
#include "sim/rolling/rolling_params.h"

namespace omnihil {
namespace {

// The design grid: choices of effort. A coarser grid proposes a worse run, never a wrong distance.
// Levels are steps of a factor of two to three down to where stiction holds a drive.
constexpr double kLevels[] = {1.0, 0.5, 0.2, 0.08, 0.03, 0.01};  // shares of the largest input; as above
constexpr int kRefitIterations = 3;        // Gauss-Newton; a choice, convergence is not checked
constexpr std::size_t kRefined = 3;        // best of the linear ranking, refitted in full; by cost
constexpr double kCoarseLongest_s = 10.0;  // within a diagnosis; by cost

struct Trial {
  std::size_t entry = 0;  // of the menu
  double level = 1.0;     // of the input
  double score = 0.0;     // separation in sigmas; of `shrink`: sigma before over sigma after
  std::string refused;
};

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

class Planner {
 public:
  Planner(const Dataset& dataset, const std::vector<Rival>& rivals, const ExperimentQuestion& question,
          const ExperimentOptions& options)
      : dataset_(dataset), rivals_(rivals), question_(question), options_(options) {}

  ExperimentPlan plan();

 private:
  bool prepare();
  bool prepare_question();
  bool by_command() const { return bench_.inputs.front().starts_with("command_"); }
  void prepare_rivals();
  void prepare_menu();
  PlannedInputs inputs(const Trial& t) const;
  std::string broken_limit(const MotionExtremes& m) const;
  double largest_level() const;
  double score(const Trial& t, int iterations) const;
  bool nests(std::size_t whole, std::size_t part) const;
  double separation(const Predictor& simulated_a, std::size_t a, std::size_t b, int iterations) const;
  std::vector<Trial> screen();
  void describe(const Trial& best);

  const Dataset& dataset_;
  const std::vector<Rival>& rivals_;
  const ExperimentQuestion& question_;
  const ExperimentOptions& options_;
  std::unique_ptr<Predictor> given_;
  std::vector<int> fit_runs_;
  SignalVariances variances_;
  std::vector<HeldModel> held_;  // rivals with the information of priors and given data
  Eigen::Index wanted_ = 0;      // the unknown whose sigma is to shrink
  PlannedBench bench_;
  std::vector<double> time_s_;
  std::vector<MenuRun> menu_;
  ExperimentPlan plan_;
};

bool Planner::prepare() {
  if (rivals_.empty() || (question_.shrink.empty() && rivals_.size() < 2)) {
    plan_.problem = "there are no two models to tell apart, and no parameter to shrink";
    return false;
  }
  given_ = make_predictor(dataset_, rivals_.front().model, {});
  bench_ = planned_bench(dataset_, rivals_.front().model, *given_);
  plan_.problem = bench_.problem;
  if (!plan_.problem.empty()) return false;
  for (int r = 0; r < given_->run_count(); ++r) {
    if (given_->run(r).split == Split::kTraining) fit_runs_.push_back(r);
  }
  prepare_rivals();
  if (!prepare_question()) return false;
  prepare_menu();
  return true;
}

void Planner::prepare_rivals() {
  for (const Rival& rival : rivals_) {
    HeldModel h{.model = rival.model, .unknowns = unknowns_of(rival.model), .center = {}, .hold = {}};
    h.center.resize(static_cast<Eigen::Index>(h.unknowns.size()));
    for (std::size_t i = 0; i < h.unknowns.size(); ++i) {
      h.center(static_cast<Eigen::Index>(i)) = h.unknowns[i].start;
    }
    FitProblem problem(*given_, h.model, h.unknowns, options_.jobs);
    h.hold = prior_hold(h.unknowns);
    if (!problem.empty() && problem.reweigh(h.center)) {
      for (const auto& [signal, weight] : problem.weights()) {
        double& variance = variances_[signal];
        const double own = weight.size * weight.size * weight.autocorrelation;
        variance = variance > 0.0 ? std::min(variance, own) : own;  // of the rival with less residual
      }
    }
    held_.push_back(std::move(h));
  }
  if (question_.shrink.empty() && held_.size() > 1) {
    // separation by the given data, with the priors alone as information
    double least = 1e300;
    for (std::size_t a = 0; a < held_.size(); ++a) {
      for (std::size_t b = 0; b < held_.size(); ++b) {
        if (a == b || nests(b, a)) continue;
        const Distance d = refitted_distance(*given_, fit_runs_, held_[a].model, held_[b], variances_, 1);
        least = std::min(least, d.sigmas);
      }
    }
    plan_.given_sigmas = least;
  }
  for (HeldModel& h : held_) h.hold += information_of(*given_, fit_runs_, h, variances_);
}

bool Planner::prepare_question() {
  if (question_.shrink.empty()) return true;
  const std::vector<Unknown>& u = held_.front().unknowns;
  const auto found =
      std::find_if(u.begin(), u.end(), [&](const Unknown& one) { return one.path == question_.shrink; });
  if (found == u.end()) {
    plan_.problem = fmt::format("{}: no parameter of this model that could move", question_.shrink);
    return false;
  }
  wanted_ = found - u.begin();
  plan_.sigma_before = sigma_of(held_.front().hold, wanted_);
  return true;
}

void Planner::prepare_menu() {
  const double duration_s =
      options_.coarse ? std::min(options_.limits.duration_s, kCoarseLongest_s) : options_.limits.duration_s;
  // Where commands drive, the record's own rows: nothing is said or told between them.
  const double own_Hz =
      by_command() ? 1.0 / std::max(median_period_s(bench_.example.time_s), 1e-3) : options_.rate_Hz;
  const double rate_Hz = std::min(options_.rate_Hz, own_Hz);
  const auto count = static_cast<std::size_t>(std::llround(duration_s * rate_Hz));
  for (std::size_t k = 0; k <= count; ++k) time_s_.push_back(static_cast<double>(k) / rate_Hz);
  if (bench_.inputs.front() == "command_vx") {
    menu_ = body_menu(time_s_, options_.seed);
  } else if (dataset_.rig->whole_robot) {
    const RollingParams<double> p = rolling_params(rivals_.front().model.file.parameters);
    menu_ = robot_menu(time_s_, std::span(p.wheel_angle_rad).first(p.wheels), options_.seed);
  } else {
    menu_ = axis_menu(time_s_, options_.seed);
  }
}

double Planner::largest_level() const {
  const bool by_voltage =
      !bench_.imposed && !by_command() && bench_.inputs.front() != "position_target" && bench_.supply_V > 0.0;
  const double share = options_.limits.voltage_V > 0.0 && by_voltage
                           ? std::min(1.0, options_.limits.voltage_V / bench_.supply_V)
                           : 1.0;
  return share * bench_.full_input;
}

PlannedInputs Planner::inputs(const Trial& t) const {
  PlannedInputs in{.time_s = time_s_, .drive = menu_[t.entry].drive};
  for (std::size_t i = 0; i < in.drive.size(); ++i) {
    const double scale = t.level * (bench_.input_scale.empty() ? 1.0 : bench_.input_scale[i]);
    for (double& v : in.drive[i]) v *= scale;
  }
  return in;
}

// "" or the first limit that the simulated run would pass.
std::string Planner::broken_limit(const MotionExtremes& m) const {
  ExperimentLimits l = options_.limits;
  if (bench_.imposed && l.travel <= 0.0)
    l.travel = bench_.most_travel;  // what the bench has room for, as far as is known
  const bool linear = dataset_.linear, robot = dataset_.rig->whole_robot;
  if (!m.finite) return "the simulated run diverges";
  if (l.current_A > 0.0 && m.current_A > l.current_A)
    return fmt::format("{:.3g} A, allowed are {:.3g} A", m.current_A, l.current_A);
  if (l.speed_rad_s > 0.0 && m.rotor_speed_rad_s > l.speed_rad_s) {
    return fmt::format("{:.3g} {}, allowed are {:.3g}", m.rotor_speed_rad_s,
                       linear ? "m/s" : "rad/s at the rotor", l.speed_rad_s);
  }
  if (l.travel > 0.0 && m.travel > l.travel) {
    return fmt::format("{:.3g} {} from the start, allowed are {:.3g}", m.travel,
                       linear || robot ? "m" : "rad at the output", l.travel);
  }
  return "";
}

// A model that has all effects of another nests it and can be fitted to whatever that one does: the distance
// of that pair is zero by construction and says nothing.
bool Planner::nests(std::size_t whole, std::size_t part) const {
  const std::vector<EffectUse>& all = held_[whole].model.effects;
  const std::vector<EffectUse>& some = held_[part].model.effects;
  return std::all_of(some.begin(), some.end(), [&](const EffectUse& e) {
    return std::any_of(all.begin(), all.end(),
                       [&](const EffectUse& f) { return effect_name(f) == effect_name(e); });
  });
}

double Planner::separation(const Predictor& simulated, std::size_t a, std::size_t b, int iterations) const {
  const Distance d = refitted_distance(simulated, {0}, held_[a].model, held_[b], variances_, iterations);
  return d.finite ? d.sigmas : 0.0;
}

// Smallest distance of any pair of rivals, in the smaller of its two directions (either one is the truth);
// with no iterations, for ranking, in one direction alone.
double Planner::score(const Trial& t, int iterations) const {
  const PlannedInputs in = inputs(t);
  if (!question_.shrink.empty()) {
    const auto simulated = simulated_truth(bench_, in, held_.front().model, options_.seed);
    const Eigen::MatrixXd all =
        held_.front().hold + information_of(*simulated, {0}, held_.front(), variances_);
    return plan_.sigma_before / sigma_of(all, wanted_);
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < held_.size(); ++a) {
    std::unique_ptr<Predictor> simulated;
    for (std::size_t b = 0; b < held_.size(); ++b) {
      const bool counts = a != b && !nests(b, a) && (iterations > 0 || a < b || nests(a, b));
      if (!counts) continue;
      if (!simulated) simulated = simulated_truth(bench_, in, held_[a].model, options_.seed);
      least = std::min(least, separation(*simulated, a, b, iterations));
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

// The menu at all levels within the limits, best first.
std::vector<Trial> Planner::screen() {
  std::vector<Trial> trials;
  for (std::size_t e = 0; e < menu_.size(); ++e) {
    for (const double level : kLevels) {
      if (options_.coarse && (level == kLevels[1] || level == kLevels[3] || level == kLevels[5])) continue;
      trials.push_back({.entry = e, .level = level * largest_level(), .score = 0.0, .refused = {}});
    }
  }
  const int batch = std::max(1, 4 * options_.jobs);
  for (std::size_t first = 0; first < trials.size(); first += static_cast<std::size_t>(batch)) {
    const auto count = std::min<std::size_t>(static_cast<std::size_t>(batch), trials.size() - first);
    parallel_for(options_.jobs, static_cast<int>(count), [&](int k) {
      Trial& t = trials[first + static_cast<std::size_t>(k)];
      for (const HeldModel& h : held_) {
        if (t.refused.empty()) t.refused = broken_limit(planned_extremes(bench_, inputs(t), h.model));
      }
      if (t.refused.empty()) t.score = score(t, 0);
    });
    const double share = static_cast<double>(first + count) / static_cast<double>(trials.size());
    if (options_.progress && !options_.progress({.doing = "trying excitations", .share = 0.9 * share})) {
      trials.resize(first + count);
      break;
    }
  }
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.score > b.score; });
  return trials;
}

void Planner::describe(const Trial& best) {
  const MenuRun& run = menu_[best.entry];
  const bool by_target = bench_.inputs.front() == "position_target";
  const std::string unit = dataset_.linear ? "m" : "rad";
  const std::string level =
      bench_.imposed
          ? fmt::format("{:.3g} {}/s and {:.3g} {}/s2", best.level, unit, bench_.most_acceleration, unit)
      : by_target    ? fmt::format("{:.3g} rad", best.level)
      : by_command() ? fmt::format("{:.3g} {}", best.level, bench_.input_scale.empty() ? "rad/s" : "m/s")
                     : percent(best.level / std::max(bench_.full_input, 1e-12)) + " of full duty";
  const double duration_s = time_s_.back();
  plan_.run = PlannedRun{.excitation = run.excitation,
                         .words = fmt::format("{}; up to {}, {:.3g} s", run.words, level, duration_s),
                         .input = dataset_.rig->whole_robot && !by_command() ? "duty" : bench_.inputs.front(),
                         .time_s = time_s_,
                         .duty = bench_.imposed
                                     ? std::vector<std::vector<double>>{imposed_speed(bench_, inputs(best))}
                                     : inputs(best).drive};
  NextExperiment& next = plan_.next;
  if (!question_.shrink.empty()) {
    plan_.sigma_after = plan_.sigma_before / best.score;
    next.what =
        fmt::format("Run \"{}\" ({}): {} would be known to +-{:.3g} instead of +-{:.3g}.", run.excitation,
                    plan_.run->words, question_.shrink, plan_.sigma_after, plan_.sigma_before);
    next.separates = {question_.shrink};
    return;
  }
  plan_.expected_sigmas = next.expected_sigmas = best.score;
  for (const Rival& rival : rivals_) next.separates.push_back(rival.name);
  std::string names;
  for (std::size_t i = 0; i < rivals_.size(); ++i) {
    names += (i == 0 ? "" : i + 1 == rivals_.size() ? " from " : ", ") + rivals_[i].name;
  }
  next.what = fmt::format(
      "Run \"{}\" ({}): it would tell {} by {:.3g} sigmas. The given data do by {:.2g}, the usual steps "
      "would by "
      "{:.2g}.",
      run.excitation, plan_.run->words, names, plan_.expected_sigmas, plan_.given_sigmas,
      plan_.generic_sigmas);
}

ExperimentPlan Planner::plan() {
  if (!prepare()) return std::move(plan_);
  std::vector<Trial> trials = screen();
  std::vector<Trial> allowed;
  for (const Trial& t : trials) {
    if (t.refused.empty()) allowed.push_back(t);
  }
  if (allowed.empty()) {
    plan_.problem = "no excitation stays within the limits: at its least level " +
                    (trials.empty() ? std::string("none was tried") : trials.back().refused);
  } else {
    // the usual steps at the highest level that is allowed, and the best few, in full
    auto usual = allowed.end();
    for (auto t = allowed.begin(); t != allowed.end(); ++t) {
      if (t->entry == 0 && (usual == allowed.end() || t->level > usual->level)) usual = t;
    }
    std::vector<Trial> final(
        allowed.begin(), allowed.begin() + static_cast<std::ptrdiff_t>(std::min(kRefined, allowed.size())));
    if (usual != allowed.end()) final.push_back(*usual);
    parallel_for(options_.jobs, static_cast<int>(final.size()), [&](int k) {
      Trial& t = final[static_cast<std::size_t>(k)];
      t.score = score(t, kRefitIterations);
    });
    if (usual != allowed.end()) plan_.generic_sigmas = final.back().score;
    const Trial best = *std::max_element(final.begin(), final.end(),
                                         [](const Trial& a, const Trial& b) { return a.score < b.score; });
    describe(best);
    for (const HeldModel& h : held_) {
      const MotionExtremes m = planned_extremes(bench_, inputs(best), h.model);
      plan_.largest_current_A = std::max(plan_.largest_current_A, m.current_A);
      plan_.largest_speed_rad_s = std::max(plan_.largest_speed_rad_s, m.rotor_speed_rad_s);
      plan_.largest_travel = std::max(plan_.largest_travel, m.travel);
    }
  }
  for (const Trial& t : trials) {
    plan_.tried.push_back({.excitation = menu_[t.entry].excitation,
                           .words = fmt::format("{}; {:.3g}", menu_[t.entry].words, t.level),
                           .sigmas = t.score,
                           .refused = t.refused});
  }
  return std::move(plan_);
}

}  // namespace

ExperimentPlan plan_experiment(const Dataset& dataset, const std::vector<Rival>& rivals,
                               const ExperimentQuestion& question, const ExperimentOptions& options) {
  return Planner(dataset, rivals, question, options).plan();
}

NextExperiment propose_experiment(const Dataset& dataset, const std::vector<Rival>& rivals,
                                  const ExperimentOptions& options) {
  ExperimentOptions coarse = options;
  coarse.coarse = true;
  return plan_experiment(dataset, rivals, {}, coarse).next;
}

}  // namespace omnihil
