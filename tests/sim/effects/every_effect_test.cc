// What must hold for every effect there is, whoever wrote it.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/model/axis_model.h"
#include "sim/model/model_rows.h"
#include "tests/sim/effects/bench.h"
#include "tests/sim/effects/port_cases.h"

namespace omnihil::test {
namespace {

constexpr std::uint64_t kDraws = 200;

bool is_base_parameter(std::string_view path) {
  const auto paths = drive_param_paths();
  return path == "robot.mass_kg" || std::any_of(paths.begin(), paths.end(), [&](const DriveParamPath& p) {
           return p.path == path || p.linear_path == path;
         });
}

TEST_P(EveryEffect, SaysWhatItIsAndWhatItCannotDo) {
  EXPECT_FALSE(info().title.empty());
  EXPECT_FALSE(info().equation.empty());
  EXPECT_FALSE(info().source.empty());
  EXPECT_FALSE(info().cannot.empty());
  EXPECT_FALSE(info().reveals.empty());
  EXPECT_FALSE(info().visible.empty());
  EXPECT_NE(info().rigs, 0u);
  if (info().min_visible != nullptr) {
    const double coarse =
        info().min_visible({.counts_per_turn = 100, .current_sigma_A = 1, .voltage_sigma_V = 1});
    const double fine = info().min_visible({});
    EXPECT_GT(fine, 0.0);
    EXPECT_GE(coarse, fine) << "worse sensors show less";
  }
}

TEST_P(EveryEffect, HasTwinsThatExistAndNotItself) {
  for (const std::string_view twin : info().twins) {
    if (twin.empty()) continue;
    EXPECT_NE(twin, info().id);
    const auto names = effect_names();
    const bool effect = std::find(names.begin(), names.end(), twin) != names.end();
    EXPECT_TRUE(effect || is_base_parameter(twin)) << twin << " is neither an effect nor a base parameter";
  }
}

TEST_P(EveryEffect, HasBoundsAroundNeutralAndTypical) {
  ASSERT_FALSE(info().params.empty());
  EXPECT_EQ(std::count_if(info().params.begin(), info().params.end(),
                          [](const EffectParam& p) { return p.role == ParamRole::kStrength; }) > 0,
            true);
  for (const EffectParam& row : info().params) {
    EXPECT_LT(row.lower, row.upper) << row.name;
    EXPECT_TRUE(row.typical >= row.lower && row.typical <= row.upper) << row.name;
    EXPECT_GE(row.prior_scale, 0.0) << row.name;
    EXPECT_FALSE(row.what.empty()) << row.name;
    EXPECT_FALSE(row.how.empty()) << row.name;
    EXPECT_FALSE(row.unit.empty()) << row.name << ": \"1\" for a ratio";
    if (row.role == ParamRole::kShape) {
      EXPECT_TRUE(std::isnan(row.neutral)) << row.name << ": a shape has no neutral value (kNoNeutral)";
    } else {
      EXPECT_TRUE(row.neutral >= row.lower && row.neutral <= row.upper) << row.name;
      EXPECT_GT(row.prior_scale, 0.0) << row.name << ": finite density at neutral";
      EXPECT_NE(row.typical, row.neutral) << row.name << ": a visible size";
    }
  }
}

// Of a drive like a watch's and of one like a car's: a model with it can be written and read again.
TEST_P(EveryEffect, StartsWithinItsBoundsInAnyDrive) {
  for (const double scale : {1e-4, 1.0, 1e4}) {
    DriveParams<double> drive = small_drive();
    drive.rotor_inertia_kg_m2 *= scale;
    drive.load_inertia_kg_m2 *= scale;
    drive.resistance_ohm /= scale;
    for (const EffectUse& use : {typical_use(entry(), &drive), neutral_use(entry(), &drive)}) {
      for (std::size_t i = 0; i < use.values.size(); ++i) {
        EXPECT_GE(use.values[i], info().params[i].lower) << info().params[i].name << ", scale " << scale;
        EXPECT_LE(use.values[i], info().params[i].upper) << info().params[i].name << ", scale " << scale;
      }
    }
  }
}

TEST_P(EveryEffect, StaysFiniteAtItsBounds) {
  for (std::size_t i = 0; i < info().params.size(); ++i) {
    for (const double bound : {info().params[i].lower, info().params[i].upper}) {
      std::vector<double> params = typical_use(entry()).values;
      params[i] = bound;
      for_each_place<double>(entry(), [&](auto function, auto port) {
        for (std::uint64_t n = 0; n < 20; ++n) {
          for (const auto& c : changes(applied<double>(entry(), function, port, params, n))) {
            EXPECT_TRUE(std::isfinite(c.value)) << info().params[i].name << " = " << bound;
          }
        }
      });
    }
  }
}

// A drive that starts from rest passes through the smallest numbers there are, where 1 / x is no number.
TEST_P(EveryEffect, StaysFiniteNextToRest) {
  const std::vector<Jet> at = as_jets(typical_use(entry()).values, 0);
  for (const double motion : {1e-150, 1e-300, 1e-311, 0.0}) {
    for_each_place<Jet>(entry(), [&](auto function, auto port) {
      for (std::uint64_t n = 0; n < 20; ++n) {
        for (const auto& c : changes(applied<Jet>(entry(), function, port, at, n, 1.0, motion))) {
          EXPECT_TRUE(std::isfinite(c.value.a)) << "motion times " << motion;
          EXPECT_TRUE(std::isfinite(c.value.v[0])) << "motion times " << motion;
        }
      }
    });
  }
}

TEST_P(EveryEffect, ChangesNothingAtNeutralBitForBit) {
  const std::vector<EffectUse> uses{neutral_use(entry())};
  EXPECT_TRUE(EffectSet<double>(uses).none());
  const AxisInput in = excite(Excitation::kSteps, 0.8, 1.0);
  const auto without = run_axis(small_drive(), nothing(), in);
  const auto neutral = run_axis(small_drive(), EffectSet<double>(uses), in);
  ASSERT_EQ(without.size(), neutral.size());
  for (std::size_t n = 0; n < without.size(); ++n) {
    for (const auto signal : {&AxisSample<double>::position_rad, &AxisSample<double>::velocity_rad_s,
                              &AxisSample<double>::motor_current_A, &AxisSample<double>::bus_voltage_V}) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(without[n].*signal),
                std::bit_cast<std::uint64_t>(neutral[n].*signal))
          << "sample " << n;
    }
  }
}

