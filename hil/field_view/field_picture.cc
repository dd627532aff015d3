#include "hil/field_view/field_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "hil/text/markup.h"

namespace omnihil {
namespace {

constexpr double kMargin_m = 0.35;     // around what is shown
constexpr double kAir_m = 0.03;        // a ball's middle above that is in the air
constexpr double kFastest_m_s = 20.0;  // beyond any kick: the ball was put somewhere
constexpr double kNearest_px = 1.5;    // of two points of a way: less is not seen
constexpr double kTitle_px = 26.0;
constexpr const char* kBlue = "#1f6feb";
constexpr const char* kYellow = "#d4a800";
constexpr const char* kBall = "#f26b21";

struct View {
  double x_from_m = 0, x_to_m = 0, y_from_m = 0, y_to_m = 0, scale = 1.0;
  double x(double x_m) const { return (x_m - x_from_m) * scale; }
  double y(double y_m) const { return kTitle_px + (y_to_m - y_m) * scale; }
  double width() const { return (x_to_m - x_from_m) * scale; }
  double height() const { return kTitle_px + (y_to_m - y_from_m) * scale; }
};

View view_of(const FieldTrace& trace, double width_px) {
  View v;
  if (const FieldSize* const size = trace.size()) {
    v.x_to_m = size->half_length_m() + size->boundary_mm / 1000.0;
    v.y_to_m = size->half_width_m() + size->boundary_mm / 1000.0;
    v.x_from_m = -v.x_to_m;
    v.y_from_m = -v.y_to_m;
  } else {
    bool first = true;
    const auto hold = [&](const FieldPoint& p) {
      v.x_from_m = first ? p.x_m : std::min(v.x_from_m, p.x_m);
      v.x_to_m = first ? p.x_m : std::max(v.x_to_m, p.x_m);
      v.y_from_m = first ? p.y_m : std::min(v.y_from_m, p.y_m);
      v.y_to_m = first ? p.y_m : std::max(v.y_to_m, p.y_m);
      first = false;
    };
    for (const auto& [key, robot] : trace.robots()) std::ranges::for_each(robot.points, hold);
    std::ranges::for_each(trace.ball(), hold);
  }
  v.x_from_m -= kMargin_m;
  v.x_to_m += kMargin_m;
  v.y_from_m -= kMargin_m;
  v.y_to_m += kMargin_m;
  v.scale = width_px / (v.x_to_m - v.x_from_m);
  return v;
}

using Out = std::back_insert_iterator<std::string>;

void box(Out out, const View& v, double x_from_m, double x_to_m, double y_from_m, double y_to_m,
         const char* style) {
  fmt::format_to(out, "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n",
                 v.x(x_from_m), v.y(y_to_m), (x_to_m - x_from_m) * v.scale, (y_to_m - y_from_m) * v.scale,
                 style);
}

void draw_field(Out out, const View& v, const FieldSize& size) {
  const double x = size.half_length_m(), y = size.half_width_m(), b = size.boundary_mm / 1000.0;
  constexpr const char* kLine = "fill=\"none\" stroke=\"#ffffff\" stroke-width=\"1.5\"";
  box(out, v, -x - b, x + b, -y - b, y + b, "fill=\"#3f7f4f\" stroke=\"#303030\" stroke-width=\"3\"");
  box(out, v, -x, x, -y, y, kLine);
  const double depth = size.penalty_depth_mm / 1000.0, half = size.penalty_width_mm / 2000.0;
  box(out, v, -x, -x + depth, -half, half, kLine);
  box(out, v, x - depth, x, -half, half, kLine);
  fmt::format_to(out,
                 "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#ffffff\"/>\n",
                 v.x(0), v.y(-y), v.y(y));
  fmt::format_to(out, "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", v.x(0), v.y(0),
                 0.5 * v.scale, kLine);
  for (const Board& board : goal_boards(size))
    box(out, v, board.x_from_m, board.x_to_m, board.y_from_m, board.y_to_m, "fill=\"#202020\"");
}

void draw_way(Out out, const View& v, const std::vector<FieldPoint>& points, std::size_t from, std::size_t to,
              const std::string& style) {
  if (to - from < 2) return;
  fmt::format_to(out, "<polyline fill=\"none\" {} points=\"", style);
  double drawn_x = 0.0, drawn_y = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    const double x = v.x(points[i].x_m), y = v.y(points[i].y_m);
    const bool end = i == from || i + 1 == to;
    if (!end && std::hypot(x - drawn_x, y - drawn_y) < kNearest_px) continue;
    fmt::format_to(out, "{:.1f},{:.1f} ", x, y);
    drawn_x = x;
    drawn_y = y;
  }
  fmt::format_to(out, "\"/>\n");
}

// Circle with its flat front.
void draw_robot(Out out, const View& v, const RobotOutline& o, const FieldPoint& at,
                const std::string& style) {
  const double open = std::acos(o.front_m / o.radius_m);
  const auto corner = [&](double angle) {
    return std::pair(v.x(at.x_m + o.radius_m * std::cos(at.yaw_rad + angle)),
                     v.y(at.y_m + o.radius_m * std::sin(at.yaw_rad + angle)));
  };
  const auto [x1, y1] = corner(open);
  const auto [x2, y2] = corner(2.0 * std::numbers::pi - open);
  const double r = o.radius_m * v.scale;
  fmt::format_to(out, "<path d=\"M{:.1f} {:.1f} A{:.1f} {:.1f} 0 1 0 {:.1f} {:.1f} Z\" {}/>\n", x1, y1, r, r,
                 x2, y2, style);
}

bool put_elsewhere(const FieldPoint& a, const FieldPoint& b) {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) > kFastest_m_s * (b.time_s - a.time_s) + 1e-3;
}

