// The switched model against ngspice on the same circuit: bridge, diodes, star-connected windings, back-EMF
// and rotor written as a netlist, gate signals as the switched model gave them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

constexpr double kBus_V = 24.0, kLoad_Nm = 0.02;
constexpr Inverter kBridge{
    .pwm_frequency_Hz = 20e3, .dead_time_s = 0.6e-6, .switch_resistance_ohm = 0.02, .diode_forward_V = 0.7};
constexpr int kPeriods = 160;
constexpr char kPhase[] = "abc";

struct Point {
  double time_s;
  std::array<double, 3> current_A;
  double omega_rad_s;
};

// What the switched model did: every boundary, and every change of a leg.
struct Trace : SwitchingListener {
  double period_begin_s = 0.0;
  std::vector<Point> points;
  std::vector<std::pair<double, std::array<LegState, 3>>> legs;
  void piece(double time_s, const std::array<LegState, 3>& now, const PhaseState& x) override {
    const double t = period_begin_s + time_s;
    points.push_back({t, x.current_A, x.omega_rotor_rad_s});
    if (legs.empty() || legs.back().second != now) legs.emplace_back(t, now);
  }
};

// Start-up at half duty, then a step to 0.8.
Trace run_switched(const PhaseMotor<double>& m, PwmMode mode) {
  const SwitchedDrive d = make_switched_drive(m, kBridge, {.max_step_s = 1e-6});
  SwitchedState x;
  PhaseFlow flow;
  Trace trace;
  for (int k = 0; k < kPeriods; ++k) {
    trace.period_begin_s = k * d.period_s;
    const double duty = k < kPeriods / 2 ? 0.5 : 0.8;
    advance_period(d, x, six_step(8 * x.motor.theta_rotor_rad, duty, mode),
                   {.bus_voltage_V = kBus_V, .tau_load_Nm = kLoad_Nm}, 0.5, flow, &trace);
  }
  return trace;
}

// A gate: 1 while the leg is in `on`, with edges of 2 ns around the instant.
void write_gate(std::ostream& out, const Trace& trace, std::size_t leg, LegState on) {
  out << "Vg" << kPhase[leg] << (on == LegState::kHigh ? 'h' : 'l') << " g" << kPhase[leg]
      << (on == LegState::kHigh ? 'h' : 'l') << " 0 PWL(";
  bool level = trace.legs.front().second[leg] == on;
  out << "0 " << level;
  for (const auto& [time_s, legs] : trace.legs) {
    const bool now = legs[leg] == on;
    if (now == level || time_s == 0.0) continue;
    out << "\n+ " << time_s - 1e-9 << ' ' << level << ' ' << time_s + 1e-9 << ' ' << now;
    level = now;
  }
  out << ")\n";
}

void write_phase(std::ostream& out, const PhaseMotor<double>& m, std::size_t x) {
  const char p = kPhase[x];
  // switches and diodes
  out << "S" << p << "h bus t" << p << " g" << p << "h 0 SW\nS" << p << "l t" << p << " 0 g" << p
      << "l 0 SW\n"
      << "D" << p << "h t" << p << " u" << p << " DI\nV" << p << "h u" << p << " bus "
      << kBridge.diode_forward_V << "\nD" << p << "l 0 d" << p << " DI\nV" << p << "l d" << p << " t" << p
      << ' ' << kBridge.diode_forward_V << '\n';
  // winding
  out << "Vi" << p << " t" << p << " m" << p << " 0\nR" << p << " m" << p << " n" << p << ' '
      << m.resistance_ohm << "\nL" << p << " n" << p << " o" << p << ' ' << m.inductance_q_H << " ic=0\nBe"
      << p << " o" << p << " star V = V(k" << p << ")*V(w)\n";
  // K_x(theta): the triangle wave is asin(sin x)
  const double k = m.pole_pairs * m.flux_linkage_Wb,
               ramp = 0.5 * (std::numbers::pi - m.back_emf.flat_top_rad);
  std::ostringstream angle;
  angle.precision(17);
  angle << "sin(V(th)-" << static_cast<double>(x) * 2.0 * std::numbers::pi / 3.0 << ')';
  out << "Bk" << p << " k" << p << " 0 V = " << -k << "*";
  if (m.back_emf.shape == BackEmfShape::kSine)
    out << angle.str() << '\n';
  else
    out << "max(-1,min(1,asin(" << angle.str() << ")/" << ramp << "))\n";
}

