// Regime variables of an axis.
#include <algorithm>
#include <cmath>

#include "identify/predict/predictor_axis.h"

namespace omnihil {
namespace {

std::vector<double> slope(const std::vector<double>& t, const std::vector<double>& x) {
  std::vector<double> out(x.size(), kMissing);
  for (std::size_t k = 1; k + 1 < x.size(); ++k) out[k] = (x[k + 1] - x[k - 1]) / (t[k + 1] - t[k - 1]);
  return out;
}

template <typename Map>
std::vector<double> mapped(const std::vector<double>& x, Map map) {
  std::vector<double> out;
  for (const double v : x) out.push_back(std::isfinite(v) ? map(v) : kMissing);
  return out;
}

}  // namespace

std::vector<RegimeTrack> axis_regimes(const AxisSetup& s, const Candidate& model, double step_s) {
  std::vector<RegimeTrack> out;
  const AxisInput& in = s.input;
  if (in.time_s.empty()) return out;
  const DriveParams<double> drive = drive_of(model);
  const double gear = drive.gear_ratio;
  std::vector<AxisSample<double>> samples;
  if (!s.steady) samples = run_axis(drive, EffectSet<double>(model.effects), in, {.step_s = step_s});
  const auto modelled = [&](auto get) {
    std::vector<double> v;
    for (const AxisSample<double>& sample : samples) v.push_back(get(sample));
    return v;
  };
  const auto add = [&](const char* name, const char* unit, std::vector<double> value) {
    if (value.size() == in.time_s.size()) out.push_back({name, unit, std::move(value)});
  };
  const bool linear = drive.linear;
  std::vector<double> speed = s.velocity;
  if (speed.empty()) speed = modelled([&](const auto& x) { return x.omega_rotor_rad_s / gear; });
  std::vector<double> angle = s.position;
  if (angle.empty()) angle = modelled([&](const auto& x) { return x.theta_rotor_rad / gear; });
  std::vector<double> current = s.measured_current;
  if (current.empty() && in.kind == CommandKind::kMotorCurrent) current = in.command;
  if (current.empty() && drive.resistance_ohm > 0.0)
    current = modelled([](const auto& x) { return x.motor_current_A; });
  add("speed", linear ? "m/s" : "rad/s", mapped(speed, [](double v) { return std::abs(v); }));
  add("velocity", linear ? "m/s" : "rad/s", speed);
  add("direction", "1", mapped(speed, [](double v) { return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0); }));
  if (!s.steady) add("acceleration", linear ? "m/s2" : "rad/s2", slope(in.time_s, speed));
  add("abs_current", "A", mapped(current, [](double v) { return std::abs(v); }));
  add("rotor_angle", linear ? "m" : "rad", mapped(angle, [&](double v) { return v * gear; }));
  add("output_angle", linear ? "m" : "rad", angle);
  add("position", linear ? "m" : "rad", angle);
  if (!s.steady) add("time", "s", in.time_s);
  if (!s.steady) add("time_since_step", "s", since_step(in.time_s, {in.command}));
  std::vector<double> command = mapped(in.command, [](double v) { return std::abs(v); });
  add("abs_command", "", command);
  std::vector<double> warm = s.measured_temperature;
  if (warm.empty() && !samples.empty() && samples.back().winding_rise_K != 0.0) {
    warm = modelled([&](const auto& x) { return x.winding_rise_K + s.first_temperature_degC; });
  }
  add("temperature", "degC", warm);
  add("bus_voltage", "V", in.bus_voltage_V);
  return out;
}

}  // namespace omnihil
