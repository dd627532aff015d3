// A robot whose wheels are three-phase drives, or hang on a battery, or warm up: agreement with the
// DC-equivalent plant, energy, holding still, sensors, saving, refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/robot/electric_model.h"
#include "tests/sim/robot/sample_robot.h"

namespace omnihil {
namespace {

// The model's own electrics, to be written to.
ElectricModel& electrics(RobotModel& m) {
  const auto own = std::make_shared<ElectricModel>(electrics_of(m));
  m.electric = own;
  return *own;
}

RobotModel driven_by(DriveKind kind) {
  RobotModel m = symmetric_robot();
  m.motor.pole_pairs = 8;
  electrics(m).kind = kind;
  return m;
}

// Small inductance and fast PWM: the torque that a six-step drive loses by commutation is small (docs/three-phase.md).
RobotModel fast_switched() {
  RobotModel m = driven_by(DriveKind::kSwitched);
  electrics(m).back_emf = {BackEmfShape::kTrapezoid, 2.0 * std::numbers::pi / 3.0};
  electrics(m).inverter.pwm_frequency_Hz = 80e3;
  electrics(m).pwm_mode = PwmMode::kComplementary;
  m.motor.inductance_H = 4e-5;
  return m;
}

RobotModel dc_twin(RobotModel m) {
  m.electric = nullptr;
  return m;
}

RobotModel on_battery(RobotModel m, double resistance_ohm) {
  electrics(m).battery = {.cells = 6, .capacity_C = 3600.0, .resistance_ohm = resistance_ohm};
  electrics(m).battery_charge_ratio = 0.8;
  return m;
}

PlantOptions options() { return planar_options(500'000); }

// Mean wheel speed of a robot turning on the spot, after it has settled.
double settled_speed_rad_s(const RobotModel& model, double duty) {
  Plant plant = one_robot(model, options());
  plant.write(0, duty_drive({duty, duty, duty, duty}));
  plant.advance(1'500'000'000);
  double sum = 0.0;
  constexpr int kSamples = 100;
  for (int n = 0; n < kSamples; ++n) {
    plant.advance(500'000);
    for (const double omega : plant.truth(0).omega_wheel_rad_s) sum += omega / (4.0 * kSamples);
  }
  return sum;
}

TEST(ElectricPlant, NumbersOfAThreePhaseDriveThatIsNotThereChangeNothing) {
  RobotModel other = sample_robot();
  electrics(other).inverter.dead_time_s = 1e-6;
  electrics(other).hall.mounting_error_rad = 0.2;
  electrics(other).saliency_ratio = 1.5;
  ASSERT_FALSE(electrics_of(other).any());
  Plant a = one_robot(sample_robot(), options()), b = one_robot(other, options());
  excite(a, 0.5);
  excite(b, 0.5);
  for (std::size_t i = 0; i < kWheels; ++i) {
    EXPECT_EQ(a.truth(0).theta_rotor_rad[i], b.truth(0).theta_rotor_rad[i]);
    EXPECT_EQ(a.truth(0).motor_current_A[i], b.truth(0).motor_current_A[i]);
  }
  EXPECT_EQ(a.truth(0).x_m, b.truth(0).x_m);
}

TEST(ElectricPlant, AveragedDriveTurnsTheWheelsAsTheDcEquivalentOneOverTheWholeDutyRange) {
  const RobotModel model = driven_by(DriveKind::kDq);
  for (const double duty : {-1.0, -0.5, -0.1, 0.1, 0.3, 0.5, 0.8, 1.0}) {
    const double dc = settled_speed_rad_s(dc_twin(model), duty);
    EXPECT_NEAR(settled_speed_rad_s(model, duty), dc, 0.01 * std::abs(dc)) << duty;
  }
}

TEST(ElectricPlant, SwitchedSixStepTurnsTheWheelsAsTheDcEquivalentOneOverTheWholeDutyRange) {
  const RobotModel model = fast_switched();
  for (const double duty : {-1.0, -0.3, 0.1, 0.3, 0.6, 1.0}) {
    const double dc = settled_speed_rad_s(dc_twin(model), duty);
    EXPECT_NEAR(settled_speed_rad_s(model, duty), dc, 0.01 * std::abs(dc)) << duty;
  }
}

TEST(ElectricPlant, StartAndReversalFollowTheDcEquivalentRobot) {
  const RobotModel model = driven_by(DriveKind::kDq);
  Plant phases = one_robot(model, options()), dc = one_robot(dc_twin(model), options());
  double worst_m_s = 0.0;
  for (int ms = 0; ms < 1200; ++ms) {
    const double duty = ms < 400 ? 0.4 : ms < 800 ? -0.3 : 0.0;
    for (Plant* p : {&phases, &dc}) {
      p->write(0, duty_drive({-duty, -duty, duty, duty}));
      p->advance(1'000'000);
    }
    worst_m_s = std::max(worst_m_s, std::abs(phases.truth(0).v_forward_m_s - dc.truth(0).v_forward_m_s));
  }
  EXPECT_LT(worst_m_s, 0.03);
  EXPECT_NEAR(phases.truth(0).x_m, dc.truth(0).x_m, 0.01 * std::abs(dc.truth(0).x_m) + 2e-3);
}

// source = battery heat + bus + gain of the capacitor; bus = heat + mechanical + gain of the inductances
TEST(ElectricPlant, EnergyOfEveryKindOfDriveClosesToAMillionth) {
  for (const DriveKind kind : {DriveKind::kDc, DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = on_battery(driven_by(kind), 0.05);
    electrics(model).bus_capacitance_F = 1e-3;
    electrics(model).inverter = {.pwm_frequency_Hz = 20e3,
                                 .dead_time_s = 0.4e-6,
                                 .switch_resistance_ohm = 0.01,
                                 .diode_forward_V = 0.7};
    Plant plant = one_robot(model, options());
    const double start_V = plant.electric_truth(0).bus_voltage_V;
    excite(plant, 0.6);
    const ElectricTruth t = plant.electric_truth(0);
    const EnergyBook& b = t.book;
    ASSERT_GT(b.mechanical_J, 1.0);
    const double used_J = b.winding_heat_J + b.device_heat_J + b.mechanical_J + t.in_inductances_J;
    EXPECT_NEAR(b.bus_J, used_J, 1e-6 * b.bus_J) << static_cast<int>(kind);
    // the capacitor is exact within a period; the bus voltage that the windings see is that of its start
    const double gain_J = 0.5 * 1e-3 * (t.bus_voltage_V * t.bus_voltage_V - start_V * start_V);
    EXPECT_NEAR(b.source_J, b.battery_heat_J + b.bus_J + gain_J, 2e-3 * b.source_J) << static_cast<int>(kind);
  }
}

TEST(ElectricPlant, WhatTheWindingsGiveIsWhatTheWheelsTake) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    Plant plant = one_robot(driven_by(kind), options());
    double given_J = 0.0;
    for (int n = 0; n < 1200; ++n) {
      plant.write(0, excitation_drive(0, n * 5e-4));
      const RobotTruth before = plant.truth(0);
      plant.advance(500'000);
      const RobotTruth after = plant.truth(0);
      for (std::size_t i = 0; i < kWheels; ++i) {
        given_J += after.motor_torque_Nm[i] * 0.5 *
                   (before.omega_rotor_rad_s[i] + after.omega_rotor_rad_s[i]) * 5e-4;
      }
    }
    EXPECT_NEAR(plant.electric_truth(0).book.mechanical_J, given_J, 0.01 * given_J) << static_cast<int>(kind);
  }
}

TEST(ElectricPlant, FrictionHoldsARobotExactlyStillAgainstASmallDuty) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = driven_by(kind);
    // k duty bus / R below the friction torque
    const double duty = 0.5 * model.motor.coulomb_friction_Nm * model.motor.resistance_ohm /
                        (model.motor.torque_constant_Nm_per_A * model.bus_voltage_V);
    Plant plant = one_robot(model, options());
    plant.write(0, duty_drive({duty, duty, duty, duty}));
    plant.advance(500'000'000);
    EXPECT_EQ(plant.truth(0).yaw_rad, 0.0);
    for (const double theta : plant.truth(0).theta_rotor_rad) EXPECT_EQ(theta, 0.0);
    EXPECT_NEAR(plant.truth(0).motor_current_A[0], duty * model.bus_voltage_V / model.motor.resistance_ohm,
                0.15 * duty * model.bus_voltage_V / model.motor.resistance_ohm + 1e-3);
  }
}

TEST(ElectricPlant, CoastingRobotComesToRestAndStaysThere) {
  for (const DriveKind kind : {DriveKind::kDc, DriveKind::kDq, DriveKind::kSwitched}) {
    Plant plant = one_robot(on_battery(driven_by(kind), 0.02), options());
    plant.write(0, duty_drive({0.3, 0.3, 0.3, 0.3}));
    plant.advance(300'000'000);
    ASSERT_GT(plant.truth(0).omega_body_rad_s, 1.0);
    plant.write(0, RobotDrive{});
    plant.advance(6'000'000'000);
    const RobotTruth rest = plant.truth(0);
    for (const double omega : rest.omega_wheel_rad_s) EXPECT_EQ(omega, 0.0) << static_cast<int>(kind);
    for (const double i : rest.motor_current_A) EXPECT_NEAR(i, 0.0, 1e-12);
    plant.advance(100'000'000);
    EXPECT_EQ(plant.truth(0).theta_rotor_rad, rest.theta_rotor_rad);
  }
}

TEST(ElectricPlant, CurrentLimitHoldsInAHardReversal) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = driven_by(kind);
    model.motor.current_limit_A = 6.0;
    Plant plant = one_robot(model, options());
    double largest_A = 0.0;
    for (int n = 0; n < 800; ++n) {
      const double duty = n < 400 ? 0.9 : -0.9;
      plant.write(0, duty_drive({duty, duty, duty, duty}));
      plant.advance(500'000);
      const RobotSensors s = plant.sample_sensors(0);
      for (const double i : s.motor_current_A) largest_A = std::max(largest_A, std::abs(i));
    }
    EXPECT_GT(largest_A, 5.0) << static_cast<int>(kind);
    EXPECT_LT(largest_A, 6.0 * 1.05) << static_cast<int>(kind);
  }
}

TEST(ElectricPlant, SensorsShowAngleHallSectorAndCurrentsOfEachMotor) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    const RobotModel model = driven_by(kind);
    Plant plant = one_robot(model, options());
    plant.write(0, duty_drive({0.2, 0.3, 0.2, 0.3}));
    for (int n = 0; n < 400; ++n) {
      plant.advance(500'000);
      const MotorSensors s = plant.motor_sensors(0);
      EXPECT_EQ(s.bus_voltage_V, model.bus_voltage_V);
      EXPECT_EQ(s.now_ns, static_cast<std::uint64_t>(plant.now_ns()) - 50'000);
      for (std::size_t i = 0; i < kWheels; ++i) {
        const double sum_A = s.phase_current_A[i][0] + s.phase_current_A[i][1] + s.phase_current_A[i][2];
        EXPECT_NEAR(sum_A, 0.0, 1e-9);
        EXPECT_EQ(hall_code({}, s.theta_elec_rad[i]), static_cast<int>(s.hall_code[i]));
      }
    }
    const RobotTruth t = plant.truth(0);
    for (std::size_t i = 0; i < kWheels; ++i) {
      const MotorSensors s = plant.motor_sensors(0);
      const double ago_s = 50e-6, theta = 8 * (t.theta_rotor_rad[i] - ago_s * t.omega_rotor_rad_s[i]);
      EXPECT_NEAR(std::remainder(s.theta_elec_rad[i] - theta, 2 * std::numbers::pi), 0.0, 0.02);
    }
  }
}

TEST(ElectricPlant, LegsThatAreOpenLetTheRobotCoastAndLegsHeldLowBrakeIt) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    double speed_after[2]{};
    for (const bool low : {false, true}) {
      Plant plant = one_robot(driven_by(kind), options());
      plant.write(0, duty_drive({0.4, 0.4, 0.4, 0.4}));
      plant.advance(600'000'000);
      MotorDrive legs{};
      for (auto& wheel : legs.leg) {
        for (std::uint32_t& leg : wheel) leg = low ? OMNIHIL_LEG_PWM : OMNIHIL_LEG_OFF;  // duty 0: held low
      }
      RobotDrive phases{};
      for (std::uint32_t& mode : phases.mode) mode = OMNIHIL_DRIVE_PHASES;
      plant.write(0, phases);
      plant.write_legs(0, legs);
      const double before = plant.truth(0).omega_wheel_rad_s[0];
      plant.advance(60'000'000);
      speed_after[low] = plant.truth(0).omega_wheel_rad_s[0] / before;
    }
    EXPECT_GT(speed_after[0], 0.9) << static_cast<int>(kind);
    EXPECT_LT(speed_after[1], 0.5) << static_cast<int>(kind);
  }
}

// Line to line, mean of the period: the difference of two sines of the angle in its middle.
TEST(ElectricPlant, LegsThatAreOpenShowTheBackEmfOfAWheelThatRolls) {
  for (const DriveKind kind : {DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = driven_by(kind);
    electrics(model).back_emf = {.shape = BackEmfShape::kSine};
    Plant plant = one_robot(model, options());
    plant.write(0, duty_drive({0.4, 0.4, 0.4, 0.4}));
    plant.advance(600'000'000);
    RobotDrive phases{};
    for (std::uint32_t& mode : phases.mode) mode = OMNIHIL_DRIVE_PHASES;
    plant.write(0, phases);
    plant.write_legs(0, {});
    plant.advance(20'000'000);
    const PhaseMotor<double> motor = phase_motor(model);
    const double per_omega_V = motor.pole_pairs * motor.flux_linkage_Wb;
    for (int n = 0; n < 20; ++n) {
      plant.advance(500'000);
      const MotorSensors s = plant.motor_sensors(0);
      const RobotTruth t = plant.truth(0);
      for (std::size_t i = 0; i < kWheels; ++i) {
        const double omega_rad_s = t.omega_rotor_rad_s[i], half_period_s = 25e-6;
        const double theta = motor.pole_pairs * (t.theta_rotor_rad[i] - half_period_s * omega_rad_s);
        const double peak_V = per_omega_V * omega_rad_s;
        for (int x = 0; x < 3; ++x) {
          const auto here = static_cast<std::size_t>(x), next = static_cast<std::size_t>((x + 1) % 3);
          const double turn = 2.0 / 3.0 * std::numbers::pi,
                       expected_V = peak_V * (std::sin(theta - turn * (x + 1)) - std::sin(theta - turn * x));
          EXPECT_NEAR(s.leg_V[i][here] - s.leg_V[i][next], expected_V, 0.01 * std::abs(peak_V))
              << static_cast<int>(kind);
        }
        EXPECT_GT(std::abs(peak_V), 2.0);
      }
    }
  }
}

TEST(ElectricPlant, ABatteryThatGivesWayToNothingIsTheConstantBus) {
  const double volt_V = 6 * 3.98;  // at 0.8 of its charge
  RobotModel stiff = on_battery(symmetric_robot(), 1e-6);
  electrics(stiff).battery.capacity_C = 1e9;
  RobotModel plain = symmetric_robot();
  stiff.bus_voltage_V = plain.bus_voltage_V = volt_V;
  Plant a = one_robot(stiff, options()), b = one_robot(plain, options());
  excite(a, 1.0);
  excite(b, 1.0);
  EXPECT_NEAR(a.truth(0).x_m, b.truth(0).x_m, 2e-3);
  EXPECT_NEAR(a.truth(0).yaw_rad, b.truth(0).yaw_rad, 2e-2);
  EXPECT_NEAR(a.sample_sensors(0).bus_voltage_V, volt_V, 1e-3);
}

TEST(ElectricPlant, BatterySagsWithAllMotorsTogetherAndItsChargeIsWhatLeftIt) {
  const double resistance_ohm = 0.1, duty = 0.3;
  for (const int driven : {1, 4}) {
    RobotModel model = on_battery(driven_by(DriveKind::kDq), resistance_ohm);
    model.motor.coulomb_friction_Nm = 1.0;  // stalled
    model.motor.current_limit_A = 0.0;
    Plant plant = one_robot(model, options());
    const double start_V = plant.electric_truth(0).bus_voltage_V;
    RobotDrive drive = duty_drive({duty, duty, duty, duty});
    for (int i = driven; i < kWheels; ++i) drive.mode[i] = OMNIHIL_DRIVE_COAST;
    plant.write(0, drive);
    plant.advance(20'000'000);
    // each takes duty * (duty V / R) from the bus: V = V_0 / (1 + n R_b duty^2 / R)
    const double load = driven * resistance_ohm * duty * duty / model.motor.resistance_ohm;
    EXPECT_NEAR(plant.sample_sensors(0).bus_voltage_V, start_V / (1.0 + load), 2e-3) << driven;
  }

  Plant plant = one_robot(on_battery(driven_by(DriveKind::kDq), resistance_ohm), options());
  const double start_C = plant.electric_truth(0).battery_charge_C;
  excite(plant, 1.0);
  const ElectricTruth t = plant.electric_truth(0);
  // no capacitor: the heat in the battery is R integral of i^2, its energy V integral of i
  EXPECT_NEAR((start_C - t.battery_charge_C) * 6 * 3.98, t.book.source_J, 0.01 * t.book.source_J);
}

TEST(ElectricPlant, AStalledWindingWarmsUpAsTheTwoMassesSayAndTakesLessCurrent) {
  for (const DriveKind kind : {DriveKind::kDc, DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = driven_by(kind);
    model.motor.coulomb_friction_Nm = 1.0;  // held
    electrics(model).heat = {.winding_to_housing_K_per_W = 2.0,
                             .housing_to_ambient_K_per_W = 6.0,
                             .winding_time_constant_s = 0.05,
                             .housing_time_constant_s = 0.4};
    const double duty = 0.05, volt_V = duty * model.bus_voltage_V;
    Plant plant = one_robot(model, options());
    plant.write(0, duty_drive({duty, duty, duty, duty}));
    plant.advance(4'000'000'000);
    // steady: dT = P (R_wh + R_ha), P = U^2 / (R (1 + alpha dT))
    double rise_K = 0.0;
    for (int n = 0; n < 100; ++n) {
      rise_K = 8.0 * volt_V * volt_V / (model.motor.resistance_ohm * (1 + kCopperPerK * rise_K));
    }
    EXPECT_NEAR(plant.electric_truth(0).winding_K[0], rise_K, 0.02 * rise_K + 0.2) << static_cast<int>(kind);
    EXPECT_NEAR(plant.electric_truth(0).housing_K[0], 0.75 * rise_K, 0.02 * rise_K + 0.2);
  }
}

TEST(ElectricPlant, SavedStateGoesOnWithTheSameBits) {
  for (const DriveKind kind : {DriveKind::kDc, DriveKind::kDq, DriveKind::kSwitched}) {
    RobotModel model = on_battery(driven_by(kind), 0.05);
    electrics(model).heat = {2.0, 6.0, 0.5, 20.0};
    electrics(model).current_sensor.bits = 12;
    electrics(model).current_sensor.noise_sigma_V = 1e-3;
    Plant a = one_robot(model, options()), b = one_robot(model, options());
    excite(a, 0.3);
    const auto state = a.save();
    ASSERT_TRUE(b.restore(state));
    excite(a, 0.2);
    excite(b, 0.2);
    EXPECT_EQ(a.save(), b.save()) << static_cast<int>(kind);
  }
}

TEST(ElectricPlant, RefusesAllThatDoesNotFitAtOnce) {
  RobotModel model = sample_robot();
  model.motor.inductance_H = 0.0;
  electrics(model).kind = DriveKind::kDq;
  electrics(model).back_emf.shape = BackEmfShape::kTrapezoid;
  electrics(model).battery.cells = 6;
  electrics(model).battery.takes_charge = false;
  electrics(model).heat.winding_to_housing_K_per_W = 1.0;
  std::string said;
  try {
    one_robot(model, options());
  } catch (const std::invalid_argument& e) {
    said = e.what();
  }
  for (const char* part : {"motor.inductance_H = 0", "motor.pole_pairs = 0", "motor.back_emf",
                           "refuses_charge", "housing_to_ambient_K_per_W", "winding_time_constant_s"}) {
    EXPECT_NE(said.find(part), std::string::npos) << part << " in:\n" << said;
  }
  RobotModel uneven = driven_by(DriveKind::kDq);
  electrics(uneven).inverter.pwm_frequency_Hz = 21e3;
  EXPECT_THROW(one_robot(uneven, options()), std::invalid_argument);
}

}  // namespace
}  // namespace omnihil
