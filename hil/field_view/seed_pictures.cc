#include "hil/field_view/seed_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "hil/league/real_field.h"
#include "hil/league/vision.h"
#include "hil/loop/air_loss.h"
#include "hil/text/line_chart.h"
#include "sim/field/chip_kick.h"
#include "sim/field/dribbler.h"
#include "sim/field/kicker.h"
#include "sim/field/world.h"

namespace omnihil {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kMillisecond_ns = 1'000'000;

World world_of(const RobotModel& model, int robots, const FieldSize* field = nullptr) {
  PlantOptions plant;
  plant.physics = Physics::kPlanar;
  WorldOptions options;
  options.field = field;
  return World(std::vector<RobotModel>(static_cast<std::size_t>(robots), model), plant, options);
}

SeedPicture picture(std::string name, std::string title, std::string x_label, std::vector<double> x,
                    std::vector<ChartPanel> panels) {
  const LineChart chart{.title = std::move(title),
                        .x = std::move(x),
                        .x_label = std::move(x_label),
                        .panels = std::move(panels),
                        .shade = {},
                        .mark = {}};
  return {std::move(name), line_chart(chart)};
}

SeedPicture ball_picture() {
  const BallParams params;
  const Carpet carpet;
  BallState flat = resting_ball(params, 0, 0), back = flat;
  flat.velocity = {5.0, 0.0, 0.0};
  back.on_floor = false;
  back.velocity = {2.0, 0.0, 3.0};
  back.spin = {0.0, -250.0, 0.0};  // about -y: its underside runs ahead of it
  std::vector<double> time_s, speed, slip, height, along;
  for (int ms = 0; ms < 3000; ++ms) {
    if (ms % 4 == 0) {
      time_s.push_back(1e-3 * ms);
      speed.push_back(flat.velocity.norm());
      slip.push_back(floor_slip(params, flat).norm());
      height.push_back(back.position.z() - params.radius_m);
      along.push_back(back.velocity.x());
    }
    advance_ball(params, carpet, flat, 1e-3);
    advance_ball(params, carpet, back, 1e-3);
  }
  return picture("ball", "kicked flat at 5 m/s; chipped with 250 rad/s of backspin", "time in s", time_s,
                 {{"m/s", {{"speed, kicked flat", speed}, {"slip of its lowest point", slip}}},
                  {"m", {{"height, chipped", height}}},
                  {"m/s", {{"speed along, chipped", along}}}});
}

SeedPicture contacts_picture(const RobotModel& model) {
  World world = world_of(model, 10, &kFieldSeedPaper);
  for (int n = 0; n < 10; ++n) {
    const double turn = 2.0 * std::numbers::pi * n / 10.0;
    world.put_robot(n, 0.9 * std::cos(turn), 0.9 * std::sin(turn), turn + std::numbers::pi);
    world.set_velocity(n, -2.0 * std::cos(turn), -2.0 * std::sin(turn), 0.0);
  }
  world.put_ball(0.05, 0.02, 0.0, {0, 0, 0});
  std::vector<double> time_s, energy_J, touches;
  double count = 0.0;
  for (int ms = 0; ms < 1000; ms += 2) {
    time_s.push_back(1e-3 * ms);
    energy_J.push_back(world.energy_J());
    touches.push_back(count);
    world.advance(2 * kMillisecond_ns);
    for (const WorldEvent& e : world.events())
      count += e.kind == WorldEventKind::kRobotsTouch || e.kind == WorldEventKind::kBallTouch;
  }
  return picture(
      "contacts", "ten robots at 2 m/s meet in the middle, a ball among them", "time in s", time_s,
      {{"J", {{"kinetic energy of bodies and ball", energy_J}}}, {"", {{"contacts so far", touches}}}});
}

SeedPicture kicker_picture() {
  std::vector<double> k, full, half, fitted_out;
  for (int tenth = 0; tenth <= 300; ++tenth) {
    const double power = 0.1 * tenth;
    k.push_back(power);
    full.push_back(kick_speed_m_s(kSeedKick, 1e-3 * power, 1.0));
    half.push_back(kick_speed_m_s(kSeedKick, 1e-3 * power, 0.5));
    fitted_out.push_back(-0.0001 * power * power * power + 0.0213 * power * power - 0.0315 * power - 0.0098);
  }
  return picture(
      "kicker", "direct kick, eq. (1): its range, and a capacitor at half its voltage", "k", k,
      {{"m/s",
        {{"full capacitor", full}, {"half the voltage", half}, {"the polynomial alone", fitted_out}}}});
}

SeedPicture chip_picture(const RobotModel& model) {
  std::vector<double> k, far_middle, far_edge, apex;
  for (int twentieth = 0; twentieth <= 160; ++twentieth) {
    const double power = 0.05 * twentieth;
    const ChipKick middle = chip_kick(handling_of(model).chip, power, 0.0),
                   edge = chip_kick(handling_of(model).chip, power, 0.025);
    k.push_back(power);
    far_middle.push_back(chip_distance_m(middle, 0.0));
    far_edge.push_back(chip_distance_m(edge, 0.0));
    apex.push_back(chip_apex_m(middle));
  }
  return picture(
      "chip", "chip kick by the trained network: where the ball lands", "k", k,
      {{"m", {{"ball in the middle", far_middle}, {"25 mm to the side", far_edge}, {"how high", apex}}}});
}

// A robot that holds the ball is braked at a constant rate; distance of the ball's edge from the front.
std::vector<double> braked(const RobotModel& model, double braking_m_s2, std::vector<double>& time_s,
                           std::vector<double>& current_A) {
  const BallHandling& h = handling_of(model);
  World world = world_of(model, 1);
  const double radius_m = world.options().ball.radius_m;
  world.put_ball(h.dribbler.bar_x_m + radius_m + 1e-3, 0.0, 0.0, {0, 0, 0});
  RobotDrive drive{};
  drive.dribbler_ratio = 1.0;
  world.write(0, drive);
  world.advance(1'000 * kMillisecond_ns);
  std::vector<double> gap_mm;
  time_s.clear();
  current_A.clear();
  double speed_m_s = 0.0;
  for (int ms = 0; ms < 600; ++ms) {
    if (ms >= 100) {  // backwards, faster and faster: to the ball the same as braking
      speed_m_s -= 1e-3 * braking_m_s2;
      world.set_velocity(0, speed_m_s, 0.0, 0.0);
    }
    world.advance(kMillisecond_ns);
    time_s.push_back(1e-3 * ms);
    current_A.push_back(world.handling(0).dribbler_current_A);
    const double away_m = world.ball()->position.x() - world.plant().planar_state(0).x_m;
    gap_mm.push_back(std::min(60.0, 1e3 * (away_m - radius_m - h.outline.front_m)));
  }
  return gap_mm;
}

SeedPicture dribbler_picture(const RobotModel& model) {
  const BallHandling& h = handling_of(model);
  const double most = held_acceleration_m_s2(h.dribbler, h.outline.front_m, BallParams{}.radius_m,
                                             BallParams{}.mass_kg, Carpet{}.sliding_friction);
  std::vector<double> time_s, less_A, more_A;
  const std::vector<double> less = braked(model, 0.9 * most, time_s, less_A),
                            more = braked(model, 1.15 * most, time_s, more_A);
  return picture("dribbler", fmt::format("dribbling backwards: held up to {:.1f} m/s2", most), "time in s",
                 time_s,
                 {{"mm", {{"ball from the front, at 0.9 of it", less}, {"at 1.15 of it", more}}},
                  {"A", {{"motor, at 0.9 of it", less_A}, {"at 1.15 of it", more_A}}}});
}

SeedPicture beam_picture(const RobotModel& model) {
  World world = world_of(model, 1);
  const BallHandling& h = handling_of(model);
  const double radius_m = world.options().ball.radius_m;
  world.put_ball(0.13, 0.0, 0.0, {-1.0, 0, 0});
  std::vector<double> time_s, beyond_mm, seen;
  for (int step = 0; step < 150; ++step) {
    world.advance(kMillisecond_ns / 2);
    time_s.push_back(5e-4 * (step + 1));
    const double edge_m = world.ball()->position.x() - world.plant().planar_state(0).x_m - radius_m;
    beyond_mm.push_back(1e3 * (edge_m - h.outline.front_m - h.beam.forward_m));
    seen.push_back(world.handling(0).ball_seen ? 1.0 : 0.0);
  }
  return picture("break_beam", "a ball at 1 m/s comes to the beam", "time in s", time_s,
                 {{"mm", {{"from the ray to the ball's edge", beyond_mm}}}, {"", {{"ball_seen", seen}}}});
}

SeedPicture wireless_picture() {
  constexpr int kPackets = 20'000;
  std::vector<double> away_m, mean, above, below, counted;
  for (int n = 0; n <= 60; ++n) {
    const double d = std::max(0.1, 0.2 * n);
    away_m.push_back(d);
    mean.push_back(100.0 * distance_loss_mean(d));
    above.push_back(100.0 * (distance_loss_mean(d) + distance_loss_sigma(d)));
    below.push_back(100.0 * std::max(0.0, distance_loss_mean(d) - distance_loss_sigma(d)));
    AirLoss air({.by_distance = true}, static_cast<std::uint64_t>(n), [=](int) { return std::pair(d, 0.0); });
    for (int p = 0; p < kPackets; ++p) air.lost(0, AirWay::kToRobot);
    counted.push_back(100.0 * static_cast<double>(air.counts().to_robot) / kPackets);
  }
  return picture("wireless", fmt::format("packets lost by distance: eqs. (2), (3), and of {} each", kPackets),
                 "distance in m", away_m,
                 {{"%",
                   {{"mean, eq. (2)", mean},
                    {"one sigma above, eq. (3)", above},
                    {"below", below},
                    {"counted", counted}}}});
}

// What an AI host knows of a robot that drives in a circle: the last frame that has arrived.
SeedPicture vision_picture(const RobotModel& model) {
  VisionOptions options;
  options.field = kFieldSeedPaper;
  options.cameras = 2;
  options.delay_least_s = 0.006;
  options.delay_most_s = 0.024;
  options.digit_mm = 2.0;
  options.position_sigma_m = 0.002;
  options.seed = 1;
  Vision vision(options);
  std::vector<LeagueRobot> robots(1);
  robots[0].model = &model;
  std::vector<double> time_s, true_mm, told_mm;
  double last_mm = kNaN;
  for (std::int64_t now_ns = 0; now_ns < 400 * kMillisecond_ns; now_ns += kMillisecond_ns) {
    const double t = 1e-9 * static_cast<double>(now_ns), x_m = 0.3 * std::sin(5.0 * t);
    robots[0].sample.vision = {x_m, 0.5, 0.0};
    vision.capture(now_ns, robots, nullptr);
    while (const auto packet = vision.due(now_ns)) {
      RealField one({});  // a frame by itself: no track, no prediction
      if (one.packet(*packet, now_ns) && !one.movers(now_ns).empty())
        last_mm = 1e3 * one.movers(now_ns)[0].state.x_m;
    }
    time_s.push_back(t);
    true_mm.push_back(1e3 * x_m);
    told_mm.push_back(last_mm);
  }
  return picture("vision", "a robot to and fro at up to 1.5 m/s, and what has arrived of it", "time in s",
                 time_s, {{"mm", {{"where it is", true_mm}, {"what vision last said", told_mm}}}});
}

SeedPicture mixed_picture(const RobotModel& model) {
  World world = world_of(model, 1, &kFieldSeedPaper);
  Mover real;
  real.state.x_m = -0.6;
  real.state.v_x_m_s = 0.5;
  world.set_movers(std::vector{real});
  std::vector<double> time_s, real_m, virtual_m, speed;
  for (int ms = 0; ms < 2000; ms += 4) {
    time_s.push_back(1e-3 * ms);
    real_m.push_back(world.movers()[0].state.x_m);
    virtual_m.push_back(world.plant().planar_state(0).x_m);
    speed.push_back(world.plant().planar_state(0).v_x_m_s);
    world.advance(4 * kMillisecond_ns);
  }
  return picture("mixed",
                 "a real robot at 0.5 m/s, as vision tells it, meets a virtual one with its motors off",
                 "time in s", time_s,
                 {{"m", {{"the real one's centre", real_m}, {"the virtual one's", virtual_m}}},
                  {"m/s", {{"speed of the virtual one", speed}}}});
}

}  // namespace

std::vector<SeedPicture> seed_pictures(const RobotModel& model) {
  return {ball_picture(),      contacts_picture(model), kicker_picture(),
          chip_picture(model), dribbler_picture(model), beam_picture(model),
          wireless_picture(),  vision_picture(model),   mixed_picture(model)};
}

}  // namespace omnihil
