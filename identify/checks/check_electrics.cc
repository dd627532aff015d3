// Scales of current and speed, held against the motor's own equation.
//
// With a current: i = u / R - (k / R) w over windows, so that R and k come out separately: R far from the
// model's means a wrong scale of the current, k far from it one of the speed. Without a current the speed
// per volt alone: w = u / k' - friction, k' = k (1 + R b / k^2). Windows of 0.2 s average inductance and
// delays out. Effects change R and k by some ten per cent, rarely by half: a fault needs a factor that no
// effect brings, or the same factor in the acceleration (J dw/dt = k i - friction), which a wrong back-EMF
// leaves alone. Runs of another kind of motion (extrapolation) are left out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "identify/checks/check_list.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"

namespace omnihil {
namespace {

using Grade = DataFinding::Grade;

constexpr double kWindow_s = 0.2;  // some hundred electrical time constants (L/R) of a small motor; a choice
constexpr std::size_t kLeastWindows = 15;  // several per coefficient of the line; a choice
// |log| of a ratio that should be 1: 32 %, 39 %, 2.2 times. Tuned; what effects bring, the file header says.
constexpr double kDoubtful = 0.28, kWrong = 0.33;  // tuned
constexpr double kWrongAlone = 0.8;  // likewise, where the acceleration does not confirm it; tuned
constexpr double kTolerances =
    4.0;  // prior deviations of the model's parameter: p = 6e-5 of a normal, derived
// |log|: a factor of three; winding heat and friction bring less.
constexpr double kWrongCurrent = 1.1;  // tuned
// Share of the ideal speed. Derived: half is the least wrong scale that there is (one edge counted of two).
constexpr double kFastEnough = 0.5;  // derived

struct Windows {
  std::vector<double> u, w, i, side;  // voltage, rotor speed, current, sign of the voltage
};

Windows windows_of(const CheckContext& data, std::size_t wheel, bool also_extrapolation = false) {
  Windows out;
  const double gear = nominal_value(data.nominal, "gear.ratio").value_or(1.0);
  for (const RunView& view : data.runs) {
    const DriveView& drive = view.drives[wheel];
    if (view.run->steady || view.period_s > 0.05) continue;
    if (view.run->split == Split::kExtrapolation && !also_extrapolation) continue;
    if (drive.position == nullptr && drive.velocity == nullptr) continue;
    std::vector<double> u = asked_voltage(data, view, drive);
    if (u.empty()) continue;
    if (const auto* enable = view.run->signal("enable")) {
      for (std::size_t k = 0; k < u.size(); ++k) {
        if ((*enable)[k] == 0.0) u[k] = NAN;
      }
    }
    const WindowMeans means = window_means(view, drive, u, kWindow_s);
    for (std::size_t k = 0; k < means.drive.size(); ++k) {
      out.u.push_back(means.drive[k]);
      out.w.push_back(means.speed[k] * gear);
      out.i.push_back(means.current[k]);
      out.side.push_back(means.drive[k] > 0.0 ? 1.0 : (means.drive[k] < 0.0 ? -1.0 : 0.0));
    }
  }
  return out;
}

Windows with_current(const Windows& all) {
  Windows out;
  for (std::size_t k = 0; k < all.u.size(); ++k) {
    if (!std::isfinite(all.i[k])) continue;
    out.u.push_back(all.u[k]);
    out.w.push_back(all.w[k]);
    out.i.push_back(all.i[k]);
    out.side.push_back(all.side[k]);
  }
  return out;
}

std::string speed_name(const CheckContext& data, std::size_t wheel) {
  for (const RunView& view : data.runs) {
    const DriveView& drive = view.drives[wheel];
    if (drive.position != nullptr) return drive.position_name;
    if (drive.velocity != nullptr) return "velocity";
  }
  return "";
}

// A bridge that opens in its off-time lets the motor coast (effect coast_mode): its speed is bounded by the whole bus,
// whatever the duty, and comes nearer to the duty's own the larger that is. A wrong scale is the same at all duties, and
// friction makes the ratio rise.
enum class Coasting { kNo, kPossible, kShown };
Coasting coasting(const CheckContext& data, std::size_t wheel, const Windows& all) {
  // Ratio of speed to voltage at the upper quarter of voltages over that at the lower half: a choice, a bridge without
  // current loses more between them.
  constexpr double kFalls = 0.8;  // a choice
  const double bus_V = nominal_value(data.nominal, "supply.voltage_V").value_or(0.0);
  const double constant = nominal_value(data.nominal, "motor.torque_constant_Nm_per_A").value_or(0.0);
  const bool by_duty = data.runs.front().drives[wheel].drive_name.starts_with("duty");
  if (!by_duty || constant * largest_size(all.w) > bus_V) return Coasting::kNo;
  std::vector<std::pair<double, double>> by_voltage;  // |u|, w / u
  for (std::size_t k = 0; k < all.u.size(); ++k) {
    if (all.w[k] * all.u[k] > 0.0) by_voltage.emplace_back(std::abs(all.u[k]), all.w[k] / all.u[k]);
  }
  std::sort(by_voltage.begin(), by_voltage.end());
  if (by_voltage.size() < kLeastWindows) return Coasting::kPossible;
  const auto ratio = [&](std::size_t from, std::size_t to) {
    std::vector<double> some;
    for (std::size_t k = from; k < to; ++k) some.push_back(by_voltage[k].second);
    return median(some);
  };
  const std::size_t n = by_voltage.size();
  return ratio(n - n / 4, n) < kFalls * ratio(0, n / 2) ? Coasting::kShown : Coasting::kPossible;
}

// The model has it already.
bool declares_coasting(const CheckContext& data) {
  const EffectUse* declared = use_of(data.nominal, "coast_mode");
  return declared != nullptr && !is_neutral(*declared);
}

const char* words_of(Coasting coasts) {
  switch (coasts) {
    case Coasting::kPossible:
      return ", or a bridge that lets it coast in its off-time (coast_mode: search all the same)";
    case Coasting::kShown:
      return ", or a bridge that lets it coast in its off-time (coast_mode): the ratio falls with the duty";
    case Coasting::kNo:
      break;
  }
  return "";
}

void say_speed(const CheckContext& data, std::size_t wheel, double ratio, double confirmed, const char* how,
               const Windows& all, std::vector<DataFinding>& findings) {
  const double tolerance = kTolerances * tolerance_of(data.nominal, "motor.torque_constant_Nm_per_A");
  const double off = std::abs(std::log(ratio));
  if (off < std::max(kDoubtful, tolerance)) return;
  const std::string name = speed_name(data, wheel);
  const bool same = std::log(confirmed) * std::log(ratio) > 0.0 && std::abs(std::log(confirmed)) > 0.5 * off;
  const double wrong = std::max(same ? kWrong : kWrongAlone, tolerance);
  const Coasting coasts = ratio > 1.0 ? coasting(data, wheel, all) : Coasting::kNo;
  if (coasts != Coasting::kNo && declares_coasting(data)) return;
  const bool fault = off > wrong && coasts != Coasting::kShown;
  findings.push_back(
      {fault ? Grade::kFault : Grade::kDoubt, "wrong_scale", "", name, ratio,
       fmt::format("the speed from {} is {:.3g} times what {} and the model's torque constant "
                   "allow: a wrong scale (gear ratio, counts_per_rev or a unit), or not this motor{}",
                   name, ratio, how, words_of(coasts))});
}

// Acceleration over what current and nominal inertia allow; 1 where it cannot be told.
double acceleration_ratio(const CheckContext& data, std::size_t wheel) {
  // Within one acceleration of a small motor, beyond its L/R.
  constexpr double kShortWindow_s = 0.02;  // a choice
  const double gear = nominal_value(data.nominal, "gear.ratio").value_or(1.0);
  std::vector<double> torque, acceleration, speed, side;
  const DriveParams<double> nominal = drive_of(data.nominal);
  for (const RunView& view : data.runs) {
    const DriveView& drive = view.drives[wheel];
    if (view.run->steady || drive.current == nullptr || view.period_s > 0.005) continue;
    const std::vector<double> none(view.run->time_s.size(), 0.0);
    const WindowMeans w = window_means(view, drive, none, kShortWindow_s);
    for (std::size_t k = 1; k + 1 < w.speed.size(); ++k) {
      const double span_s = w.time_s[k + 1] - w.time_s[k - 1];
      if (span_s > 3.0 * kShortWindow_s || !std::isfinite(w.current[k])) continue;
      torque.push_back(nominal.torque_constant_Nm_per_A * w.current[k]);
      acceleration.push_back((w.speed[k + 1] - w.speed[k - 1]) * gear / span_s);
      speed.push_back(w.speed[k] * gear);
      side.push_back(w.speed[k] > 0.0 ? 1.0 : -1.0);
    }
  }
  const LineFit line = fit_line({acceleration, speed, side}, torque);
  if (line.coefficient.empty() || line.explained < 0.5 || line.coefficient[0] <= 5.0 * line.sigma[0])
    return 1.0;
  return inertia_at_rotor(nominal) / line.coefficient[0];
}

// A wrong scale of the current leaves the speed's as it is, and the other way round. A bridge that coasts is too fast for its duty at
// too small a current: a doubt, unless the model has it. True: it is that.
bool coasts_by_both(const CheckContext& data, std::size_t wheel, double current_ratio, double speed_ratio,
                    const Windows& all, std::vector<DataFinding>& findings) {
  const double tolerance = kTolerances * tolerance_of(data.nominal, "motor.torque_constant_Nm_per_A");
  const bool both =
      std::log(current_ratio) < -kWrong && std::log(speed_ratio) > std::max(kDoubtful, tolerance);
  if (!both || coasting(data, wheel, all) == Coasting::kNo) return false;
  if (declares_coasting(data)) return true;
  findings.push_back(
      {Grade::kDoubt, "wrong_scale", "", speed_name(data, wheel), speed_ratio,
       fmt::format(
           "the speed from {} is {:.3g} times, and the current {:.2g} times what the voltage and the "
           "model allow: a bridge that lets the motor coast in its off-time (coast_mode), or two wrong "
           "scales",
           speed_name(data, wheel), speed_ratio, current_ratio)});
  return true;
}

// A coefficient that is this many of its sigmas stands for itself: the windows are not independent. A choice.
constexpr double kKnown_sigmas = 10.0;  // a choice

// True: the current told the scales.
bool by_current(const CheckContext& data, std::size_t wheel, const Windows& all,
                std::vector<DataFinding>& findings) {
  const Windows w = with_current(all);
  const double resistance = nominal_value(data.nominal, "motor.resistance_ohm").value_or(0.0);
  const double constant = nominal_value(data.nominal, "motor.torque_constant_Nm_per_A").value_or(0.0);
  if (w.u.size() < kLeastWindows || resistance <= 0.0 || constant <= 0.0) return false;
  const std::vector<double> ones(w.u.size(), 1.0);
  const LineFit line = fit_line({w.u, w.w, w.side, ones}, w.i);
  if (line.coefficient.empty() || line.explained < 0.7) return false;
  const double a = line.coefficient[0], b = line.coefficient[1];
  const std::string name = "motor_current" + data.runs.front().drives[wheel].suffix;
  if (a < -kKnown_sigmas * line.sigma[0] && b > kKnown_sigmas * line.sigma[1]) {
    findings.push_back({Grade::kFault, "swapped_sign", "", name, a,
                        fmt::format("{} falls where the voltage rises: its sign is swapped", name)});
    return true;
  }
  if (a < kKnown_sigmas * line.sigma[0] || -b < kKnown_sigmas * line.sigma[1]) return false;
  const double current_ratio = a * resistance, speed_ratio = constant / (-b / a);
  if (coasts_by_both(data, wheel, current_ratio, speed_ratio, all, findings)) return true;
  if (std::abs(std::log(current_ratio)) > kWrongCurrent) {
    const bool thousand = current_ratio > 400.0 && current_ratio < 2500.0;
    // What a bridge may lose in dead times and switches: two body diodes of 0.75 V. Below the current at which it loses all of
    // that, the loss grows with the current as a resistance does.
    constexpr double kBridgeLoss_V = 1.5;  // a choice
    constexpr double kLeastRatio = 0.1;  // a choice: most of what drives a winding is not lost in front of it
    const double lost_V = resistance * (1.0 / current_ratio - 1.0) * largest_size(w.i);
    const bool may_be_bridge = current_ratio > kLeastRatio && current_ratio < 1.0 && lost_V < kBridgeLoss_V;
    findings.push_back(
        {may_be_bridge ? Grade::kDoubt : Grade::kFault, "wrong_scale", "", name, current_ratio,
         fmt::format("{} is {:.3g} times what the voltage and the model's resistance allow: a wrong "
                     "scale or unit{}{}",
                     name, current_ratio, thousand ? " (milliamperes, mA, in place of A)" : "",
                     may_be_bridge
                         ? fmt::format(", or a bridge that loses up to {:.2g} V (dead_time)", lost_V)
                         : "")});
  }
  const double confirmed = data.dataset.rig->of_robot ? speed_ratio : acceleration_ratio(data, wheel);
  say_speed(data, wheel, speed_ratio, confirmed, "voltage, current", all, findings);
  return true;
}

// Friction, loads and dead bands only slow a drive: how fast it gets for its voltage bounds its scale from below. The third
// largest w k' / u over windows of all runs in which at least half of the highest voltage is asked (three windows, 0.6 s:
// not a reversal by chance; a choice); 0: fewer windows.
double fastest_ratio(const CheckContext& data, std::size_t wheel, double ideal_rad_s_per_V) {
  constexpr std::size_t kWindows = 3;  // as above: a choice
  const Windows all = windows_of(data, wheel, true);
  const double highest_V = largest_size(all.u);
  std::vector<double> ratios;
  for (std::size_t k = 0; k < all.u.size(); ++k) {
    if (std::abs(all.u[k]) >= 0.5 * highest_V) ratios.push_back(all.w[k] / all.u[k] / ideal_rad_s_per_V);
  }
  return ratios.size() < kWindows ? 0.0 : order_statistic(ratios, ratios.size() - kWindows);
}

void by_speed_per_volt(const CheckContext& data, std::size_t wheel, const Windows& all,
                       std::vector<DataFinding>& findings) {
  const double resistance = nominal_value(data.nominal, "motor.resistance_ohm").value_or(0.0);
  const double constant = nominal_value(data.nominal, "motor.torque_constant_Nm_per_A").value_or(0.0);
  const double viscous = nominal_value(data.nominal, "motor.viscous_friction_Nm_s_per_rad").value_or(0.0);
  if (all.u.size() < kLeastWindows || constant <= 0.0) return;
  const LineFit line = fit_line({all.u, all.side}, all.w);
  if (line.coefficient.empty() || line.explained < 0.8) return;
  // At one working point the voltage differs by the supply's drift alone, and the sign takes the place of a scale.
  if (line.coefficient[0] < kKnown_sigmas * line.sigma[0]) return;
  const double drag = resistance * viscous / (constant * constant);
  const double ratio = line.coefficient[0] * constant * (1.0 + drag);
  if (ratio <= 0.0) return;  // said by check_direction
  if (ratio < 1.0 && fastest_ratio(data, wheel, 1.0 / (constant * (1.0 + drag))) > kFastEnough) return;
  // A speed that is too low may come from a load; where viscous drag R b / k^2 is below kLightDrag it may
  // not, unless less than kLoaded of the speed is left. Both tuned.
  constexpr double kLightDrag = 0.1, kLoaded = 0.25;  // tuned
  if (ratio < 1.0 && (drag > kLightDrag || ratio > kLoaded)) {
    if (drag <= kLightDrag && ratio < 0.75) {
      const std::string name = speed_name(data, wheel);
      findings.push_back(
          {Grade::kDoubt, "wrong_scale", "", name, ratio,
           fmt::format("the speed from {} is {:.3g} times what the voltage and the model's torque "
                       "constant give without load: a heavy load, or a wrong scale (gear ratio, "
                       "counts_per_rev or a unit)",
                       name, ratio)});
    }
    return;
  }
  say_speed(data, wheel, ratio, 1.0, "the voltage", all, findings);
}

}  // namespace

void check_electrics(const CheckContext& data, std::vector<DataFinding>& findings) {
  if (data.runs.empty() || data.dataset.linear) return;
  for (std::size_t wheel = 0; wheel < data.runs.front().drives.size(); ++wheel) {
    const Windows all = windows_of(data, wheel);
    if (!by_current(data, wheel, all, findings)) by_speed_per_volt(data, wheel, all, findings);
  }
}

}  // namespace omnihil