void draw_ball(Out out, const View& v, const std::vector<FieldPoint>& ball) {
  for (std::size_t from = 0; from + 1 < ball.size();) {
    if (put_elsewhere(ball[from], ball[from + 1])) {
      ++from;
      continue;
    }
    const bool flies = ball[from + 1].yaw_rad > kAir_m;
    std::size_t to = from + 1;
    while (to + 1 < ball.size() && (ball[to + 1].yaw_rad > kAir_m) == flies &&
           !put_elsewhere(ball[to], ball[to + 1]))
      ++to;
    draw_way(
        out, v, ball, from, to + 1,
        fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", kBall, flies ? " stroke-dasharray=\"2 4\"" : ""));
    from = to;
  }
  if (ball.empty()) return;
  const FieldPoint& end = ball.back();
  fmt::format_to(out, "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\" stroke=\"#000\"/>\n",
                 v.x(end.x_m), v.y(end.y_m), std::max(3.0, 0.0215 * v.scale), kBall);
}

void draw_event(Out out, const View& v, const WorldEvent& e) {
  const double x = v.x(e.x_m), y = v.y(e.y_m), time_s = static_cast<double>(e.now_ns) * 1e-9;
  switch (e.kind) {
    case WorldEventKind::kKick:
      fmt::format_to(out,
                     "<g><title>kick {:.1f} m/s at {:.2f} s</title><path d=\"M{:.1f} {:.1f} l-5 9 h10 z\" "
                     "fill=\"#fff\" stroke=\"#000\"/></g>\n",
                     e.size, time_s, x, y - 4.0);
      return;
    case WorldEventKind::kGoal:
      fmt::format_to(
          out,
          "<g><title>goal at {:.2f} s</title><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\" fill=\"none\" "
          "stroke=\"#fff\" stroke-width=\"3\"/></g>\n",
          time_s, x, y);
      return;
    case WorldEventKind::kRobotsTouch:
    case WorldEventKind::kBallTouch:
      fmt::format_to(out,
                     "<g><title>{} at {:.2f} s</title><path d=\"M{:.1f} {:.1f} l6 6 m0 -6 l-6 6\" "
                     "stroke=\"#000\" fill=\"none\"/></g>\n",
                     e.kind == WorldEventKind::kBallTouch ? "ball meets a robot" : "robots meet", time_s,
                     x - 3.0, y - 3.0);
      return;
    case WorldEventKind::kTip:
      fmt::format_to(out,
                     "<g><title>tips over at {:.2f} s</title><path d=\"M{:.1f} {:.1f} l9 4 l-9 4 z\" "
                     "fill=\"#d00\" stroke=\"#000\"/></g>\n",
                     time_s, x, y - 4.0);
      return;
  }
}

}  // namespace

std::string field_picture(const FieldTrace& trace, const FieldPictureOptions& options) {
  const View v = view_of(trace, options.width_px);
  std::string svg;
  const Out out(svg);
  fmt::format_to(
      out,
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#ffffff\"/>\n<text x=\"8\" y=\"18\" font-size=\"15\">{2}</text>\n",
      v.width(), v.height(), escaped(options.title));
  if (trace.size() != nullptr) draw_field(out, v, *trace.size());
  for (const auto& [key, robot] : trace.robots()) {
    if (robot.points.empty()) continue;
    const bool blue = (trace.team() == Team::kBlue) != robot.opponent;
    const char* const colour = blue ? kBlue : kYellow;
    draw_way(out, v, robot.points, 0, robot.points.size(),
             fmt::format("stroke=\"{}\" stroke-width=\"1.5\" stroke-opacity=\"0.8\"", colour));
    draw_robot(out, v, robot.outline, robot.points.front(),
               fmt::format("fill=\"none\" stroke=\"{}\"", colour));
    draw_robot(out, v, robot.outline, robot.points.back(),
               fmt::format("fill=\"{}\" stroke=\"#000\"", colour));
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#fff\" text-anchor=\"middle\">{}</text>\n",
                   v.x(robot.points.back().x_m), v.y(robot.points.back().y_m) + 4.0, robot.id);
  }
  for (const FieldPoint& real : trace.movers())
    draw_robot(out, v, RobotOutline{}, real, "fill=\"#888\" fill-opacity=\"0.15\"");
  draw_ball(out, v, trace.ball());
  for (const WorldEvent& event : trace.events()) draw_event(out, v, event);
  svg += "</svg>\n";
  return svg;
}

}  // namespace omnihil
