// The options with which `serve` opens the league's ports.
//
//   add_league_options(verb, words);
//   const auto league = league_options(words, seed, epoch_ms, problems);     // nothing when --league was not given
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/league/league_host.h"
#include "tools/command_line.h"

namespace omnihil {

struct LeagueWords {
  bool on = false;
  LeagueOptions options;
  std::string vision;  // GROUP:PORT, or "off"
  std::string real;    // GROUP:PORT
  std::string grsim;   // COMMANDS or COMMANDS,BLUE,YELLOW
  double delay_least_ms = 0.0, delay_most_ms = 0.0;
  double position_sigma_mm = 0.0, clock_sigma_ms = 0.0, askew_mm = 0.0;
  int sync_port = 0;
};

void add_league_options(Verb& verb, LeagueWords& words);

// What is wrong goes to `problems`, a line each.
std::optional<LeagueOptions> league_options(const LeagueWords& words, std::uint64_t seed,
                                            std::uint64_t epoch_ms, std::vector<std::string>& problems);

}  // namespace omnihil
