// What feeds all bridges of a robot: a battery behind its resistance, and the capacitor on the bus.
//
//   BatteryParams<double> b{.cells = 6, .capacity_C = 1.3 * 3600, .resistance_ohm = 0.04};
//   SupplyState<double> s = full_supply(b);
//   advance_supply(b, 2e-3, s, bus_current_A, 1e-3);      // of all motors; s.bus_voltage_V sags for all of them
//
// Law: V_oc = cells * v(q / capacity), v a table of one cell;   i_b = (V_oc - V_bus) / R_b
//      C dV_bus/dt = i_b - i_bus,   dq/dt = -i_b      (V_oc held over a step)
//      exact for held currents: V_bus goes to V_oc - R_b i_bus with time constant R_b C; C = 0: at once.
// A supply that takes no charge back (a bench unit, a diode) has i_b >= 0: braking then pumps the bus up.
// Source: the circuit (Thevenin model of a cell, e.g. Plett 2015, "Battery Management Systems", ch. 2); the
// table's shape is a typical lithium-polymer cell's, guess, +-0.05 V.
// Cannot: slow polarisation (RC branches), temperature and age of the cell, cable inductance.
// Templates on the scalar.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace omnihil {

// Open-circuit voltage of one cell at 0, 10, … 100 % of charge.
inline constexpr std::array<double, 11> kLithiumPolymerCell_V = {3.27, 3.61, 3.69, 3.73, 3.77, 3.80,
                                                                 3.84, 3.90, 3.98, 4.08, 4.20};

template <typename T>
struct BatteryParams {
  int cells = 6;
  T capacity_C = T(4680.0);    // 1.3 Ah
  T resistance_ohm = T(0.04);  // whole pack with leads
  bool takes_charge = true;    // false: no current back into it
  std::array<double, 11> cell_V = kLithiumPolymerCell_V;
};

template <typename T>
struct SupplyState {
  T charge_C = T(0);
  T bus_voltage_V = T(0);
};

// Linear between the table's points, held at its ends.
template <typename T>
T open_circuit_V(const BatteryParams<T>& b, const T& charge_C) {
  const T x = charge_C / b.capacity_C * 10.0;
  if (!(x > 0.0)) return T(b.cells * b.cell_V.front());
  if (!(x < 10.0)) return T(b.cells * b.cell_V.back());
  std::size_t k = 0;
  while (k < 9 && x >= static_cast<double>(k + 1)) ++k;
  return static_cast<double>(b.cells) *
         (b.cell_V[k] + (x - static_cast<double>(k)) * (b.cell_V[k + 1] - b.cell_V[k]));
}

template <typename T>
SupplyState<T> full_supply(const BatteryParams<T>& b) {
  return {b.capacity_C, open_circuit_V(b, b.capacity_C)};
}

template <typename T>
struct SupplyFlow {
  T battery_charge_C = T(0);  // out of the battery
  T battery_heat_J = T(0);    // in its resistance
};

namespace supply_detail {
// Over h with the battery connected; the bus voltage relaxes.
template <typename T>
void connected(const BatteryParams<T>& b, double capacitance_F, const T& source_V, SupplyState<T>& s,
               const T& bus_current_A, const T& h_s, SupplyFlow<T>& flow) {
  using std::exp;
  const T settled_V = source_V - b.resistance_ohm * bus_current_A;
  const T tau_s = b.resistance_ohm * capacitance_F;
  T decay = T(0), mean_decay_s = T(0), square_decay_s = T(0);
  if (tau_s > 0.0) {
    decay = exp(-h_s / tau_s);
    mean_decay_s = (1.0 - decay) * tau_s;
    square_decay_s = 0.5 * (1.0 + decay) * mean_decay_s;
  }
  // i_b = i_bus - (V_0 - V_settled) exp(-t / tau) / R_b
  const T d_V = s.bus_voltage_V - settled_V;
  const T d_A = d_V / b.resistance_ohm;
  flow.battery_charge_C += bus_current_A * h_s - d_A * mean_decay_s;
  flow.battery_heat_J +=
      b.resistance_ohm * (bus_current_A * bus_current_A * h_s - 2.0 * bus_current_A * d_A * mean_decay_s +
                          d_A * d_A * square_decay_s);
  s.bus_voltage_V = settled_V + d_V * decay;
}
}  // namespace supply_detail

// The bus current of all drives together is held over the step. capacitance_F may be 0 if the battery takes
// charge.
template <typename T>
SupplyFlow<T> advance_supply(const BatteryParams<T>& b, double capacitance_F, SupplyState<T>& s,
                             const T& bus_current_A, double h_s) {
  using std::log;
  SupplyFlow<T> flow;
  const T source_V = open_circuit_V(b, s.charge_C);
  T left_s = T(h_s);
  // At most: alone, then connected, or connected, then alone.
  for (int part = 0; part < 2 && left_s > 0.0; ++part) {
    const bool alone = !b.takes_charge &&
                       (s.bus_voltage_V > source_V || (s.bus_voltage_V == source_V && bus_current_A <= 0.0));
    T part_s = left_s;
    if (alone) {
      // C dV/dt = -i_bus until the voltage is down at the battery's
      const T down_V = s.bus_voltage_V - source_V;
      const bool comes_down = bus_current_A > 0.0 && bus_current_A * left_s > down_V * capacitance_F;
      if (comes_down) part_s = down_V * capacitance_F / bus_current_A;
      s.bus_voltage_V = comes_down ? source_V : s.bus_voltage_V - bus_current_A * part_s / capacitance_F;
    } else {
      const T settled_V = source_V - b.resistance_ohm * bus_current_A;
      if (!b.takes_charge && settled_V > source_V && capacitance_F > 0.0) {
        // reaches V_oc after tau ln((V_settled - V_0) / (V_settled - V_oc))
        const T t =
            b.resistance_ohm * capacitance_F * log((settled_V - s.bus_voltage_V) / (settled_V - source_V));
        if (t < left_s) part_s = t;
      }
      supply_detail::connected(b, capacitance_F, source_V, s, bus_current_A, part_s, flow);
      if (part_s < left_s) s.bus_voltage_V = source_V;
    }
    left_s -= part_s;
  }
  s.charge_C -= flow.battery_charge_C;
  return flow;
}

}  // namespace omnihil
