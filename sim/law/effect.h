// What is known about one physical effect that a drive or a robot may have: everything but its law.
//
//   const EffectEntry* e = find_effect("cogging");            // effect_registry.h
//   e->info->equation;                                        // "tau += sum_k A_k sin(k n theta + p_k)"
//   e->info->params[0].unit;                                  // "N m"
//
// One effect is one file in sim/effects/; how to write one: docs/effects/README.md.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sim/law/demands.h"
#include "sim/law/effect_param.h"

namespace omnihil {

// Where an effect acts, in the order in which a step meets them.
enum class Place : std::uint8_t {
  kCommand,  // what is asked of the drive: duty, voltage, torque, position target
  kSupply,   // bus voltage
  kBridge,   // mean voltage at the winding, current limit
  kWinding,  // resistance, inductance, torque and back-EMF constant
  kTorque,   // torques and friction on the rotor
  kShaft,    // play and compliance between rotor and output
  kContact,  // wheel on floor
  kBody,     // forces on the robot, its mass
  kSensor,   // what encoders and sensors see
  kTiming,   // how old a measurement is
};
inline constexpr int kPlaces = 10;
std::string_view place_name(Place place);

struct EffectState {
  std::string_view name;
  std::string_view unit;
  double initial = 0.0;
};

// Properties that a test holds against every effect that claims them.
enum ClaimBit : std::uint32_t {
  kClaimNone = 0,
  kDissipative = 1u << 0,   // never adds energy to the mechanism
  kOdd = 1u << 1,           // speed, current, voltage and torque reversed: the effect reversed
  kConservative = 1u << 2,  // its torque does no work over a turn
  kRandom = 1u << 3,        // draws random numbers: needs a seed
  // At neutral no signal changes with its strength to first order (a limit that nothing reaches, a square).
  // A fit that starts there alone never leaves: give it a second start away from neutral.
  kFlatAtNeutral = 1u << 4,
  kCountsPulses = 1u << 5,  // makes a speed of pulses; its first parameter says how many there are in a turn
  kWarmsWinding = 1u << 6,  // gives the winding a temperature of its own
};

// What a numerical treatment has to know of a law, besides its equation.
enum NumericsBit : std::uint32_t {
  kNumericsPlain = 0,
  kStiff = 1u << 0,        // faster than a millisecond: short sub-steps
  kFine = 1u << 1,         // changes within a sample: many times a turn, or a part of a sample late
  kImpacts = 1u << 2,      // parts meet and leave: exact derivatives multiply up from one impact to the next
  kDelays = 1u << 3,       // its strength is a delay of the command
  kHidesDelays = 1u << 4,  // a limit behind a delay: the delay's derivative is zero behind it
  // Looks at the motor's torque, which inverse dynamics then has to solve for (sim/drive/needed_torque.h).
  kReadsMotorTorque = 1u << 5,
  // A bridge's voltage that depends on the current it drives: solved with the winding (sim/drive/implicit_current.h).
  kReadsCurrent = 1u << 6,
};

enum RigsBit : std::uint32_t { kOnAxis = 1u << 0, kOnRobot = 1u << 1, kOnBoth = 3u };

// The shaft by whose angle a law repeats itself, with one phase for all runs: what does not tell that angle does not
// show the law (identify/select/angle_resolution.h). Not of sensors that need the angle themselves.
enum class LawOfAngle : std::uint8_t { kNone, kRotor, kOutput };

// How good the sensors are, for the smallest size of an effect that they can show.
struct SensorSet {
  double counts_per_turn = 4096;  // encoder on the rotor
  double rate_Hz = 1000;
  double current_sigma_A = 0.03;
  double voltage_sigma_V = 0.02;
  double duration_s = 20;
};

// Which picture shows the effect best: y over x of a simulated axis, with the effect and without.
struct EffectPlot {
  // sim/bench/excitation.h; or "turn", "locked", "stall", "servo" (sim/pages/effect_picture.cc)
  std::string_view excitation = "steps";
  std::string_view x = "time";  // signals of AxisSample
  std::string_view y = "velocity";
  double from_s = 0.0;
  double to_s = 2.0;
};

struct EffectInfo {
  std::string_view id;
  std::string_view title;
  std::string_view equation;
  std::string_view source;  // author, year, number
  std::string_view cannot;  // what it does not represent
  Place place = Place::kTorque;
  std::string_view target = "";             // of a user's formula: what it adds to, "torque_Nm"
  std::array<std::string_view, 8> twins{};  // ids, or base parameters by path; as many as there are
  // Ids of laws with fewer parameters that this one becomes at a limit of its shapes: it has to be better than
  // each of them by what any addition has to gain.
  std::array<std::string_view, 4> nests{};
  std::string_view reveals;  // the experiment, and the signal in which it shows
  std::string_view visible;  // the smallest size that can be seen, in words
  // Of the first strength, by the simple estimator that `visible` names; null: `visible` says why not.
  double (*min_visible)(const SensorSet&) = nullptr;
  std::uint32_t claims = kClaimNone;
  // Of effects that explain data equally well this one is the most probable beforehand.
  bool in_every_drive = false;
  std::uint32_t numerics = kNumericsPlain;
  std::uint32_t rigs = kOnBoth;
  std::uint32_t demands = kNeedsNothing;  // of the rig, beyond what its place needs
  LawOfAngle of_angle = LawOfAngle::kNone;
  BaseExclusion excludes{};  // a base parameter that does the same
  std::span<const EffectParam> params;
  std::span<const EffectState> states{};
  // An effect whose states this one reads; it is run along, at neutral strength if the model does not have
  // it.
  std::string_view needs = "";
  EffectPlot plot{};
};

// A user's formula: no effect that a search may name.
constexpr bool is_formula(const EffectInfo& info) { return !info.target.empty(); }

inline constexpr std::size_t kAllWheels = ~std::size_t{0};  // of a rig that is no robot, or not known

// The rows that a robot of so many wheels has: all but those of further wheels.
constexpr std::span<const EffectParam> rows_of(const EffectInfo& info, std::size_t wheels) {
  std::size_t rows = info.params.size();
  while (rows > 0 && info.params[rows - 1].wheel > 0 &&
         static_cast<std::size_t>(info.params[rows - 1].wheel) > wheels)
    --rows;
  return info.params.first(rows);
}

// The row that an effect's size is told by: its first strength.
constexpr std::size_t first_strength(const EffectInfo& info) {
  std::size_t row = 0;
  while (row + 1 < info.params.size() && info.params[row].role != ParamRole::kStrength) ++row;
  return row;
}

// The series of harmonics that an effect has, by the order's row; count 0: none.
constexpr HarmonicSeries series_of(const EffectInfo& info) {
  for (const EffectParam& row : info.params) {
    if (row.series.count > 0) return row.series;
  }
  return {};
}

}  // namespace omnihil
