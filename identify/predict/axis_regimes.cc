// Regime variables of an axis.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "identify/predict/predictor_axis.h"

namespace omnihil {
std::vector<RegimeTrack> axis_regimes(const AxisSetup& s, const Candidate& model, double step_s) {
  std::vector<RegimeTrack> out;
  const AxisInput& in = s.input;
  if (in.time_s.empty()) return out;
  const DriveParams<double> drive = drive_of(model);
  const double gear = drive.gear_ratio;
  std::vector<AxisSample<double>> samples;
  if (!s.steady) samples = run_axis(drive, EffectSet<double>(model.effects), in, {.step_s = step_s});
  // As measured, else as the model has it.
  const auto known = [&](std::vector<double> measured, auto modelled) {
    if (measured.empty())
      std::transform(samples.begin(), samples.end(), std::back_inserter(measured), modelled);
    return measured;
  };
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& value) {
    if (value.size() == in.time_s.size()) out.push_back({name, unit, value});
  };
  const auto mapped = [](std::vector<double> x, auto map) {
    for (double& v : x) v = std::isfinite(v) ? map(v) : kMissing;
    return x;
  };
  const auto size = [](double v) { return std::abs(v); };
  const char *way = drive.linear ? "m" : "rad", *per_s = drive.linear ? "m/s" : "rad/s";
  const std::vector<double> speed =
      known(s.velocity, [&](const auto& x) { return x.omega_rotor_rad_s / gear; });
  const std::vector<double> angle =
      known(s.position, [&](const auto& x) { return x.theta_rotor_rad / gear; });
  std::vector<double> current = s.measured_current, warm = s.measured_temperature;
  if (current.empty() && in.kind == CommandKind::kMotorCurrent) current = in.command;
  if (drive.resistance_ohm > 0.0) current = known(current, [](const auto& x) { return x.motor_current_A; });
  if (!samples.empty() && samples.back().winding_rise_K != 0.0)
    warm = known(warm, [&](const auto& x) { return x.winding_rise_K + s.first_temperature_degC; });
  add("speed", per_s, mapped(speed, size));
  add("velocity", per_s, speed);
  add("direction", "1", mapped(speed, [](double v) { return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0); }));
  std::vector<double> acceleration(speed.size(), kMissing);
  for (std::size_t k = 1; k + 1 < speed.size(); ++k) acceleration[k] = rate_at(in.time_s, speed, k);
  add("acceleration", drive.linear ? "m/s2" : "rad/s2", acceleration);
  add("abs_current", "A", mapped(current, size));
  add("rotor_angle", way, mapped(angle, [&](double v) { return v * gear; }));
  add("output_angle", way, angle);
  add("position", way, angle);
  add("time", "s", in.time_s);
  add("time_since_step", "s", since_step(in.time_s, {in.command}));
  add("abs_command", "", mapped(in.command, size));
  add("temperature", "degC", warm);
  add("bus_voltage", "V", in.bus_voltage_V);
  return out;
}

}  // namespace omnihil
