#include "identify/estimate/heard_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/estimate/fit.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr int kRounds = 3;       // of fit and decisions, by cost
constexpr int kIterations = 12;  // of a fit, as a refit of the ranking has
constexpr double kMostLost =
    0.2;  // of a run's commands; a choice, four times what radios are reported to lose
constexpr const char* kCommand = "command_";

bool says_commands_alone(const Run& run) {
  return run.signal("duty_1") == nullptr &&
         std::any_of(run.signals.begin(), run.signals.end(),
                     [](const auto& s) { return s.first.starts_with(kCommand); });
}

void take_out(const std::vector<std::size_t>& rows, Run& run) {
  for (auto& [name, values] : run.signals) {
    if (!name.starts_with(kCommand)) continue;
    for (const std::size_t k : rows) values[k] = kMissing;
  }
}

FitResult fit_base(const Dataset& dataset, const Candidate& nominal, const Candidate& start,
                   const HeardOptions& options) {
  std::vector<Unknown> unknowns = unknowns_of(nominal);
  for (Unknown& u : unknowns) u.start = value_at(start, u.path).value_or(u.start);
  FitOptions o;
  o.jobs = options.jobs;
  o.max_iterations = kIterations;
  o.coarse = true;
  o.stop = options.stop;
  return fit(*make_predictor(dataset, nominal, {}), start, unknowns, o);
}

std::vector<LostPackets> decide(const Dataset& dataset, const Candidate& nominal, const Candidate& model) {
  std::vector<LostPackets> out;
  for (const Run& run : dataset.runs) {
    const Candidate known = with_known(nominal, run.known), own = with_known(model, run.known);
    LostPackets lost = lost_packets(rolling_values<double>({own}),
                                    robot_run(dataset, run, rolling_params(known.file.parameters)));
    if (lost.share() > kMostLost) lost.rows.clear();
    out.push_back(std::move(lost));
  }
  return out;
}

}  // namespace

std::string sentence_of(const LostPackets& lost) {
  if (lost.rows.empty()) return "";
  return fmt::format(
      "{} of {} commands that say something new did not reach the robot, by what its wheels did: they are "
      "left out",
      lost.rows.size(), lost.tried);
}

std::size_t HeardCommands::lost_packets() const {
  std::size_t sum = 0;
  for (const LostPackets& l : lost) sum += l.rows.size();
  return sum;
}

HeardCommands heard_commands(const Dataset& dataset, const Candidate& nominal, const HeardOptions& options) {
  HeardCommands out{.dataset = dataset, .lost = std::vector<LostPackets>(dataset.runs.size())};
  if (!dataset.rig->whole_robot || dataset.firmware ||
      !rolling_params(nominal.file.parameters).has_controller ||
      !std::all_of(dataset.runs.begin(), dataset.runs.end(), says_commands_alone))
    return out;
  Candidate model = nominal;
  for (int round = 0; round < kRounds; ++round) {
    model = fit_base(out.dataset, nominal, model, options).model;
    if (options.stop && options.stop())
      return {.dataset = dataset, .lost = std::vector<LostPackets>(dataset.runs.size())};
    std::vector<LostPackets> lost = decide(dataset, nominal, model);
    const bool same = std::equal(lost.begin(), lost.end(), out.lost.begin(),
                                 [](const LostPackets& a, const LostPackets& b) { return a.rows == b.rows; });
    out.lost = std::move(lost);
    out.dataset = dataset;
    for (std::size_t r = 0; r < out.lost.size(); ++r) take_out(out.lost[r].rows, out.dataset.runs[r]);
    if (same) break;
  }
  for (std::size_t r = 0; r < out.lost.size(); ++r) {
    const std::string sentence = sentence_of(out.lost[r]);
    if (!sentence.empty()) out.dataset.notes.push_back(dataset.runs[r].file + ": " + sentence);
  }
  return out;
}

}  // namespace omnihil
