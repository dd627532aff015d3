#include "hil/field_play/path_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "hil/text/markup.h"
#include "sim/robot/plant.h"

namespace omnihil {
namespace {

constexpr double kStart_s = 0.1;     // of frames that say where it stands
constexpr double kCorner_rad = 0.7;  // 40 degrees of another way is another leg
constexpr double kLeg_m = 0.05;      // of way, over which its direction is taken

double turn(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

std::vector<PathPoint> frames_of(const Run& run) {
  const auto *x = run.signal("vision_x"), *y = run.signal("vision_y"), *theta = run.signal("vision_theta");
  std::vector<PathPoint> frames;
  for (std::size_t k = 0; k < run.time_s.size(); ++k)
    if (std::isfinite((*x)[k] + (*y)[k] + (*theta)[k]))
      frames.push_back({run.time_s[k], (*x)[k], (*y)[k], (*theta)[k]});
  return frames;
}

// Pieces of the real way between corners: direction over kLeg_m before and after.
std::vector<PathLeg> legs_of(const PathTest& t) {
  std::vector<PathLeg> legs;
  const std::vector<PathPoint>& p = t.real;
  std::vector<double> way(p.size(), 0.0);
  for (std::size_t k = 1; k < p.size(); ++k)
    way[k] = way[k - 1] + std::hypot(p[k].x_m - p[k - 1].x_m, p[k].y_m - p[k - 1].y_m);
  std::size_t from = 0;
  const auto close = [&](std::size_t to) {
    PathLeg leg{p[from].time_s, p[to].time_s, way[to] - way[from], 0.0};
    double sum2 = 0.0;
    for (std::size_t k = from; k <= to; ++k)
      sum2 += std::pow(p[k].x_m - t.model[k].x_m, 2) + std::pow(p[k].y_m - t.model[k].y_m, 2);
    leg.rms_m = std::sqrt(sum2 / static_cast<double>(to - from + 1));
    if (leg.length_m > 2.0 * kLeg_m) legs.push_back(leg);
    from = to;
  };
  for (std::size_t k = 0; k < p.size(); ++k) {
    const auto before = std::ranges::lower_bound(way, way[k] - kLeg_m) - way.begin();
    const auto after = std::ranges::lower_bound(way, way[k] + kLeg_m) - way.begin();
    if (after >= std::ssize(way) || way[k] - way[from] < kLeg_m) continue;
    const auto &a = p[static_cast<std::size_t>(before)], &c = p[static_cast<std::size_t>(after)];
    const double in = std::atan2(p[k].y_m - a.y_m, p[k].x_m - a.x_m),
                 out = std::atan2(c.y_m - p[k].y_m, c.x_m - p[k].x_m);
    if (std::abs(turn(out - in)) > kCorner_rad) close(k);
  }
  if (!p.empty()) close(p.size() - 1);
  return legs;
}

}  // namespace

PathTest path_test(const Run& run, const RobotModel& model, std::vector<std::string>& faults) {
  PathTest t;
  if (model.wheels != kWheels)
    faults.push_back(fmt::format("model \"{}\": the test of the path is of robots with four wheels, not {}",
                                 model.name, model.wheels));
  if (!faults.empty()) return t;
  std::array<const std::vector<double>*, kWheels> duty{};
  for (std::size_t i = 0; i < kWheels; ++i) {
    duty[i] = run.signal("duty_" + std::to_string(i + 1));
    if (duty[i] == nullptr) faults.push_back(fmt::format("{}: needs duty_1 to duty_4", run.file));
    if (duty[i] == nullptr) break;
  }
  if (run.signal("vision_x") == nullptr || run.signal("vision_y") == nullptr ||
      run.signal("vision_theta") == nullptr)
    faults.push_back(
        fmt::format("{}: needs vision_x, vision_y, vision_theta: where the real one was", run.file));
  if (!faults.empty()) return t;
  t.real = frames_of(run);
  if (t.real.size() < 10) {
    faults.push_back(fmt::format("{}: {} frames of the camera; needed: 10", run.file, t.real.size()));
    return t;
  }
  PathPoint start = t.real.front();
  double count = 0.0, x = 0.0, y = 0.0, yaw = 0.0;
  for (const PathPoint& p : t.real) {
    if (p.time_s - start.time_s > kStart_s) break;
    x += p.x_m, y += p.y_m, yaw += start.yaw_rad + turn(p.yaw_rad - start.yaw_rad);
    ++count;
  }
  PlantOptions options;
  options.physics = Physics::kPlanar;
  Plant plant(std::vector{model}, options);
  plant.set_pose(0, x / count, y / count, yaw / count);
  std::size_t frame = 0;
  RobotDrive drive{};
  double now_s = run.time_s.front();
  const double step_s = 1e-9 * static_cast<double>(options.mechanical_step_ns);
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    // Held from its sample to the next, in whole steps of the plant.
    while (now_s + 0.5 * step_s < run.time_s[k]) {
      plant.advance(options.mechanical_step_ns);
      now_s += step_s;
    }
    while (frame < t.real.size() && t.real[frame].time_s <= run.time_s[k]) {
      const PlanarState s = plant.planar_state(0);
      t.model.push_back({t.real[frame].time_s, s.x_m, s.y_m, s.yaw_rad});
      ++frame;
    }
    for (std::size_t i = 0; i < kWheels; ++i) {
      const double asked = (*duty[i])[k];
      drive.mode[i] = std::isfinite(asked) ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
      drive.duty_ratio[i] = std::isfinite(asked) ? std::clamp(asked, -1.0, 1.0) : 0.0;
    }
    plant.write(0, drive);
  }
  double sum2 = 0.0, turn2 = 0.0;
  for (std::size_t k = 0; k < t.real.size(); ++k) {
    const double off = std::hypot(t.real[k].x_m - t.model[k].x_m, t.real[k].y_m - t.model[k].y_m);
    const double angle = turn(t.model[k].yaw_rad - t.real[k].yaw_rad);
    sum2 += off * off;
    turn2 += angle * angle;
    t.most_m = std::max(t.most_m, off);
    t.end_m = off;
    t.end_rad = angle;
    if (k > 0) t.way_m += std::hypot(t.real[k].x_m - t.real[k - 1].x_m, t.real[k].y_m - t.real[k - 1].y_m);
  }
  t.rms_m = std::sqrt(sum2 / static_cast<double>(t.real.size()));
  t.rms_rad = std::sqrt(turn2 / static_cast<double>(t.real.size()));
  t.legs = legs_of(t);
  return t;
}

std::string path_picture(const PathTest& t, const std::string& title, const std::string& real,
                         const std::string& model) {
  double x_from = t.real.front().x_m, x_to = x_from, y_from = t.real.front().y_m, y_to = y_from;
  for (const auto* path : {&t.real, &t.model})
    for (const PathPoint& p : *path) {
      x_from = std::min(x_from, p.x_m), x_to = std::max(x_to, p.x_m);
      y_from = std::min(y_from, p.y_m), y_to = std::max(y_to, p.y_m);
    }
  constexpr double kSize_px = 640, kMargin_px = 50;
  const double scale = kSize_px / std::max({x_to - x_from, y_to - y_from, 0.1});
  const double width = (x_to - x_from) * scale + 2 * kMargin_px,
               height = (y_to - y_from) * scale + 2 * kMargin_px;
  std::string svg;
  const auto out = std::back_inserter(svg);
  fmt::format_to(
      out,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#fff\"/>\n<text x=\"10\" y=\"20\" font-size=\"15\">{2}</text>\n<text x=\"10\" y=\"38\"><tspan "
      "fill=\"#1f6feb\">{6}</tspan> <tspan fill=\"#d33\">{7}</tspan>, {3:.1f} m of way: {4:.3f} m rms, "
      "{5:.3f} m at the end</text>\n",
      width, height, escaped(title), t.way_m, t.rms_m, t.end_m, escaped(real), escaped(model));
  const auto draw = [&](const std::vector<PathPoint>& path, const char* colour) {
    fmt::format_to(out, "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" points=\"", colour);
    for (const PathPoint& p : path)
      fmt::format_to(out, "{:.1f},{:.1f} ", kMargin_px + (p.x_m - x_from) * scale,
                     kMargin_px + (y_to - p.y_m) * scale);
    fmt::format_to(out, "\"/>\n");
  };
  draw(t.real, "#1f6feb");
  draw(t.model, "#d33");
  fmt::format_to(out,
                 "<path d=\"M{0} {1:.0f} h{2:.1f}\" stroke=\"#000\"/><text x=\"{0}\" y=\"{3:.0f}\">0.1 "
                 "m</text>\n</svg>\n",
                 kMargin_px, height - 14, 0.1 * scale, height - 18);
  return svg;
}

}  // namespace omnihil
