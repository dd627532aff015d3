// Electrical energy in = heat + work on the load + energy stored in winding and rotor, in every mode.
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/drive/dc_drive.h"
#include "tests/sim/drive/motors_for_tests.h"

namespace omnihil {
namespace {

using testing::coast;
using testing::duty;
using testing::kSubstep_s;
using testing::plain_motor;
using testing::Spin;

struct Case {
  const char* name;
  double inductance_H;
  double current_limit_A;
  bool coasting;  // in between
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class DcDriveEnergy : public ::testing::TestWithParam<Case> {};

TEST_P(DcDriveEnergy, BalancesToOnePartInABillion) {
  MotorParams m = plain_motor();
  m.inductance_H = GetParam().inductance_H;
  m.current_limit_A = GetParam().current_limit_A;
  Spin spin{make_dc_drive(m, 5e-6, kSubstep_s)};
  const double inertia_kg_m2 = m.rotor_inertia_kg_m2 + 5e-6;
  double load_work_J = 0.0, largest_J = 0.0;
  const auto stored_J = [&] {
    const double i = spin.state.current_A;
    return 0.5 * m.inductance_H * i * i + 0.5 * inertia_kg_m2 * spin.omega_rad_s * spin.omega_rad_s;
  };
  for (int ms = 0; ms < 600; ++ms) {
    const double load_Nm = 0.02 * std::cos(0.013 * ms);
    const bool off = GetParam().coasting && ms % 50 > 40;
    const double asked = ms < 400 ? std::sin(0.02 * ms) : (ms % 20 < 10 ? 1.0 : -1.0);
    const DcDriveInput input =
        off ? coast(12.0, spin.omega_rad_s, load_Nm) : duty(asked, 12.0, spin.omega_rad_s, load_Nm);
    const DcDriveResult r = spin.run(input, 20);
    load_work_J += load_Nm * r.angle_rad;
    largest_J = std::max({largest_J, std::abs(spin.electrical_J), spin.heat_J});
    ASSERT_NEAR(spin.electrical_J, spin.heat_J + load_work_J + stored_J(), 1e-9 * largest_J)
        << "at " << ms << " ms";
  }
  EXPECT_GT(spin.heat_J, 0.5);  // something happened
}

INSTANTIATE_TEST_SUITE_P(
    Modes, DcDriveEnergy,
    ::testing::Values(Case{"plain", 0.56e-3, 0.0, false}, Case{"no_inductance", 0.0, 0.0, false},
                      Case{"limited", 0.56e-3, 4.0, false}, Case{"limited_no_inductance", 0.0, 4.0, false},
                      Case{"coasting", 0.56e-3, 0.0, true}, Case{"coasting_no_inductance", 0.0, 0.0, true},
                      Case{"limited_coasting", 0.56e-3, 4.0, true}),
    [](const auto& test) { return test.param.name; });

TEST(DcDriveBus, CurrentIsDutyTimesMotorCurrent) {
  Spin spin{make_dc_drive(plain_motor(), 0.0, kSubstep_s)};
  const DcDriveResult r = spin.run(duty(-0.4, 12.0), 20);
  EXPECT_LT(r.mean_current_A, 0.0);
  EXPECT_NEAR(r.mean_bus_current_A, -0.4 * r.mean_current_A, 1e-12);
}

TEST(DcDriveBus, BrakingGivesCurrentBack) {
  Spin spin{make_dc_drive(plain_motor(), 1e-3, kSubstep_s)};
  spin.omega_rad_s = 400.0;  // 10.2 V of back-EMF
  const DcDriveResult r = spin.run(duty(0.6, 12.0), 20);
  EXPECT_LT(r.mean_torque_Nm, 0.0);
  EXPECT_LT(r.mean_bus_current_A, 0.0);
}

}  // namespace
}  // namespace omnihil