void write_netlist(const fs::path& file, const fs::path& result, const PhaseMotor<double>& m,
                   const Trace& trace) {
  std::ofstream out(file);
  out.precision(15);
  out << "* three-phase bridge and motor\nVbus bus 0 " << kBus_V << "\nRstar star 0 1e7\n"
      << ".model SW SW(VT=0.5 VH=0 RON=" << kBridge.switch_resistance_ohm << " ROFF=1e6)\n"
      << ".model DI D(IS=1e-9 N=0.01 RS=" << kBridge.switch_resistance_ohm << ")\n";
  for (std::size_t x = 0; x < 3; ++x) {
    write_phase(out, m, x);
    write_gate(out, trace, x, LegState::kHigh);
    write_gate(out, trace, x, LegState::kLow);
  }
  // rotor: speed and electrical angle as voltages on capacitors
  out << "Cw w 0 " << m.rotor_inertia_kg_m2 << " ic=0\nBw 0 w I = V(ka)*I(Via)+V(kb)*I(Vib)+V(kc)*I(Vic)-"
      << m.viscous_friction_Nm_s_per_rad << "*V(w)-" << kLoad_Nm
      << "\nCth th 0 1e-3 ic=0\nBth 0 th I = " << 1e-3 * m.pole_pairs << "*V(w)\n"
      << ".options reltol=1e-5 abstol=1e-9 vntol=1e-7 method=gear itl4=100\n.control\nset wr_singlescale\n"
      << "tran 0.2u " << kPeriods / kBridge.pwm_frequency_Hz << " 0 0.1u uic\n"
      << "wrdata " << result.string() << " i(Via) i(Vib) i(Vic) v(w)\nquit\n.endc\n.end\n";
}

std::vector<Point> read_result(const fs::path& file) {
  std::ifstream in(file);
  std::vector<Point> points;
  Point p;
  while (in >> p.time_s >> p.current_A[0] >> p.current_A[1] >> p.current_A[2] >> p.omega_rad_s)
    points.push_back(p);
  return points;
}

struct Difference {
  double current_rms_ratio, omega_ratio;
};

// Our boundaries against the other's points, linear between them.
Difference compare(const std::vector<Point>& ours, const std::vector<Point>& theirs) {
  double square = 0.0, size = 0.0, worst_omega = 0.0;
  std::size_t k = 0;
  for (const Point& p : ours) {
    while (k + 2 < theirs.size() && theirs[k + 1].time_s < p.time_s) ++k;
    const Point &a = theirs[k], &b = theirs[k + 1];
    const double s = (p.time_s - a.time_s) / (b.time_s - a.time_s);
    for (std::size_t x = 0; x < 3; ++x) {
      const double there = a.current_A[x] + s * (b.current_A[x] - a.current_A[x]);
      square += (p.current_A[x] - there) * (p.current_A[x] - there);
      size += there * there;
    }
    worst_omega = std::max(worst_omega,
                           std::abs(p.omega_rad_s - (a.omega_rad_s + s * (b.omega_rad_s - a.omega_rad_s))));
  }
  return {std::sqrt(square / size), worst_omega / ours.back().omega_rad_s};
}

void expect_agreement(const char* name, const PhaseMotor<double>& m, PwmMode mode) {
  if (std::system("ngspice --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "ngspice is not installed: no circuit simulator to compare with";
  const fs::path folder =
      fs::temp_directory_path() / (std::string("omnihil_ngspice_") + name + std::to_string(getpid()));
  fs::create_directories(folder);
  const Trace trace = run_switched(m, mode);
  write_netlist(folder / "drive.cir", folder / "result.txt", m, trace);
  const std::string call =
      "ngspice -b " + (folder / "drive.cir").string() + " > " + (folder / "ngspice.log").string() + " 2>&1";
  ASSERT_EQ(std::system(call.c_str()), 0) << "see " << folder / "ngspice.log";
  const auto theirs = read_result(folder / "result.txt");
  ASSERT_GT(theirs.size(), 10000u) << "see " << folder / "ngspice.log";
  ASSERT_NEAR(theirs.back().time_s, kPeriods / kBridge.pwm_frequency_Hz, 1e-6);
  ASSERT_GT(trace.points.back().omega_rad_s, 100.0);
  const Difference d = compare(trace.points, theirs);
  EXPECT_LT(d.current_rms_ratio, 0.005);
  EXPECT_LT(d.omega_ratio, 0.005);
  testing::Test::RecordProperty("current_rms_ratio", std::to_string(d.current_rms_ratio));
  std::printf("%s: currents differ by %.2e rms, speed by %.2e\n", name, d.current_rms_ratio, d.omega_ratio);
  fs::remove_all(folder);
}

TEST(Ngspice, SlowTrapezoidComplementaryWithDeadTimeStartUpAndStep) {
  expect_agreement("complementary", trapezoid_motor(), PwmMode::kComplementary);
}

TEST(Ngspice, SlowSineHighSideChopStartUpAndStep) {
  expect_agreement("chop", sine_motor(), PwmMode::kHighSideChop);
}

TEST(Ngspice, SlowTrapezoidFastDecayStartUpAndStep) {
  expect_agreement("fast_decay", trapezoid_motor(), PwmMode::kFastDecay);
}

}  // namespace
}  // namespace omnihil