// The skipped call would have changed nothing either: so derivatives at neutral belong to the same model.
TEST_P(EveryEffect, HasALawThatChangesNothingAtNeutral) {
  const std::vector<double> params = neutral_use(entry()).values;
  for_each_place<double>(entry(), [&](auto function, auto port) {
    for (std::uint64_t n = 0; n < kDraws; ++n) {
      auto before = port;
      CommandHistory history;
      fill(before, Draw{n}, 1.0, history);
      const auto was = changes(before);
      const auto is = changes(applied<double>(entry(), function, port, params, n));
      for (std::size_t i = 0; i < was.size(); ++i) {
        if (place_of(port) == Place::kWinding && i == 5) continue;  // a temperature that others read
        EXPECT_NEAR(is[i].value, was[i].value, 1e-12 * (1.0 + std::abs(was[i].value))) << "change " << i;
      }
    }
  });
}

TEST_P(EveryEffect, HasDerivativesThatAgreeWithDifferences) {
  const std::vector<double> at = typical_use(entry()).values;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double step =
        1e-6 * std::max(std::abs(at[i]), 1e-2 * (info().params[i].upper - info().params[i].lower));
    std::vector<double> up = at, down = at;
    up[i] += step;
    down[i] -= step;
    const auto jets = as_jets(at, static_cast<int>(i));
    std::size_t checked = 0, kinks = 0;
    const auto compare = [&](const auto& mid, const auto& more, const auto& less, const auto& jet) {
      for (std::size_t c = 0; c < mid.size(); ++c) {
        const double forward = (more[c].value - mid[c].value) / step,
                     back = (mid[c].value - less[c].value) / step;
        const double scale =
            std::max({std::abs(forward), std::abs(back), std::abs(mid[c].value) * 1e-4 / step * 1e-6});
        if (std::abs(forward - back) > 1e-3 * scale + 1e-9) {
          ++kinks;
          continue;
        }
        ++checked;
        EXPECT_NEAR(jet[c].value.v[0], 0.5 * (forward + back), 1e-4 * scale + 1e-9 + 2e-15 / step)
            << info().params[i].name << ", change " << c;
        EXPECT_NEAR(jet[c].value.a, mid[c].value, 1e-12 * (1.0 + std::abs(mid[c].value)));
      }
    };
    for_each_place<double>(entry(), [&](auto function, auto port) {
      for_each_place<Jet>(entry(), [&](auto jet_function, auto jet_port) {
        if (place_of(port) != place_of(jet_port)) return;
        for (std::uint64_t n = 0; n < kDraws; ++n) {
          compare(changes(applied<double>(entry(), function, port, at, n)),
                  changes(applied<double>(entry(), function, port, up, n)),
                  changes(applied<double>(entry(), function, port, down, n)),
                  changes(applied<Jet>(entry(), jet_function, jet_port, jets, n)));
        }
      });
    });
    EXPECT_GT(checked, 10 * kinks) << info().params[i].name << ": hardly any point has a derivative";
  }
}

