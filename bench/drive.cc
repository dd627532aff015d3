// What one drive costs per electrical sub-step (DC-equivalent), bare and with effects.
//
//   bench_drive              prints the table; exit 0 when every target is met, 1 when one is missed
//   bench_drive --quick      a tenth of the measuring time
//
// CPU time of this thread per 50 us sub-step of one motor, the best and the median of nine repetitions; 48
// motors, 20 sub-steps (1 ms) a call, a new duty each call, as twelve robots run them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "bench/cpu_time.h"
#include "sim/drive/dc_drive.h"
#include "sim/drive/drive_sim.h"
#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

constexpr int kMotors = 48;
constexpr int kSubsteps = 20;
constexpr double kStep_s = 50e-6;

// Maxon EC 45 flat 30 W, data sheet 200142, with a load of twice its rotor's inertia.
DriveParams<double> drive() {
  DriveParams<double> p;
  p.resistance_ohm = 1.2;
  p.inductance_H = 5.6e-4;
  p.torque_constant_Nm_per_A = 0.0255;
  p.rotor_inertia_kg_m2 = 9.25e-6;
  p.load_inertia_kg_m2 = 1.85e-5;
  p.viscous_friction_Nm_s_per_rad = 5e-6;
  p.supply_voltage_V = 12.0;
  p.pole_pairs = 8;
  p.slots = 12;
  return p;
}

double duty_at(long call, int motor) {
  return 0.8 * std::sin(0.002 * static_cast<double>(call) + 0.3 * motor);
}

struct Cost {
  double best_ns = 0.0, median_ns = 0.0;
};

template <typename Millisecond>
Cost cost_of(double repetition_s, Millisecond advance_all) {
  long calls = 0;
  std::vector<double> ns;
  for (int n = 0; n < 10; ++n) {
    const double start_s = thread_cpu_s();
    long done = 0;
    while (thread_cpu_s() - start_s < repetition_s) {
      for (int k = 0; k < 20; ++k) advance_all(calls++);
      done += 20;
    }
    const double spent_s = thread_cpu_s() - start_s;
    if (n > 0)
      ns.push_back(1e9 * spent_s / (static_cast<double>(done) * kMotors * kSubsteps));  // n = 0 warms up
  }
  std::sort(ns.begin(), ns.end());
  return {ns.front(), ns[ns.size() / 2]};
}

Cost plain_cost(double repetition_s) {
  MotorParams motor;
  motor.resistance_ohm = 1.2;
  motor.inductance_H = 5.6e-4;
  motor.torque_constant_Nm_per_A = 0.0255;
  motor.rotor_inertia_kg_m2 = 9.25e-6;
  const DcDrive one = make_dc_drive(motor, 1.85e-5, kStep_s);
  std::vector<DcDriveState> states(kMotors);
  std::vector<double> omega_rad_s(kMotors, 0.0);
  return cost_of(repetition_s, [&](long call) {
    for (std::size_t m = 0; m < states.size(); ++m) {
      const DcDriveResult r = advance_drive(one, states[m],
                                            {.mode = OMNIHIL_DRIVE_DUTY,
                                             .duty_ratio = duty_at(call, static_cast<int>(m)),
                                             .bus_voltage_V = 12.0,
                                             .omega_rotor_rad_s = omega_rad_s[m],
                                             .tau_load_Nm = 5e-6 * omega_rad_s[m]},
                                            kSubsteps);
      omega_rad_s[m] = r.omega_end_rad_s;
    }
  });
}

Cost effects_cost(double repetition_s, const std::vector<const char*>& ids) {
  std::vector<EffectUse> uses;
  const DriveParams<double> params = drive();
  for (const char* id : ids) uses.push_back(typical_use(*find_effect(id), &params));
  const DriveSim<double> sim(params, EffectSet<double>(uses), kStep_s);
  std::vector<DriveState<double>> states(kMotors, sim.initial_state());
  return cost_of(repetition_s, [&](long call) {
    for (std::size_t m = 0; m < states.size(); ++m) {
      sim.advance(
          states[m],
          {.kind = CommandKind::kDuty, .setpoint = duty_at(call, static_cast<int>(m)), .bus_voltage_V = 12.0},
          kSubsteps);
    }
  });
}

bool row(const char* name, const Cost& cost, double target_ns) {
  const bool met = cost.best_ns <= target_ns;
  std::printf("%-62s %7.2f %7.2f %7.0f  %s\n", name, cost.best_ns, cost.median_ns, target_ns,
              met ? "met" : "MISSED");
  return met;
}

struct Row {
  const char *word, *text;  // word: of --count
  double target_ns;
  Cost (*cost)(double repetition_s);
};
const Row kRows[] = {
    {"plant", "exact DC drive of the plant, no effect", 10.0, plain_cost},
    {"none", "drive with effects: none", 10.0, [](double s) { return effects_cost(s, {}); }},
    {"five", "Stribeck, cogging, torque ripple, heating, dead time", 90.0,
     [](double s) {
       return effects_cost(s,
                           {"stribeck_friction", "cogging", "torque_ripple", "winding_heating", "dead_time"});
     }},
};

int run(bool quick) {
  std::printf("%-62s %7s %7s %7s\n", "ns per sub-step of one motor", "best", "median", "target");
  bool all = true;
  Cost plain;
  for (const Row& r : kRows) {
    const Cost cost = r.cost(quick ? 0.02 : 0.2);
    all &= row(r.text, cost, r.target_ns);
    if (&r == kRows) plain = cost;
  }
  // 48 motors, 20 sub-steps per ms
  const double core_percent = plain.best_ns * 1e-9 * kMotors * 20e3 * 100.0;
  const bool met = core_percent < 3.0;
  std::printf("48 motors at 20 kHz, no effect: %.2f %% of a core (target 3 %%)  %s\n", core_percent,
              met ? "met" : "MISSED");
  return all && met ? 0 : 1;
}

// One row alone, for a count of its instructions; a motor's sub-steps are printed.
int count(std::string_view word, long calls) {
  clock_counts_looks = true;
  for (const Row& r : kRows) {
    if (word != r.word) continue;
    r.cost(static_cast<double>(calls) / 20.0);  // each look at the clock is 20 calls later
    std::printf("%ld\n", 10 * calls * kMotors * kSubsteps);
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
