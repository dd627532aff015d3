// A three-phase bridge: its devices, what its legs are asked for, and what a leg looks like to the circuit.
//
//   BridgeCommand c = {{{.on = LegState::kHigh, .off = LegState::kLow, .duty_ratio = 0.4},   // complementary
//                       {.on = LegState::kLow, .off = LegState::kLow},                        // held low
//                       {.on = LegState::kOff, .off = LegState::kOff}}};                      // floating
//
// PWM is centre-aligned: a leg is in its `on` state for the share duty_ratio in the middle of the period, in
// its `off` state for the rest. The usual six-step modes are pairs of these:
//   complementary   high leg {kHigh, kLow},  low leg {kLow, kLow}: current may reverse, brakes below its EMF
//   high-side chop  high leg {kHigh, kOff},  low leg {kLow, kLow}: slow decay through the lower diode
//   fast decay      high leg {kHigh, kOff},  low leg {kLow, kOff}: both off together, back into the bus (coast)
// Law of a leg, i counted into the motor:
//   switched on     v = V_bus or 0, minus R_on i, either direction
//   off, i > 0      lower diode:  v = -V_f - R_on i
//   off, i < 0      upper diode:  v = V_bus + V_f - R_on i
//   off, i = 0      floats, while -V_f <= v <= V_bus + V_f
// Dead time: after a change between kHigh and kLow both switches stay off for dead_time_s; an on-time shorter
// than that is lost.
// Source: Mohan, Undeland, Robbins, "Power Electronics" (2003), ch. 8 (bridge, dead time); data sheets for
// R_on and V_f.
// Approximated: the diode's slope resistance equals R_on (so that all conducting phases share one time
// constant); switching takes no time and costs no energy; a diode beside a conducting switch carries nothing.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace omnihil {

struct Inverter {
  double pwm_frequency_Hz = 20e3;  // 8 to 100 kHz
  double dead_time_s = 0.0;
  double switch_resistance_ohm = 0.0;  // R_on
  double diode_forward_V = 0.0;        // V_f
};

enum class LegState : std::uint8_t { kOff, kLow, kHigh };

struct LegCommand {
  LegState on = LegState::kOff;
  LegState off = LegState::kOff;
  double duty_ratio = 0.0;
};

using BridgeCommand = std::array<LegCommand, 3>;

enum class PwmMode : std::uint8_t { kComplementary, kHighSideChop, kFastDecay };

// Two legs in one of the modes above, the third floating. Phases 0, 1, 2.
inline BridgeCommand block_command(int high_phase, int low_phase, double duty_ratio, PwmMode mode) {
  BridgeCommand c{};
  LegCommand& high = c[static_cast<std::size_t>(high_phase)];
  LegCommand& low = c[static_cast<std::size_t>(low_phase)];
  high.on = LegState::kHigh;
  high.off = mode == PwmMode::kComplementary ? LegState::kLow : LegState::kOff;
  low.on = LegState::kLow;
  low.off = mode == PwmMode::kFastDecay ? LegState::kOff : LegState::kLow;
  high.duty_ratio = low.duty_ratio = duty_ratio;
  return c;
}

// Three complementary legs, as a FOC drives them.
inline BridgeCommand sine_command(const std::array<double, 3>& duty_ratio) {
  BridgeCommand c{};
  for (std::size_t x = 0; x < 3; ++x) c[x] = {LegState::kHigh, LegState::kLow, duty_ratio[x]};
  return c;
}

// What a conducting leg is to the circuit: a source behind R_on. volt = bus_share * V_bus - drop.
struct LegSource {
  double volt_V = 0.0;
  double bus_share = 0.0;  // of the leg's charge that comes out of the bus
  double drop_V = 0.0;     // lost in devices besides R_on
};

// By direction of the current. Between the two voltages the leg floats at zero current; where both are one it
// always conducts.
struct Leg {
  LegSource forward;   // i > 0
  LegSource backward;  // i < 0
  bool always = false;
};

inline Leg leg_of(const Inverter& inverter, LegState state, double bus_V) {
  const double drop_V = inverter.diode_forward_V;
  if (state == LegState::kOff) return {{-drop_V, 0.0, drop_V}, {bus_V + drop_V, 1.0, -drop_V}, false};
  const double share = state == LegState::kHigh ? 1.0 : 0.0, volt_V = share * bus_V;
  return {{volt_V, share, 0.0}, {volt_V, share, 0.0}, true};
}

// Mean phase voltage that the dead time takes from a complementary leg carrying a positive current well above
// its ripple: two gaps per period, one off the edge, both with a diode's drop.
//   dV = f t_d (V_bus + 2 V_f)
inline double dead_time_loss_V(const Inverter& inverter, double bus_V) {
  return inverter.pwm_frequency_Hz * inverter.dead_time_s * (bus_V + 2.0 * inverter.diode_forward_V);
}

// Everything that is wrong with it, one sentence each.
std::vector<std::string> problems_of(const Inverter& inverter);

}  // namespace omnihil
