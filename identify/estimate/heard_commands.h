// A robot's measurement with the commands that it heard in place of those that its host sent.
//
//   HeardCommands heard = heard_commands(dataset, nominal, {.jobs = 2});
//   diagnose(heard.dataset, nominal, {});
//   heard.lost[run].rows;                     // rows whose command was taken out
//
// packet_loss.h decides which were lost by the model's wheel speeds, so the base parameters (latency first of all) are fitted
// before: fit and decisions in turn, until they stay. Where more than a fifth would be lost in a run, the model explains too
// little to tell: then all are taken as heard. Datasets without radio commands, with a firmware in the loop, or that have been
// through this stay as they are.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "identify/estimate/packet_loss.h"
#include "identify/predict/candidate.h"

namespace omnihil {

// For a person; empty: none was lost.
std::string sentence_of(const LostPackets& lost);

struct HeardOptions {
  int jobs = 1;
  std::function<bool()> stop{};  // true: end early, all taken as heard
};

struct HeardCommands {
  Dataset dataset;                // with a note per run that lost some
  std::vector<LostPackets> lost;  // one per run

  std::size_t lost_packets() const;
  bool same_lost(const HeardCommands& other) const;
};

HeardCommands heard_commands(const Dataset& dataset, const Candidate& nominal, const HeardOptions& options);
// By a model that is fitted already, with effects that heard_commands() did not know; `sent`: as they were sent.
HeardCommands heard_by(const Dataset& sent, const Candidate& nominal, const Candidate& model);

}  // namespace omnihil
