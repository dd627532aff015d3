// A diagnosis made up for the tests of its report: a drive whose cogging (order 12) was found, with every
// part of a report filled, names that look like HTML, gaps and one sharp peak.
#pragma once
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "hil/report/report_html.h"

namespace omnihil {

inline constexpr double kPeak_rad_s = 55.5;  // one sample of the longest signal
inline constexpr double kPeakTime_s = 7.7;
inline const std::string kNastyName = "</script><img src=x onerror=\"alert('1')\"> & Söhne";

inline ReportOverlay sample_overlay(const std::string& run, Split split, const std::string& signal,
                                    double duration_s) {
  ReportOverlay o{run, split, signal, signal == "velocity" ? "rad/s" : "A", 0.4, {}, {}, {}, {}};
  for (int i = 0; i * 1e-3 < duration_s; ++i) {
    const double t = i * 1e-3, slow = 30.0 * std::sin(0.8 * t), angle = 37.5 * (1.0 - std::cos(0.8 * t));
    const double noise = 0.4 * std::sin(1e4 * t * t + 17.0 * i);
    o.time_s.push_back(t);
    o.measured.push_back(slow + 3.0 * std::sin(12.0 * angle) + noise);
    o.baseline.push_back(slow);
    o.final_model.push_back(slow + 2.9 * std::sin(12.0 * angle));
    if (i > 4000 && i < 4200) o.measured.back() = std::numeric_limits<double>::quiet_NaN();
    if (i == static_cast<int>(kPeakTime_s * 1e3)) o.measured.back() = kPeak_rad_s;
  }
  return o;
}

inline Comparison sample_comparison(double size) {
  Comparison c;
  for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation}) {
    const double factor = size * (split == Split::kExtrapolation ? 1.6 : 1.0);
    const auto add = [&](const char* signal, const char* unit, double noise) {
      SignalError e;
      e.signal = signal;
      e.unit = unit;
      e.split = split;
      e.samples = 20000;
      e.rmse = noise * factor;
      e.nrmse_percent = 2.0 * factor;
      e.noise_sigma = noise;
      e.in_sigmas = factor;
      c.errors.push_back(e);
    };
    add("velocity", "rad/s", 0.4);
    add("motor_current", "A", 0.03);
  }
  for (const std::string axis : {"speed", "rotor_angle", "time", "abs_current", "acceleration", "direction",
                                 "time_since_step", "temperature", "bus_voltage", "position"}) {
    RegimeError curve{"velocity",         axis, axis == "speed" ? "rad/s" : "1",
                      Split::kValidation, {},   0.6 / size + 0.05};
    for (int k = 0; k < 20; ++k) {
      const double share = k == 10 ? 0.62 : 0.02;
      curve.bins.push_back(
          {-30.0 + 3.0 * k, -27.0 + 3.0 * k, share, 0.05, 0.2 * size * std::sin(0.6 * k), 0.05});
    }
    c.regimes.push_back(curve);
  }
  c.worst.push_back({.signal = "velocity",
                     .axis = "speed",
                     .split = Split::kValidation,
                     .share = 0.62,
                     .time_share = 0.11,
                     .sentence = "62 % of the error energy of velocity is below 3 rad/s (11 % of the time)"});
  return c;
}

inline std::vector<ParameterEstimate> sample_parameters(double drift) {
  std::vector<ParameterEstimate> p(2);
  p[0] = {"motor.resistance_ohm",
          "ohm",
          0.5 + 0.05 * drift,
          0.004,
          0.005,
          0.5,
          0.05,
          drift,
          false,
          true,
          false,
          {},
          ""};
  p[1] = {"motor.rotor_inertia_kg_m2",
          "kg m2",
          1.3e-5,
          2e-6,
          std::numeric_limits<double>::infinity(),
          1.3e-5,
          1.3e-6,
          -drift,
          true,
          false,
          true,
          {"motor.resistance_ohm"},
          "not determined by these data, trades against motor.resistance_ohm"};
  return p;
}

