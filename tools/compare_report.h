// What `omnihil compare` found: as a table for people, as JSON for programs.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "identify/compare/clock_offset.h"
#include "identify/compare/comparison.h"
#include "identify/compare/tube.h"
#include "identify/select/diagnosis.h"

namespace omnihil {

struct CompareReport {
  std::string dataset;
  std::string model;  // as asked for; empty: the dataset's own
  Method method = Method::kForward;
  std::vector<std::string> notes;
  std::vector<DataFinding> findings;
  std::vector<std::string> run_files;
  Comparison comparison;
  std::vector<std::string> left_out;                         // samples of signals, and why
  std::vector<std::pair<std::string, ClockOffset>> offsets;  // per signal
  std::vector<std::pair<Split, double>> force_errors;        // relative; torque-driven axes
  std::vector<std::pair<Tube, TubeResult>> tubes;
  bool per_run = false;

  bool outside() const;  // of some tube
};

std::string compare_text(const CompareReport& report);
std::string compare_json(const CompareReport& report);  // "omnihil-comparison/1"

}  // namespace omnihil
