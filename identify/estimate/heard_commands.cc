#include "identify/estimate/heard_commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "identify/estimate/fit.h"
#include "identify/record/parallel.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr int kRounds = 3;       // of fit and decisions; a choice, by cost
constexpr int kIterations = 12;  // of a fit; a choice, by cost
constexpr double kMostLost =
    0.2;  // of a run's commands: four times what radios are reported to lose; a choice

void take_out(const std::vector<std::size_t>& rows, Run& run) {
  for (auto& [name, values] : run.signals) {
    if (!name.starts_with("command_")) continue;
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

std::vector<LostPackets> decide(const Dataset& dataset, const std::vector<RobotRun>& runs,
                                const Candidate& model) {
  std::vector<LostPackets> out(runs.size());
  parallel_for(static_cast<int>(runs.size()), [&](int n) {
    const auto r = static_cast<std::size_t>(n);
    const Candidate own = with_known(model, dataset.runs[r].known);
    out[r] = lost_packets(rolling_values<double>({own}), runs[r]);
    if (out[r].share() > kMostLost) out[r].rows.clear();
  });
  return out;
}

HeardCommands all_heard(const Dataset& dataset) {
  return {.dataset = dataset, .lost = std::vector<LostPackets>(dataset.runs.size())};
}

HeardCommands without(const Dataset& dataset, std::vector<LostPackets> lost) {
  HeardCommands out{.dataset = dataset, .lost = std::move(lost)};
  for (std::size_t r = 0; r < out.lost.size(); ++r) take_out(out.lost[r].rows, out.dataset.runs[r]);
  return out;
}

// With a note per run.
HeardCommands said(HeardCommands heard) {
  heard.dataset.heard = true;
  for (std::size_t r = 0; r < heard.lost.size(); ++r) {
    const std::string sentence = sentence_of(heard.lost[r]);
    if (!sentence.empty()) heard.dataset.notes.push_back(heard.dataset.runs[r].file + ": " + sentence);
  }
  return heard;
}

// As they were sent; empty where there is no command to lose, or no motion of numbers alone to decide by.
std::vector<RobotRun> radio_runs(const Dataset& dataset, const Candidate& nominal) {
  std::vector<RobotRun> out;
  if (!dataset.rig->whole_robot || dataset.firmware || dataset.heard ||
      !rolling_params(nominal.file.parameters).has_controller)
    return out;
  for (const Run& run : dataset.runs) {
    const Candidate known = with_known(nominal, run.known);
    out.push_back(robot_run(dataset, run, rolling_params(known.file.parameters)));
    if (!out.back().record.radio) return {};
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

bool HeardCommands::same_lost(const HeardCommands& other) const {
  return std::equal(lost.begin(), lost.end(), other.lost.begin(), other.lost.end(),
                    [](const LostPackets& a, const LostPackets& b) { return a.rows == b.rows; });
}

std::size_t HeardCommands::lost_packets() const {
  std::size_t sum = 0;
  for (const LostPackets& l : lost) sum += l.rows.size();
  return sum;
}

HeardCommands heard_commands(const Dataset& dataset, const Candidate& nominal, const HeardOptions& options) {
  HeardCommands out = all_heard(dataset);
  const std::vector<RobotRun> sent = radio_runs(dataset, nominal);
  if (sent.empty()) return out;
  Candidate model = nominal;
  for (int round = 0; round < kRounds; ++round) {
    model = fit_base(out.dataset, nominal, model, options).model;
    if (options.stop && options.stop()) return all_heard(dataset);
    HeardCommands decided = without(dataset, decide(dataset, sent, model));
    const bool same = decided.same_lost(out);
    out = std::move(decided);
    if (same) break;
  }
  return said(std::move(out));
}

HeardCommands heard_by(const Dataset& sent, const Candidate& nominal, const Candidate& model) {
  const std::vector<RobotRun> runs = radio_runs(sent, nominal);
  return runs.empty() ? all_heard(sent) : said(without(sent, decide(sent, runs, model)));
}

}  // namespace omnihil
