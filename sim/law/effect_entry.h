// One effect as the rest of the program holds it: its description and its law, for both scalars.
//
//   struct Cogging { static constexpr EffectInfo kInfo{.id = "cogging", …};
//                    template <typename T> static void apply(const T* p, T* x, TorquePort<T>& port); };
//   OMNIHIL_EFFECT(cogging, Cogging)        // at the end of sim/effects/cogging.cc; nothing else to register
//
// An effect that acts in two places has two `apply`s. Registration is by file stem (sim/CMakeLists.txt), so
// it does not depend on static initialisers.
#pragma once
#include "sim/law/effect.h"
#include "sim/law/effect_ports.h"
#include "sim/law/scalar.h"

namespace omnihil {

// `context` is null but for effects made at run time (a user's formula).
template <typename T, typename Port>
using ApplyFunction = void (*)(const void* context, const T* params, T* states, Port& port);

// One slot per place; null: the effect does not act there.
template <typename T>
struct ApplyFunctions {
  ApplyFunction<T, CommandPort<T>> command = nullptr;
  ApplyFunction<T, SupplyPort<T>> supply = nullptr;
  ApplyFunction<T, BridgePort<T>> bridge = nullptr;
  ApplyFunction<T, WindingPort<T>> winding = nullptr;
  ApplyFunction<T, TorquePort<T>> torque = nullptr;
  ApplyFunction<T, ShaftPort<T>> shaft = nullptr;
  ApplyFunction<T, ContactPort<T>> contact = nullptr;
  ApplyFunction<T, BodyPort<T>> body = nullptr;
  ApplyFunction<T, SensorPort<T>> sensor = nullptr;
  ApplyFunction<T, TimingPort<T>> timing = nullptr;
  // Numbers that follow from the parameters and need computing once only; null: none.
  void (*prepare)(const T* params, T* derived) = nullptr;
};

struct EffectEntry {
  const EffectInfo* info = nullptr;
  ApplyFunctions<double> simulate;
  ApplyFunctions<Jet> differentiate;
  const void* context = nullptr;
  int derived = 0;  // how many numbers `prepare` writes; a law finds them behind its parameters

  template <typename T>
  const ApplyFunctions<T>& functions() const {
    if constexpr (std::is_same_v<T, double>) {
      return simulate;
    } else {
      return differentiate;
    }
  }
};

template <typename Effect, typename T, typename Port>
constexpr ApplyFunction<T, Port> apply_function() {
  if constexpr (requires(const T* p, T* x, Port& port) { Effect::apply(p, x, port); }) {
    return [](const void*, const T* p, T* x, Port& port) { Effect::apply(p, x, port); };
  } else {
    return nullptr;
  }
}

// An effect may have `static constexpr int kDerived = n;` and
// `template <typename T> static void prepare(const T* p, T* derived)`: what it writes stands behind the
// parameters.
template <typename Effect>
constexpr int derived_count() {
  if constexpr (requires { Effect::kDerived; }) {
    return Effect::kDerived;
  } else {
    return 0;
  }
}

template <typename Effect, typename T>
constexpr auto prepare_function() -> void (*)(const T*, T*) {
  if constexpr (requires { Effect::kDerived; }) {
    return [](const T* p, T* derived) { Effect::prepare(p, derived); };
  } else {
    return nullptr;
  }
}

template <typename Effect, typename T>
constexpr ApplyFunctions<T> apply_functions() {
  return {.command = apply_function<Effect, T, CommandPort<T>>(),
          .supply = apply_function<Effect, T, SupplyPort<T>>(),
          .bridge = apply_function<Effect, T, BridgePort<T>>(),
          .winding = apply_function<Effect, T, WindingPort<T>>(),
          .torque = apply_function<Effect, T, TorquePort<T>>(),
          .shaft = apply_function<Effect, T, ShaftPort<T>>(),
          .contact = apply_function<Effect, T, ContactPort<T>>(),
          .body = apply_function<Effect, T, BodyPort<T>>(),
          .sensor = apply_function<Effect, T, SensorPort<T>>(),
          .timing = apply_function<Effect, T, TimingPort<T>>(),
          .prepare = prepare_function<Effect, T>()};
}

#define OMNIHIL_EFFECT(stem, Type)                                                                     \
  const EffectEntry& effect_##stem() {                                                                 \
    static_assert(Type::kInfo.id == #stem, "an effect's id is the stem of its file");                  \
    static constexpr EffectEntry kEntry{&Type::kInfo, apply_functions<Type, double>(),                 \
                                        apply_functions<Type, Jet>(), nullptr, derived_count<Type>()}; \
    return kEntry;                                                                                     \
  }

}  // namespace omnihil