inline Diagnosis sample_diagnosis() {
  Diagnosis d;
  d.dataset = "bench/" + kNastyName;
  d.findings = {
      {DataFinding::Grade::kFault, "glitch", kNastyName, "velocity", 12.0, "one sample jumps by 12 rad/s"},
      {DataFinding::Grade::kNote, "clock_jitter", "", "", 1e-4, "the clock jitters by 0.1 ms"}};
  d.baseline.model.file.rig = d.final_fit.model.file.rig = "axis";
  d.baseline.parameters = sample_parameters(2.6);
  d.final_fit.parameters = sample_parameters(0.3);
  d.final_fit.parameters.push_back(
      {"cogging.amplitude_Nm", "N m", 0.0021, 1e-5, 1e-5, 0.0, 0.0, 0.0, false, true, false, {}, ""});
  d.final_fit.findings = {"motor.rotor_inertia_kg_m2 is at its bound"};
  d.nominal_comparison = sample_comparison(9.0);
  d.baseline_comparison = sample_comparison(6.0);
  d.final_comparison = sample_comparison(1.1);
  d.verdict = Verdict::kEffect;
  d.effects = {"cogging"};
  d.ranking = {{"cogging",
                0.97,
                AcceptedBy::kGain,
                0.0,
                41.0,
                0.18,
                0.18,
                0.19,
                true,
                Visibility::kVisible,
                "lowers the held-out error by 82 %",
                {d.final_fit.parameters.back()}},
               {"stribeck_friction",
                0.02,
                AcceptedBy::kNone,
                0.0,
                3.0,
                0.97,
                1.02,
                1.1,
                true,
                Visibility::kVisible,
                "no gain on holdout",
                {}},
               {"payload",
                0.0,
                AcceptedBy::kPrior,
                0.0,
                1.0,
                1.0,
                1.0,
                1.0,
                true,
                Visibility::kVisible,
                "robot.mass_kg returns to its prior",
                {}},
               {"sample_jitter",
                0.01,
                AcceptedBy::kNoise,
                0.93,
                1.0,
                1.0,
                1.0,
                1.0,
                false,
                Visibility::kVisible,
                "explains the variance",
                {}},
               {"backlash",
                0.0,
                AcceptedBy::kNone,
                0.0,
                0.1,
                1.0,
                1.0,
                1.0,
                false,
                Visibility::kBelowNoise,
                "not visible in these data: no reversal",
                {}}};
  d.ladder = {{"nominal", d.nominal_comparison, {}, {}},
              {"base parameters refitted", d.baseline_comparison, d.baseline.parameters, d.ranking},
              {"cogging", d.final_comparison, d.final_fit.parameters, {}}};
  d.confounded = {{{"cogging", "torque_ripple"}, "alike at one current"}};
  d.where = {{"velocity", "rotor_angle", 0.83, 12.0}};
  d.unknown.formula = "a*sin(12*theta_rotor_rad)";
  d.unknown.expression_toml = "[effects.expression.rest]\nformula = \"a < b\"";
  d.next_experiment = {.what = "Hold three currents at 5 rad/s for 10 s each.",
                       .command = "omnihil experiment bench --separate cogging,torque_ripple --out next",
                       .separates = {"cogging", "torque_ripple"},
                       .expected_sigmas = 7.5};
  d.not_visible = {"backlash: the drive never reverses"};
  return d;
}

inline ReportInput sample_input(double duration_s = 20.0) {
  ReportInput in;
  in.diagnosis = sample_diagnosis();
  in.title = "Wheel <b>3</b> & co";
  in.model = "model.toml";
  in.command = "omnihil diagnose bench --report out.html";
  in.program = "omnihil";
  in.elapsed_s = 12.3;
  in.notes = {"2 rows were left out: " + kNastyName};
  in.overlays = {sample_overlay("steps.csv", Split::kTraining, "velocity", duration_s),
                 sample_overlay("steps.csv", Split::kTraining, "motor_current", duration_s),
                 sample_overlay(kNastyName, Split::kValidation, "velocity", duration_s)};
  OrderSpectrum spectrum{"velocity", "rad/s", "rotor_angle", {}, {}, {}, 0.3};
  for (int n = 1; n <= 60; ++n) {
    spectrum.order.push_back(n);
    spectrum.baseline.push_back(n == 12 ? 3.0 : 0.1);
    spectrum.final_model.push_back(0.1);
  }
  in.spectra = {spectrum};
  return in;
}

}  // namespace omnihil