// Every signal of a drive's record.
template <typename T>
std::vector<T> signals_of(const std::vector<AxisSample<T>>& samples) {
  std::vector<T> out;
  for (const AxisSample<T>& s : samples) {
    out.insert(out.end(), {s.position_rad, s.velocity_rad_s, s.encoder_counts, s.motor_current_A,
                           s.bus_voltage_V, s.winding_rise_K, s.motor_voltage_V});
  }
  return out;
}

// Steps of the duty and of a position target under a load; with random numbers and with what is expected.
std::vector<AxisInput> probes() {
  std::vector<AxisInput> inputs{excite(Excitation::kSteps, 0.8, 1.0), excite(Excitation::kPrbs, 1.0, 1.0)};
  inputs[1].kind = CommandKind::kPositionTarget;
  for (AxisInput& in : inputs) {
    in.encoder_counts_per_turn = 4096;
    for (const double t : in.time_s) in.load_torque_Nm.push_back(0.01 * std::sin(20.0 * t));
  }
  inputs.push_back(inputs[0]);
  inputs[2].noise_seed = 1;
  return inputs;
}

DriveParams<double> probed_drive() {
  DriveParams<double> drive = small_drive();
  drive.servo_kp_duty_per_rad = 2.0;
  drive.coulomb_friction_Nm = 0.002;
  return drive;
}

// The largest derivative with respect to one strength, all at neutral: of a drive's signals, or of what the
// law changes where only a robot has the place.
double slope_at_neutral(const EffectEntry& entry, std::size_t row) {
  const EffectUse use = neutral_use(entry);
  const std::vector<Jet> values = as_jets(use.values, static_cast<int>(row));
  double most = 0.0;
  const auto look = [&](const Jet& x) { most = std::max(most, std::abs(x.v[0])); };
  if ((entry.info->rigs & kOnAxis) != 0) {
    const EffectSet<Jet> set(std::vector{use}, std::span<const Jet>(values));
    for (const AxisInput& in : probes()) {
      for (const Jet& x : signals_of(run_axis(drive_params_as<Jet>(probed_drive()), set, in))) look(x);
    }
  } else {
    for_each_place<Jet>(entry, [&](auto function, auto port) {
      for (std::uint64_t n = 0; n < kDraws; ++n) {
        for (const auto& c : changes(applied<Jet>(entry, function, port, values, n))) look(c.value);
      }
    });
  }
  return most;
}

double change_at_typical(const EffectEntry& entry, std::size_t row) {
  std::vector<double> at = typical_use(entry).values, more = at;
  more[row] += 1e-3 * (at[row] - entry.info->params[row].neutral);
  double most = 0.0;
  const auto set_of = [&](const std::vector<double>& values) {
    EffectUse use = typical_use(entry);
    use.values = values;
    return with({use});
  };
  for (const AxisInput& in : probes()) {
    const auto a = signals_of(run_axis(probed_drive(), set_of(at), in));
    const auto b = signals_of(run_axis(probed_drive(), set_of(more), in));
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(b[i] - a[i]));
  }
  for_each_place<double>(entry, [&](auto function, auto port) {
    for (std::uint64_t n = 0; n < kDraws; ++n) {
      const auto a = changes(applied<double>(entry, function, port, at, n));
      const auto b = changes(applied<double>(entry, function, port, more, n));
      for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(b[i].value - a[i].value));
    }
  });
  return most;
}

// So a fit that starts at neutral feels it, or knows that it does not.
TEST_P(EveryEffect, HasASlopeAtNeutralOrSaysThatItIsFlatThere) {
  for (std::size_t i = 0; i < info().params.size(); ++i) {
    if (info().params[i].role != ParamRole::kStrength) continue;
    const double slope = slope_at_neutral(entry(), i);
    if ((info().claims & kFlatAtNeutral) == 0) {
      EXPECT_GT(slope, 0.0) << info().params[i].name << ": claim kFlatAtNeutral";
    } else {
      EXPECT_EQ(slope, 0.0) << info().params[i].name;
      EXPECT_GT(change_at_typical(entry(), i), 0.0) << info().params[i].name;
    }
  }
}

TEST_P(EveryEffect, IsOddIfItClaimsSo) {
  if ((info().claims & kOdd) == 0) return;
  const std::vector<double> params = typical_use(entry()).values;
  for_each_place<double>(entry(), [&](auto function, auto port) {
    for (std::uint64_t n = 0; n < kDraws; ++n) {
      const auto forward = changes(applied<double>(entry(), function, port, params, n, 1.0));
      const auto back = changes(applied<double>(entry(), function, port, params, n, -1.0));
      for (std::size_t i = 0; i < forward.size(); ++i) {
        const double expected = forward[i].odd ? -forward[i].value : forward[i].value;
        EXPECT_NEAR(back[i].value, expected, 1e-12 * (1.0 + std::abs(expected))) << "change " << i;
      }
    }
  });
}

