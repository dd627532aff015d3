// A rig: what is driven and what is measured of it. Each is a file of identify/rigs/, which says all of it; nothing else
// asks a rig for its name.
//
//   const Rig* rig = find_rig("wheel");                                       // null: there is none
//   rig->signals.front().name;                                                // "time"
//   std::unique_ptr<Predictor> p = make_predictor(dataset, nominal, {});      // by dataset.rig
//
// How to write one: docs/rigs.md; ./dev new rig NAME.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/record/signal_list.h"

namespace omnihil {

class Predictor;                       // identify/predict/predictor.h
struct PredictOptions;                 // the same
struct Candidate;                      // identify/predict/candidate.h
enum class Excitation : std::uint8_t;  // sim/bench/excitation.h

// What a virtual bench is to ask.
struct BenchDrive {
  Excitation excitation{};
  double amplitude = 0.0;  // as asked for
  double scale = 1.0;      // of the pattern: a held-out run has a smaller one
  double duration_s = 0.0;
  double rate_Hz = 0.0;
  std::uint64_t seed = 0;
};

// `omnihil sim --rig NAME`: the rig's own predictor makes the data, so that what it cannot, they do not show.
struct RigBench {
  // Those that are given first, in the order of `given`; then those that are measured, with the noise of usual sensors.
  std::vector<Channel> (*channels)(const Candidate& model);
  // What is given at a time; times increase from 0.
  std::function<std::vector<double>(double time_s)> (*given)(const Candidate& model, const BenchDrive& drive);
};

struct GivenSignal {
  std::string_view signal;
  std::string_view what;  // for a message that it is missing
};

struct Rig {
  std::string_view name;     // as the file format has it: the stem of its file
  std::string_view what;     // for help: "one drive"
  bool of_robot = false;     // its nominal model is a robot's, else an axis'
  bool whole_robot = false;  // that its wheels move, each with a number in its signals' names
  std::span<const SignalRow> signals;
  std::string_view drive_needed;         // where a run has no drive input: "duty is needed"
  std::string_view motion_needed;        // where it has no motion
  std::span<const GivenSignal> given{};  // what a run must have beside its drive input
  std::string_view no_plan = "";         // why no experiment can be planned; empty: one can
  std::unique_ptr<Predictor> (*make_predictor)(const Dataset& dataset, const Candidate& nominal,
                                               const PredictOptions& options) = nullptr;
  const RigBench* bench = nullptr;  // null: none, or one of its own (tools/benches/)
};

std::span<const Rig* const> all_rigs();      // by name
const Rig* find_rig(std::string_view name);  // null: there is none
std::string rig_choice();                    // "axis", "robot" or "wheel", in quotes
// The two that others stand on: what is made of an axis, and of a robot (import, twin).
const Rig& rig_axis();
const Rig& rig_robot();

}  // namespace omnihil
