// The steps and checks there are: one row each, for the reader, the help and the reports.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "hil/scenario/scenario.h"

namespace omnihil {

struct StepRow {
  StepKind kind;
  std::string_view word;  // `do = "…"`
  bool lasts;             // has for_s
  bool of_wheels;         // has wheels
  std::string_view keys;  // its own, with a space between
  std::string_view what;
  std::string_view example;
};

struct CheckRow {
  CheckKind kind;
  std::string_view word;    // `is = "…"`
  std::string_view suffix;  // of its limit: at_most_<suffix>; empty: that of the signal, or none
  std::string_view unit;    // as printed
  bool of_wheels;           // judged wheel by wheel; else once
  bool follows_step;        // looks at a signal that a command moves: from_s is the command's instant
  std::string_view keys;    // its own besides from_s, to_s, wheels, at_most_…
  std::string_view what;
};

std::span<const StepRow> step_rows();
std::span<const CheckRow> check_rows();
const StepRow& row_of(StepKind kind);
// Of the steps that break the chip.
std::optional<ChipFaultKind> chip_fault_kind(std::string_view word);
std::string_view chip_fault_word(ChipFaultKind kind);
const CheckRow& row_of(CheckKind kind);

}  // namespace omnihil
