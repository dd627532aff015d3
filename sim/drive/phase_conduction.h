// Which phases carry current between two boundaries, and by which source: switches that are on, diodes whose
// current flows, diodes that a floating phase's voltage opens. Used by phase_circuit.cc alone.
//
//   Conduction on = conduction_of(currents_A, legs, back_emf_V, kNone);     // on.count phases conduct
//
// Law: star point = mean over the conducting phases of (source - back-EMF); a phase without current floats at
// star + its back-EMF and joins when that passes a diode's voltage of its leg.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "sim/drive/inverter.h"

namespace omnihil::phase_detail {

inline constexpr std::size_t kNone = 3;  // no phase
using Three = std::array<double, 3>;

// Three numbers reckoned with at once, two of them by one instruction: the same bits as one by one.
struct Lanes {
  using Pair [[gnu::vector_size(16)]] = double;
  Pair two;
  double third;

  explicit Lanes(const Three& x) : two{x[0], x[1]}, third(x[2]) {}
  Lanes(Pair first, double last) : two(first), third(last) {}
  void put(Three& x) const { x = {two[0], two[1], third}; }
};
inline Lanes operator+(const Lanes& a, const Lanes& b) { return {a.two + b.two, a.third + b.third}; }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return {a.two - b.two, a.third - b.third}; }
inline Lanes operator-(const Lanes& a, double b) { return {a.two - b, a.third - b}; }
inline Lanes operator*(const Lanes& a, const Lanes& b) { return {a.two * b.two, a.third * b.third}; }
inline Lanes operator*(const Lanes& a, double b) { return {a.two * b, a.third * b}; }
inline Lanes operator*(double a, const Lanes& b) { return {a * b.two, a * b.third}; }
inline double sum_of(const Lanes& x) { return 0.0 + x.two[0] + x.two[1] + x.third; }
inline double mean_of(const Lanes& x) { return (1.0 / 3.0) * (x.two[0] + x.two[1] + x.third); }

// f(0), f(1), f(2), each with its index as a constant: everything about a phase stays in registers.
template <typename F>
inline void each_phase(F&& f) {
  f(std::integral_constant<std::size_t, 0>{});
  f(std::integral_constant<std::size_t, 1>{});
  f(std::integral_constant<std::size_t, 2>{});
}

// What conducts, and by which source. Numbers instead of branches: over many motors no branch is foreseeable.
struct Conduction {
  std::array<const LegSource*, 3> source;
  Three on;         // 1, or 0: floats, and counts for nothing
  Three volt_V;     // of the source; 0 where it floats
  Three direction;  // of a diode's current, 1 or -1; 0 of switches and floating phases
  double share;     // 1 / number of conducting phases
  int count;

  void join(std::size_t x, const Leg& leg, bool upper) {
    source[x] = upper ? &leg.backward : &leg.forward;
    on[x] = 1.0;
    volt_V[x] = source[x]->volt_V;
    direction[x] = upper ? -1.0 : 1.0;
    ++count;
    share = 1.0 / count;
  }
};

inline constexpr Three kShare = {1.0, 1.0 / 2.0, 1.0 / 3.0};

// A bit for each phase without current whose leg has no switch on.
inline unsigned without_current(const Three& current_A, const std::array<Leg, 3>& legs) {
  const auto is = [&](std::size_t x) { return !legs[x].always && current_A[x] == 0.0 ? 1u << x : 0u; };
  return is(0) | is(1) | is(2);
}

// Over the conducting phases.
inline double mean_of(const Conduction& c, const Three& value) {
  return c.share * (c.on[0] * value[0] + c.on[1] * value[1] + c.on[2] * value[2]);
}

// No reference for the star point: two diodes conduct if some pair's back-EMF exceeds what they need.
inline void join_pair(Conduction& c, const std::array<Leg, 3>& legs, const Three& emf_V, std::size_t barred) {
  std::size_t from = kNone, to = kNone;
  double most_V = 0.0;
  for (std::size_t x = 0; x < 3; ++x)
    for (std::size_t y = 0; y < 3; ++y) {
      if (x == y || x == barred || y == barred) continue;
      // current out of x (its upper diode), into y (its lower one)
      const double excess_V = emf_V[x] - emf_V[y] + legs[y].forward.volt_V - legs[x].backward.volt_V;
      if (excess_V > most_V) most_V = excess_V, from = x, to = y;
    }
  if (from == kNone) return;
  c.join(from, legs[from], true);
  c.join(to, legs[to], false);
}

// Phases without current whose floating voltage opens a diode join, the most violating one first. A barred
// phase has just been found not to.
inline void join_floating(Conduction& c, const std::array<Leg, 3>& legs, const Three& emf_V,
                          std::size_t barred) {
  if (c.count == 0) join_pair(c, legs, emf_V, barred);
  while (c.count > 0 && c.count < 3) {
    const double star_V = mean_of(c, c.volt_V) - mean_of(c, emf_V);
    Three above_V, excess_V;
    each_phase([&](auto x) {
      above_V[x] = star_V + emf_V[x] - legs[x].backward.volt_V;
      const double below_V = legs[x].forward.volt_V - star_V - emf_V[x];
      excess_V[x] = (1.0 - c.on[x]) * std::max(above_V[x], below_V);
    });
    if (barred != kNone) excess_V[barred] = 0.0;
    if (std::max(std::max(excess_V[0], excess_V[1]), excess_V[2]) <= 0.0) return;
    const std::size_t x =
        excess_V[0] >= excess_V[1] && excess_V[0] >= excess_V[2] ? 0 : (excess_V[1] >= excess_V[2] ? 1 : 2);
    c.join(x, legs[x], above_V[x] > 0.0);
  }
}

// Of a leg's source while it conducts, and of a diode's current: 1 or -1, 0 of switches.
inline const LegSource& source_of(const Leg& leg, double current_A) {
  return current_A < 0.0 ? leg.backward : leg.forward;
}
inline double diode_direction(const Leg& leg, double current_A) {
  return static_cast<double>(!leg.always) * static_cast<double>((current_A > 0.0) - (current_A < 0.0));
}
// Whether a diode would have to carry its current the other way.
inline bool has_turned(const Leg& leg, double current_A, double end_A) {
  return !leg.always && (current_A < 0.0 ? end_A > 0.0 : end_A < 0.0);
}

inline Conduction conduction_of(const Three& current_A, const std::array<Leg, 3>& legs, const Three& emf_V,
                                std::size_t barred) {
  Conduction c;
  c.count = 0;
  each_phase([&](auto x) {
    const double i = current_A[x];
    const bool conducts = legs[x].always || i != 0.0;
    c.source[x] = &source_of(legs[x], i);
    c.on[x] = static_cast<double>(conducts);
    c.volt_V[x] = c.on[x] * c.source[x]->volt_V;
    c.direction[x] = diode_direction(legs[x], i);
    c.count += conducts;
  });
  c.share = c.count > 0 ? kShare[static_cast<std::size_t>(c.count) - 1] : 0.0;
  if (c.count < 3) join_floating(c, legs, emf_V, barred);
  return c;
}

}  // namespace omnihil::phase_detail