// Power that one call adds; positive adds energy.
double added_power(const TorquePort<double>& p) { return p.tau_Nm * p.omega_rotor_rad_s; }
double added_power(const BodyPort<double>& p) {
  return p.force_x_N * p.v_forward_m_s + p.force_y_N * p.v_left_m_s + p.torque_z_Nm * p.omega_body_rad_s;
}
double added_power(const ContactPort<double>& p) {
  return p.force_longitudinal_N * p.v_longitudinal_m_s + p.force_lateral_N * p.v_lateral_m_s;
}
template <typename Port>
double added_power(const Port&) {
  return 0.0;
}

TEST_P(EveryEffect, NeverAddsPowerIfItClaimsToDissipate) {
  if ((info().claims & kDissipative) == 0 || !info().states.empty()) return;
  const std::vector<double> params = typical_use(entry()).values;
  for_each_place<double>(entry(), [&](auto function, auto port) {
    for (std::uint64_t n = 0; n < kDraws; ++n) {
      auto before = port;
      CommandHistory history;
      fill(before, Draw{n}, 1.0, history);
      const auto after = applied<double>(entry(), function, port, params, n);
      EXPECT_LE(added_power(after), 1e-15);
      if constexpr (requires { after.voltage_V; }) {
        EXPECT_LE((after.voltage_V - before.voltage_V) * after.current_A, 1e-15);
      }
      if constexpr (requires { after.friction_positive_Nm; }) {
        EXPECT_GE(after.friction_positive_Nm, 0.0);
        EXPECT_GE(after.friction_negative_Nm, 0.0);
        EXPECT_GE(after.viscous_positive_Nm_s_per_rad, 0.0);
        EXPECT_GE(after.viscous_negative_Nm_s_per_rad, 0.0);
      }
      if constexpr (requires { after.friction_wheel_Nm; }) {
        EXPECT_GE(after.friction_wheel_Nm, 0.0);
      }
      if constexpr (requires { after.bus_current_A; }) {
        EXPECT_LE((after.bus_voltage_V - before.bus_voltage_V) * after.bus_current_A, 1e-15);
      }
      if constexpr (requires { after.torque_constant_Nm_per_A; }) {
        EXPECT_GE(after.resistance_ohm, before.resistance_ohm);
        EXPECT_EQ(after.torque_constant_Nm_per_A, after.back_emf_V_s_per_rad);
      }
    }
  });
}

// Left to coast, the energy of the mechanism only falls; effects with states may give back what they stored.
TEST_P(EveryEffect, LetsACoastingRotorLoseEnergyIfItClaimsToDissipate) {
  if ((info().claims & kDissipative) == 0 || (info().rigs & kOnAxis) == 0) return;
  AxisInput in = held(CommandKind::kDuty, 0.0, 0.5);
  in.initial_velocity_rad_s = 200.0;
  const auto samples = run_axis(small_drive(), with({typical_use(entry())}), in);
  const double most = info().states.empty() ? 0.0 : 0.05;
  for (std::size_t n = 1; n < samples.size(); ++n) {
    EXPECT_LE(std::abs(samples[n].omega_rotor_rad_s), std::abs(samples[n - 1].omega_rotor_rad_s) + most);
  }
  EXPECT_LT(std::abs(samples.back().omega_rotor_rad_s), 200.0);
}

TEST_P(EveryEffect, DoesNoWorkOverATurnIfItClaimsToBeConservative) {
  if ((info().claims & kConservative) == 0) return;
  const auto params = law_params<double>(entry(), typical_use(entry()).values);
  const auto function = entry().simulate.torque;
  ASSERT_NE(function, nullptr);
  const int kParts = 4800;  // a multiple of every order in use
  double work = 0.0, size = 0.0;
  for (int n = 0; n < kParts; ++n) {
    TorquePort<double> port;
    port.omega_rotor_rad_s = 1.0;
    port.theta_rotor_rad = port.theta_output_rad = port.travel_rad =
        n * 2.0 * 3.14159265358979323846 / kParts;
    function(entry().context, params.data(), nullptr, port);
    work += port.tau_Nm / kParts;
    size += std::abs(port.tau_Nm) / kParts;
  }
  EXPECT_GT(size, 0.0);
  EXPECT_LT(std::abs(work), 1e-9 * size);
}

INSTANTIATE_TEST_SUITE_P(Effects, EveryEffect,
                         ::testing::ValuesIn(all_effects().begin(), all_effects().end()),
                         [](const auto& p) { return std::string(p.param->info->id); });

}  // namespace
}  // namespace omnihil::test
