// The picture of an effect's page: one signal over another in a simulated record, with the effect and
// without.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/bench/axis_signal.h"
#include "sim/bench/excitation.h"
#include "sim/law/effect_registry.h"
#include "sim/pages/effect_page.h"

namespace omnihil {
namespace {

constexpr double kWidth = 640, kHeight = 320, kLeft = 70, kRight = 15, kTop = 30, kBottom = 45;  // pixels
constexpr double kRate_Hz = 1000.0;
constexpr double kStallDuty = 0.5;  // 5 A and 30 W in the demonstration drive
constexpr std::size_t kMostPoints = 500;

struct Curve {
  std::vector<double> x, y;
};

// "turn": the bench turns the shaft once over the time shown, no current. "locked": the bench holds the
// shaft, the duty creeps. "stall": it holds it at a constant duty. "servo": steps of a position target.
// Otherwise an excitation of the duty, the shaft free.
AxisInput record_for(const EffectPlot& plot) {
  AxisInput in;
  in.noise_seed = 1;  // for effects that draw numbers
  const bool turn = plot.excitation == "turn", locked = plot.excitation == "locked",
             stall = plot.excitation == "stall";
  const bool servo = plot.excitation == "servo";
  const auto named = find_excitation(plot.excitation);
  assert(named || turn || locked || stall || servo);
  const Excitation kind = locked ? Excitation::kCreep : named.value_or(Excitation::kSteps);
  const double scale = turn ? 0.0 : (stall ? kStallDuty : 1.0);
  const auto count = static_cast<std::size_t>(plot.to_s * kRate_Hz) + 1;
  const double length_s = std::max(plot.to_s, 1.0);
  for (std::size_t n = 0; n < count; ++n) {
    const double t = static_cast<double>(n) / kRate_Hz;
    in.time_s.push_back(t);
    in.command.push_back(scale * (stall ? 1.0 : excitation_at(kind, t, {.duration_s = length_s})));
  }
  if (turn) in.kind = CommandKind::kMotorCurrent;
  if (servo) in.kind = CommandKind::kPositionTarget;
  if (turn || locked || stall) {
    in.imposed_velocity_rad_s.assign(count, turn ? 2.0 * std::numbers::pi / (plot.to_s - plot.from_s) : 0.0);
  }
  return in;
}

Curve curve_of(const DriveParams<double>& drive, const EffectSet<double>& effects, const AxisInput& in,
               const EffectPlot& plot) {
  const AxisSignal *x = find_axis_signal(plot.x), *y = find_axis_signal(plot.y);
  assert(x != nullptr && y != nullptr);
  const auto samples = run_axis(drive, effects, in);
  Curve curve;
  const auto from = static_cast<std::size_t>(plot.from_s * kRate_Hz);
  const std::size_t every = std::max<std::size_t>(1, (samples.size() - from) / kMostPoints);
  for (std::size_t k = std::max<std::size_t>(from, 1); k < samples.size(); k += every) {
    curve.x.push_back(x->get(samples[k], in, k));
    curve.y.push_back(y->get(samples[k], in, k));
  }
  return curve;
}

// A step of 1, 2 or 5 times a power of ten that parts a span into three to eight.
double tick_step(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 4.0)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (span / (m * power) <= 8.0) return m * power;
  }
  return 10.0 * power;
}

struct Axis {
  double low, high, from, to;  // values, pixels
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

Axis axis_over(const std::vector<double>& a, const std::vector<double>& b, double from, double to) {
  double low = *std::min_element(a.begin(), a.end()), high = *std::max_element(a.begin(), a.end());
  low = std::min(low, *std::min_element(b.begin(), b.end()));
  high = std::max(high, *std::max_element(b.begin(), b.end()));
  const double margin = std::max(0.04 * (high - low), 1e-9);
  return {low - margin, high + margin, from, to};
}

std::string line_of(const Curve& c, const Axis& x, const Axis& y, const char* style) {
  std::string points;
  for (std::size_t i = 0; i < c.x.size(); ++i)
    points += fmt::format("{:.1f},{:.1f} ", x.at(c.x[i]), y.at(c.y[i]));
  return fmt::format("<polyline fill=\"none\" {} points=\"{}\"/>\n", style, points);
}

std::string ticks(const Axis& axis, bool horizontal) {
  std::string out;
  const double step = tick_step(axis.high - axis.low);
  for (double n = std::ceil(axis.low / step); n * step <= axis.high; ++n) {
    const double at = axis.at(n * step);
    const std::string text = fmt::format("{:g}", n == 0.0 ? 0.0 : n * step);
    if (horizontal) {
      out += fmt::format(
          "<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" stroke=\"#ddd\"/>"
          "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
          at, kTop, kHeight - kBottom, kHeight - kBottom + 16, text);
    } else {
      out += fmt::format(
          "<line x1=\"{1}\" y1=\"{0:.1f}\" x2=\"{2}\" y2=\"{0:.1f}\" stroke=\"#ddd\"/>"
          "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
          at, kLeft, kWidth - kRight, kLeft - 6, at + 4, text);
    }
  }
  return out;
}

std::string label(std::string_view name, std::string_view unit) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return unit.empty() || unit == "1" ? text : fmt::format("{} / {}", text, unit);
}

}  // namespace

std::string effect_picture(const EffectEntry& entry) {
  const EffectInfo& info = *entry.info;
  if ((info.rigs & kOnAxis) == 0) return "";
  const DriveParams<double> drive = demonstration_drive();
  const AxisInput in = record_for(info.plot);
  const std::vector<EffectUse> uses{typical_use(entry, &drive)};
  const Curve without = curve_of(drive, EffectSet<double>(), in, info.plot);
  const Curve with = curve_of(drive, EffectSet<double>(uses), in, info.plot);
  const Axis x = axis_over(without.x, with.x, kLeft, kWidth - kRight);
  const Axis y = axis_over(without.y, with.y, kHeight - kBottom, kTop);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth, kHeight);
  out += ticks(x, true) + ticks(y, false);
  out += line_of(without, x, y, "stroke=\"#888\" stroke-width=\"1.5\" stroke-dasharray=\"5 3\"");
  out += line_of(with, x, y, "stroke=\"#c33\" stroke-width=\"1.5\"");
  out +=
      fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (kLeft + kWidth - kRight) / 2,
                  kHeight - 8, label(info.plot.x, find_axis_signal(info.plot.x)->unit));
  out += fmt::format("<text x=\"{0}\" y=\"18\">{1}</text>\n", kLeft,
                     label(info.plot.y, find_axis_signal(info.plot.y)->unit));
  out += fmt::format(
      "<text x=\"{}\" y=\"18\" text-anchor=\"end\"><tspan fill=\"#c33\">with {}</tspan>, dashed: "
      "without</text>\n</svg>\n",
      kWidth - kRight, info.id);
  return out;
}

}  // namespace omnihil
