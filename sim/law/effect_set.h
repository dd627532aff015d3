// The effects that a model has, ready to be applied sub-step by sub-step.
//
//   const std::vector<EffectUse> uses = {{find_effect("cogging"), {0.004, 48, 0}}};
//   EffectSet<double> set(uses);
//   set.torque.apply(set.values(), states, port);
//
// An effect all of whose strengths are exactly neutral is left out, so results are equal bit for bit; with
// Jet it stays in while a strength is an unknown of the fit, so that its derivative at neutral is there.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/law/effect_entry.h"
#include "sim/law/fitted_number.h"

namespace omnihil {

// One effect with its numbers, as read from a model file.
struct EffectUse {
  const EffectEntry* entry = nullptr;
  std::vector<double> values;                     // one per row that the rig has (rows_of)
  std::vector<std::optional<double>> tolerances;  // relative 1-sigma, as given; empty: none given
  std::string name;                               // of a user's formula; empty: the effect's id
  std::shared_ptr<const void> owner;  // keeps alive what `entry` points into where it was made at run time
  std::vector<NumberNote> notes{};    // where each value came from, as given; empty: nothing is known of it

  const FittedNumber* fitted(std::size_t i) const {  // null: that value was never fitted
    return i < notes.size() && notes[i].fitted ? &*notes[i].fitted : nullptr;
  }
};

// Where a shape starts, which size of a strength is visible, within its bounds; of a linear axis only where
// it is a speed or the drive is asked (a force: param_range).
double start_of(const EffectParam& row, const DriveParams<double>* drive);
// With every strength at its neutral value and every shape at its start; `wheels`: of the robot.
EffectUse neutral_use(const EffectEntry& entry, const DriveParams<double>* drive = nullptr,
                      std::size_t wheels = kAllWheels);
// With every strength at its typical, visible size.
EffectUse typical_use(const EffectEntry& entry, const DriveParams<double>* drive = nullptr,
                      std::size_t wheels = kAllWheels);
bool is_neutral(const EffectUse& use);
// Parameters as a law takes them: with what it derives from them behind.
template <typename T>
std::vector<T> law_params(const EffectEntry& entry, std::span<const T> values);

inline constexpr int kMaxEffectStates = 32;

// The effects of one place, in order.
template <typename T, typename Port>
struct EffectChain {
  struct Link {
    ApplyFunction<T, Port> function;
    const void* context;
    int first_param;
    int first_state;
  };
  std::vector<Link> links;

  bool empty() const { return links.empty(); }
  void apply(const T* params, T* states, Port& port) const {
    for (const Link& link : links) {
      link.function(link.context, params + link.first_param, states + link.first_state, port);
    }
  }
};

template <typename T>
class EffectSet {
 public:
  EffectSet() = default;
  // Values of all uses one after another; `values` may carry derivatives. Asserts when states do not fit.
  EffectSet(std::span<const EffectUse> uses, std::span<const T> values);
  explicit EffectSet(std::span<const EffectUse> uses);

  const T* values() const { return values_.data(); }
  std::span<const T> initial_states() const { return initial_states_; }
  bool none() const { return active_ == 0; }  // no effect acts anywhere
  bool none_in_drive() const { return active_in_drive_ == 0; }
  bool reads_motor_torque() const { return reads_motor_torque_; }      // kReadsMotorTorque
  bool bridge_reads_current() const { return bridge_reads_current_; }  // kReadsCurrent

  EffectChain<T, CommandPort<T>> command;
  EffectChain<T, SupplyPort<T>> supply;
  EffectChain<T, BridgePort<T>> bridge;
  EffectChain<T, WindingPort<T>> winding;
  EffectChain<T, TorquePort<T>> torque;
  EffectChain<T, ShaftPort<T>> shaft;
  EffectChain<T, ContactPort<T>> contact;
  EffectChain<T, BodyPort<T>> body;
  EffectChain<T, SensorPort<T>> sensor;
  EffectChain<T, TimingPort<T>> timing;

 private:
  void add(const EffectEntry& entry, std::span<const T> values);

  std::vector<T> values_;
  std::vector<T> initial_states_;
  std::vector<std::shared_ptr<const void>> owners_;  // of effects made at run time
  int active_ = 0;
  int active_in_drive_ = 0;
  bool reads_motor_torque_ = false;
  bool bridge_reads_current_ = false;
};

}  // namespace omnihil
