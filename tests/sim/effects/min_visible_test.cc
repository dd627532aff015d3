// The smallest visible size that an effect's page states: three times that shows in the record that reveals
// the effect, through the sensors' noise, after everything that the base model's parameters could explain.
// How much smaller still shows is not claimed: a fit that trusts its whole record sees less than the simple
// estimators of the pages do.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "sim/law/random.h"
#include "tests/sim/effects/bench.h"
#include "tests/sim/effects/port_cases.h"

namespace omnihil::test {
namespace {

constexpr int kBaseParameters = 7;

// The experiment of the effect's picture, with full amplitude, for as long as the sensors are asked for.
AxisInput revealing_record(const EffectInfo& info, const SensorSet& sensors) {
  const std::string_view name = info.plot.excitation;
  const bool still = name == "locked" || name == "stall";
  const Excitation kind = name == "locked" || name == "turn"
                              ? Excitation::kCreep
                              : find_excitation(name).value_or(Excitation::kSteps);
  AxisInput in = excite(kind, 1.0, sensors.duration_s, sensors.rate_Hz);
  if (name == "stall") in.command.assign(in.command.size(), 0.5);
  if (name == "servo") in.kind = CommandKind::kPositionTarget;
  if (still) in.imposed_velocity_rad_s.assign(in.time_s.size(), 0.0);
  in.encoder_counts_per_turn = sensors.counts_per_turn;
  if ((info.claims & kRandom) != 0) in.noise_seed = 1;
  return in;
}

DriveParams<double> watched_drive() {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 0.003;
  p.servo_kp_duty_per_rad = 2.0;
  return p;
}

// What the sensors see, each over its noise: counts are rounded, a speed comes from two counts.
template <typename T>
std::vector<T> seen(const std::vector<AxisSample<T>>& samples, const SensorSet& s) {
  const double speed_step_rad_s = 2.0 * M_PI / s.counts_per_turn * s.rate_Hz;
  std::vector<T> out;
  for (const AxisSample<T>& x : samples) {
    out.insert(out.end(), {x.encoder_counts * std::sqrt(12.0), x.velocity_rad_s / speed_step_rad_s,
                           x.motor_current_A / s.current_sigma_A, x.bus_voltage_V / s.voltage_sigma_V});
  }
  return out;
}

// Changes of the record with the base parameters, that the effect itself stands for excepted.
Eigen::MatrixXd explained_by_base(const EffectInfo& info, const AxisInput& in, const SensorSet& sensors) {
  DriveParams<Jet> p = drive_params_as<Jet>(watched_drive());
  Jet* const unknowns[kBaseParameters] = {&p.resistance_ohm,     &p.inductance_H,
                                          &p.load_inertia_kg_m2, &p.torque_constant_Nm_per_A,
                                          &p.supply_voltage_V,   &p.viscous_friction_Nm_s_per_rad,
                                          &p.coulomb_friction_Nm};
  const int used = info.id == "coulomb_friction" ? kBaseParameters - 1 : kBaseParameters;
  for (int j = 0; j < used; ++j) unknowns[j]->v[j] = 1.0;
  const std::vector<Jet> record = seen(run_axis(p, EffectSet<Jet>(), in), sensors);
  Eigen::MatrixXd columns(record.size(), kBaseParameters);
  for (std::size_t n = 0; n < record.size(); ++n) {
    for (int j = 0; j < kBaseParameters; ++j) columns(static_cast<Eigen::Index>(n), j) = record[n].v[j];
  }
  for (int j = 0; j < kBaseParameters; ++j) {
    if (columns.col(j).norm() > 0.0) columns.col(j).normalize();
  }
  return columns;
}

TEST_P(EveryEffect, IsVisibleAtThreeTimesItsSmallestVisibleSize) {
  if (info().min_visible == nullptr || (info().rigs & kOnAxis) == 0) return;
  const SensorSet sensors;
  const AxisInput in = revealing_record(info(), sensors);
  const DriveParams<double> drive = watched_drive();
  EffectUse use = neutral_use(entry(), &drive);
  const std::size_t row = first_strength(info());
  use.values[row] += 3.0 * info().min_visible(sensors);
  if (info().id == "thermal_derating") use.values[2] = 4.0;  // a full current that the record reaches
  const auto without = seen(run_axis(drive, nothing(), in), sensors);
  const auto with_it = seen(run_axis(drive, with({use}), in), sensors);
  Eigen::VectorXd difference(without.size()), noise(without.size());
  for (std::size_t n = 0; n < without.size(); ++n) {
    difference[static_cast<Eigen::Index>(n)] = with_it[n] - without[n];
    noise[static_cast<Eigen::Index>(n)] = gaussian(1, stream_of(info().id), n);
  }
  const Eigen::MatrixXd base = explained_by_base(info(), in, sensors);
  const Eigen::VectorXd left = difference - base * base.colPivHouseholderQr().solve(difference);
  ASSERT_GT(left.norm(), 0.0);
  // the matched filter's reading, in sigma
  const Eigen::VectorXd shape = left.normalized();
  EXPECT_GT(shape.dot(difference + noise), 3.0);
  EXPECT_LT(std::abs(shape.dot(noise)), 3.0) << "noise alone";
}

}  // namespace
}  // namespace omnihil::test
