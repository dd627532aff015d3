#include "sim/drive/supply.h"

#include <gtest/gtest.h>

#include "sim/law/scalar.h"

namespace omnihil {
namespace {

const BatteryParams<double> kBattery{};  // six cells, 1.3 Ah, 40 mohm

TEST(Supply, OpenCircuitVoltageIsTheTableOverTheCharge) {
  EXPECT_NEAR(open_circuit_V(kBattery, kBattery.capacity_C), 6 * 4.20, 1e-12);
  EXPECT_NEAR(open_circuit_V(kBattery, 0.0), 6 * 3.27, 1e-12);
  EXPECT_NEAR(open_circuit_V(kBattery, 0.55 * kBattery.capacity_C), 6 * 0.5 * (3.80 + 3.84), 1e-12);
  double before = 0.0;
  for (double q = -0.1; q < 1.2; q += 0.01) {
    const double v = open_circuit_V(kBattery, q * kBattery.capacity_C);
    EXPECT_GE(v, before);
    before = v;
  }
}

TEST(Supply, SagsByTheResistanceForAllMotorsTogether) {
  for (const int motors : {1, 4}) {
    SupplyState<double> s = full_supply(kBattery);
    for (int k = 0; k < 20; ++k) advance_supply(kBattery, 1e-3, s, motors * 6.0, 1e-3);
    const double source = open_circuit_V(kBattery, s.charge_C);
    EXPECT_NEAR(s.bus_voltage_V, source - 0.04 * 6.0 * motors, 1e-3);
  }
}

TEST(Supply, CapacitorRelaxesWithItsTimeConstant) {
  SupplyState<double> s = full_supply(kBattery);
  const double before = s.bus_voltage_V;
  advance_supply(kBattery, 2e-3, s, 10.0, 40e-6);  // R C = 80 us
  EXPECT_NEAR(s.bus_voltage_V, before - 0.4 * (1.0 - std::exp(-0.5)), 1e-12);
}

TEST(Supply, StepLengthDoesNotMatterForHeldCurrentAndEnergyCloses) {
  SupplyState<double> one = full_supply(kBattery), many = one;
  const double first = one.bus_voltage_V, c = 2e-3;
  const auto f = advance_supply(kBattery, c, one, 15.0, 200e-6);
  double heat = 0.0;
  for (int k = 0; k < 10; ++k) heat += advance_supply(kBattery, c, many, 15.0, 20e-6).battery_heat_J;
  EXPECT_NEAR(one.bus_voltage_V, many.bus_voltage_V, 1e-5);  // the table moves a little in between
  EXPECT_NEAR(f.battery_heat_J, heat, 1e-5 * heat);
  // out of the battery = its heat + what the capacitor gained + what the bus delivered at its own voltage:
  // C V dV = (i_b - i) V dt, so V i_b = V i + d(C V^2 / 2), with V = V_oc - R i_b
  const double delivered = first * f.battery_charge_C - f.battery_heat_J -
                           0.5 * c * (one.bus_voltage_V * one.bus_voltage_V - first * first);
  const double settled = first - 0.04 * 15.0, tau = 0.04 * c;
  const double integral_V = settled * 200e-6 + (first - settled) * tau * (1.0 - std::exp(-200e-6 / tau));
  EXPECT_NEAR(delivered, 15.0 * integral_V, 1e-9);
}

TEST(Supply, WithoutCapacitorTheVoltageFollowsAtOnce) {
  SupplyState<double> s = full_supply(kBattery);
  advance_supply(kBattery, 0.0, s, 10.0, 1e-6);
  EXPECT_NEAR(s.bus_voltage_V, 6 * 4.2 - 0.4, 1e-12);
}

TEST(Supply, OneThatTakesNothingBackIsPumpedUpByBraking) {
  BatteryParams<double> bench = kBattery;
  bench.takes_charge = false;
  SupplyState<double> s = full_supply(bench);
  const double before = s.bus_voltage_V;
  for (int k = 0; k < 10; ++k) advance_supply(bench, 2e-3, s, -5.0, 1e-4);
  EXPECT_NEAR(s.bus_voltage_V, before + 5.0 * 1e-3 / 2e-3, 1e-9);  // C dV = i dt
  EXPECT_EQ(s.charge_C, bench.capacity_C);
  for (int k = 0; k < 100; ++k) advance_supply(bench, 2e-3, s, 5.0, 1e-4);
  EXPECT_NEAR(s.bus_voltage_V, open_circuit_V(bench, s.charge_C) - 0.2, 1e-3);
}

TEST(Supply, DerivativeByTheResistanceIsThatOfFiniteDifferences) {
  const auto end = [](auto r) {
    using T = decltype(r);
    BatteryParams<T> b;
    b.resistance_ohm = r;
    SupplyState<T> s = full_supply(b);
    for (int k = 0; k < 20; ++k) advance_supply(b, 2e-3, s, T(12.0), 50e-6);
    return s.bus_voltage_V;
  };
  const double e = 1e-6;
  EXPECT_NEAR(end(Jet(0.04, 0)).v[0], (end(0.04 + e) - end(0.04 - e)) / (2 * e), 1e-5);
}

}  // namespace
}  // namespace omnihil
