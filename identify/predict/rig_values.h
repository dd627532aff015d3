// A candidate's numbers on the scalar that it is simulated with: plain, or with derivatives after some of its unknowns.
//
//   const auto m = rig_values<Jet>(RigModel{candidate, unknowns, 0}, drive_params_as<Jet>(params), number);
//   EffectSet<Jet> effects(m.uses, m.values);
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "identify/predict/candidate.h"
#include "sim/law/scalar.h"
#include "sim/model/rolling_model.h"

namespace omnihil {

// A candidate with the unknowns that its simulation shall carry derivatives of: `first` + n is component n of a Jet.
// Those without a path are known in this run.
struct RigModel {
  const Candidate& candidate;
  std::span<const Unknown> unknowns = {};
  std::size_t first = 0;
};

// All that a simulation takes from a candidate: its numbers, and which laws act; of which run, and by which unknowns there are
// derivatives.
struct SimulatedNumbers {
  std::size_t run = 0;
  std::vector<double> numbers{};
  std::vector<const void*> laws{};
  std::vector<std::string> unknowns{};  // paths

  bool operator==(const SimulatedNumbers&) const = default;
};

inline SimulatedNumbers simulated_numbers(const Candidate& candidate, std::size_t run,
                                          std::span<const Unknown> unknowns = {}) {
  SimulatedNumbers out{.run = run};
  for (const Parameter& p : candidate.file.parameters.parameters)
    out.numbers.insert(out.numbers.end(), p.values.begin(), p.values.end());
  for (const EffectUse& use : candidate.effects) {
    out.laws.insert(out.laws.end(), {use.entry, use.owner.get()});
    out.numbers.insert(out.numbers.end(), use.values.begin(), use.values.end());
  }
  for (const Unknown& u : unknowns) out.unknowns.push_back(u.path);
  return out;
}

// A candidate's numbers on a scalar: the base's, and those of all effects one after another.
template <typename T, template <typename> class Params>
struct RigValues {
  Params<T> params;
  std::vector<EffectUse> uses;
  std::vector<T> values;
};

// number(params, path): the place of a base parameter; null: it has none.
template <typename T, template <typename> class Params, typename Number>
RigValues<T, Params> rig_values(const RigModel& model, Params<T> params, Number number) {
  RigValues<T, Params> out{.params = std::move(params), .uses = model.candidate.effects, .values = {}};
  std::vector<std::size_t> first_value;
  for (const EffectUse& use : out.uses) {
    first_value.push_back(out.values.size());
    for (const double v : use.values) out.values.push_back(T(v));
  }
  if constexpr (std::is_same_v<T, Jet>) {
    for (std::size_t n = 0; n < kJetWidth && model.first + n < model.unknowns.size(); ++n) {
      const Unknown& u = model.unknowns[model.first + n];
      if (u.path.empty()) continue;
      Jet* place = u.effect < 0 ? number(out.params, u.path)
                                : &out.values[first_value[static_cast<std::size_t>(u.effect)] +
                                              static_cast<std::size_t>(u.row)];
      if (place != nullptr) *place = Jet(place->a, static_cast<int>(n));
    }
  }
  return out;
}

// Of a model of one drive.
template <typename T>
RigValues<T, DriveParams> axis_values(const RigModel& model) {
  return rig_values<T>(model, drive_params_as<T>(drive_of(model.candidate)),
                       [](DriveParams<Jet>& params, std::string_view path) -> Jet* {
                         for (const DriveParamPath& at : drive_param_paths()) {
                           if ((params.linear ? at.linear_path : at.path) == path) return &(params.*at.jet);
                         }
                         return nullptr;
                       });
}

// Of a model of a robot.
template <typename T>
RigValues<T, RollingParams> rolling_values(const RigModel& model) {
  return rig_values<T>(model, rolling_params_as<T>(rolling_params(model.candidate.file.parameters)),
                       rolling_number<Jet>);
}

}  // namespace omnihil
