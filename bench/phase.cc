// What the three-phase drive costs, and how exact a step is.
//
//   bench_phase              prints the table; exit 0 when every target is met, 1 when one is missed
//   bench_phase --quick      a tenth of the measuring time
//
// Cost: CPU time of this thread per step of one motor, the best and the median of several repetitions;
// averaged sub-steps of 25 us with a look at the Hall sensors every second one. Error: speed after 20 ms from
// rest against a run converged in step.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <string_view>
#include <vector>

#include "bench/cpu_time.h"
#include "sim/drive/averaged_drive.h"
#include "sim/drive/dq_motor.h"
#include "sim/drive/hall_sensors.h"
#include "sim/drive/switched_drive.h"

namespace omnihil {
namespace {

constexpr int kMotors = 48;

PhaseMotor<double> motor(BackEmfShape shape) {
  MotorParams sheet;
  sheet.resistance_ohm = 0.447;
  sheet.inductance_H = 0.243e-3;
  sheet.torque_constant_Nm_per_A = 0.0295;
  sheet.rotor_inertia_kg_m2 = 135e-7;
  sheet.viscous_friction_Nm_s_per_rad = 2e-5;
  sheet.pole_pairs = 8;
  return phase_motor_of(sheet, Commutation::kBlock, {shape, 2.0 * std::numbers::pi / 3.0});
}

BridgeCommand six_step(double theta_rotor_rad, double duty_ratio, PwmMode mode) {
  static constexpr int kHigh[6] = {1, 1, 2, 2, 0, 0}, kLow[6] = {2, 0, 0, 1, 1, 2};
  const int sector = hall_sector(hall_code({}, 8 * theta_rotor_rad));
  return block_command(kHigh[sector], kLow[sector], duty_ratio, mode);
}

// ns per step of one motor: the best and the median of nine.
struct Cost {
  double best = 0.0, median = 0.0;
};

template <typename Step>
Cost cost_of(double repetition_s, Step step) {
  const auto run = [&](long steps) {
    const double start_s = thread_cpu_s();
    for (long k = 0; k < steps; ++k) step();
    return thread_cpu_s() - start_s;
  };
  long steps = 64;
  double cost_s = 0.0;
  while ((cost_s = run(steps)) < 0.005) steps *= 2;
  steps = std::max(1L, static_cast<long>(static_cast<double>(steps) * repetition_s / cost_s));
  std::vector<double> ns;
  for (int n = 0; n < 9; ++n) ns.push_back(1e9 * run(steps) / (static_cast<double>(steps) * kMotors));
  std::sort(ns.begin(), ns.end());
  return {ns.front(), ns[ns.size() / 2]};
}

Cost dq_cost(double repetition_s, double saturation_per_A) {
  PhaseMotor<double> m = motor(BackEmfShape::kSine);
  m.flux_saturation_per_A = m.inductance_saturation_per_A = saturation_per_A;
  std::vector<DqState<double>> x(kMotors);
  return cost_of(repetition_s, [&] {
    for (DqState<double>& s : x) advance_dq(m, s, {.v_d_V = -0.5, .v_q_V = 6.0, .tau_load_Nm = 0.02}, 50e-6);
  });
}

Cost averaged_cost(double repetition_s, BackEmfShape shape, PwmMode mode, double duty_ratio) {
  const Inverter inverter{.pwm_frequency_Hz = 20e3,
                          .dead_time_s = 0.5e-6,
                          .switch_resistance_ohm = 0.012,
                          .diode_forward_V = 0.8};
  const AveragedDrive d = make_averaged_drive(motor(shape), inverter, 25e-6, 0.0);
  std::vector<PhaseState> x(kMotors);
  std::vector<BridgeCommand> command(kMotors);
  PhaseFlow flow;
  int tick = 0;
  return cost_of(repetition_s, [&] {
    const bool looks = ++tick % 2 == 0;
    for (std::size_t n = 0; n < kMotors; ++n) {
      if (looks) command[n] = six_step(x[n].theta_rotor_rad, duty_ratio, mode);
      advance_averaged(d, x[n], command[n], {.bus_voltage_V = 24.0, .tau_load_Nm = 0.02}, flow);
    }
  });
}

Cost switched_cost(double repetition_s, PwmMode mode) {
  const SwitchedDrive d = make_switched_drive(motor(BackEmfShape::kTrapezoid),
                                              {.pwm_frequency_Hz = 20e3,
                                               .dead_time_s = 0.5e-6,
                                               .switch_resistance_ohm = 0.012,
                                               .diode_forward_V = 0.8},
                                              {.max_step_s = 25e-6});
  std::vector<SwitchedState> x(kMotors);
  PhaseFlow flow;
  return cost_of(repetition_s, [&] {
    for (SwitchedState& s : x)
      advance_period(d, s, six_step(s.motor.theta_rotor_rad, 0.4, mode),
                     {.bus_voltage_V = 24.0, .tau_load_Nm = 0.02}, 0.5, flow);
  });
}

double dq_speed_after(double step_s) {
  const PhaseMotor<double> m = motor(BackEmfShape::kSine);
  DqState<double> x;
  for (long k = 0; k < std::lround(0.02 / step_s); ++k)
    advance_dq(m, x, {.v_d_V = -0.5, .v_q_V = 6.0, .tau_load_Nm = 0.02}, step_s);
  return x.omega_rotor_rad_s;
}

bool row(const char* what, const Cost& c, double at_most) {
  const bool met = at_most <= 0.0 || c.best <= at_most;
  std::printf("%-66s %7.1f %7.1f ns", what, c.best, c.median);
  if (at_most > 0.0) std::printf("  at most %3.0f  %s", at_most, met ? "met" : "MISSED");
  std::printf("\n");
  std::fflush(stdout);
  return met;
}

struct Row {
  const char *word, *text;  // word: of --count
  double at_most_ns;        // 0: no target
  Cost (*cost)(double repetition_s);
};
constexpr BackEmfShape kTrapezoid = BackEmfShape::kTrapezoid, kSine = BackEmfShape::kSine;
constexpr PwmMode kComplementary = PwmMode::kComplementary, kChop = PwmMode::kHighSideChop;
const Row kRows[] = {
    {"dq", "dq step", 60, [](double s) { return dq_cost(s, 0.0); }},
    {"dq_saturated", "dq step, saturated", 0, [](double s) { return dq_cost(s, 0.025); }},
    {"averaged_duty_1", "six-step sub-step, averaged, trapezoid, complementary, duty 1", 60,
     [](double s) { return averaged_cost(s, kTrapezoid, kComplementary, 1.0); }},
    {"averaged_dead_time", "six-step sub-step, averaged, trapezoid, complementary, dead time", 60,
     [](double s) { return averaged_cost(s, kTrapezoid, kComplementary, 0.4); }},
    {"averaged_chop", "six-step sub-step, averaged, trapezoid, high-side chop", 60,
     [](double s) { return averaged_cost(s, kTrapezoid, kChop, 0.4); }},
    {"averaged_sine", "six-step sub-step, averaged, sine, complementary", 0,
     [](double s) { return averaged_cost(s, kSine, kComplementary, 0.4); }},
    {"switched", "PWM period at 20 kHz, switched, complementary, dead time", 0,
     [](double s) { return switched_cost(s, kComplementary); }},
    {"switched_chop", "PWM period at 20 kHz, switched, high-side chop", 0,
     [](double s) { return switched_cost(s, kChop); }},
};

int run(bool quick) {
  std::printf("%d motors, one core; best and median per motor and step\n", kMotors);
  bool good = true;
  for (const Row& r : kRows) good = row(r.text, r.cost(quick ? 0.01 : 0.1), r.at_most_ns) && good;
  const double converged = dq_speed_after(0.25e-6);
  std::printf("\ndq: error of the speed after 20 ms from rest (%.3f rad/s)\n", converged);
  for (const double h : {100e-6, 50e-6, 25e-6})
    std::printf("  step %5.0f us %12.2e rad/s\n", 1e6 * h, std::abs(dq_speed_after(h) - converged));
  return good ? 0 : 1;
}

// One row alone, for a count of its instructions; a motor's steps are printed.
int count(std::string_view word, long steps) {
  clock_counts_looks = true;
  for (const Row& r : kRows) {
    if (word != r.word) continue;
    r.cost(static_cast<double>(steps) / 64.0);  // of cost_of()'s first run, a second by this clock
    std::printf("%ld\n", 9 * steps * static_cast<long>(kMotors));
    return 0;
  }
  return 2;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return omnihil::count(argv[2], std::atol(argv[3]));
  return omnihil::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
}
