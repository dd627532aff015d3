#include "hil/field_view/seed_tour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/field_play/pass_and_shoot.h"
#include "hil/league/vision.h"
#include "hil/loop/air_loss.h"
#include "identify/tyre/tyre_curve_fit.h"
#include "sim/field/chip_kick.h"
#include "sim/field/dribbler.h"
#include "sim/field/kicker.h"
#include "sim/field/world.h"
#include "sim/full_wheel/wheel_comparison.h"

namespace omnihil {
namespace {

World world_of(const RobotModel& model, int robots, const FieldSize* field = nullptr) {
  PlantOptions plant;
  plant.physics = Physics::kPlanar;
  WorldOptions options;
  options.field = field;
  return World(std::vector<RobotModel>(static_cast<std::size_t>(robots), model), plant, options);
}

TourRow robot_row(const RobotModel& model) {
  const RobotOutline& hull = handling_of(model).outline;
  return {
      "robot", "cylinder of 9 cm radius, 15 cm high; four motors of 96 mNm at the wheel",
      fmt::format("{}: hull {:.0f} mm, flat front at {:.1f} mm, {:.0f} mm high; {:.0f} mNm at the wheel "
                  "({:.0f} A limit, gear {:g})",
                  model.name, 1e3 * hull.radius_m, 1e3 * hull.front_m, 1e3 * hull.height_m,
                  1e3 * model.motor.current_limit_A * model.motor.torque_constant_Nm_per_A * model.gear_ratio,
                  model.motor.current_limit_A, model.gear_ratio)};
}

TourRow ball_row() {
  const BallParams params;
  const Carpet carpet;
  BallState ball = resting_ball(params, 0, 0);
  ball.velocity = {5.0, 0.0, 0.0};
  double rolls_s = 0.0, rolls_m_s = 0.0, time_s = 0.0;
  while (ball.velocity.norm() > 0.0 && time_s < 60.0) {
    advance_ball(params, carpet, ball, 1e-3);
    time_s += 1e-3;
    if (rolls_s == 0.0 && floor_slip(params, ball).norm() < 1e-6) {
      rolls_s = time_s;
      rolls_m_s = ball.velocity.norm();
    }
  }
  return {"field and ball", "6.05 m x 4.05 m, golf ball",
          fmt::format(
              "kicked flat at 5 m/s it slides for {:.2f} s, rolls from {:.2f} m/s, stops after {:.1f} m and "
              "{:.1f} s",
              rolls_s, rolls_m_s, ball.position.x(), time_s)};
}

TourRow robots_row(const RobotModel& model) {
  World world = world_of(model, 10, &kFieldSeedPaper);
  for (int n = 0; n < 10; ++n) {
    const double turn = 2.0 * M_PI * n / 10.0;
    world.put_robot(n, 0.9 * std::cos(turn), 0.9 * std::sin(turn), turn + M_PI);
    world.set_velocity(n, -2.0 * std::cos(turn), -2.0 * std::sin(turn), 0.0);
  }
  world.put_ball(0.05, 0.02, 0.0, {0, 0, 0});
  const double before_J = world.energy_J();
  int touches = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events())
      touches += e.kind == WorldEventKind::kRobotsTouch || e.kind == WorldEventKind::kBallTouch;
  }
  return {"ten robots and the ball", "rigid bodies by a physics engine",
          fmt::format("ten meet in the middle at 2 m/s: {} contacts, {:.1f} J before, {:.3f} J after 2 s",
                      touches, before_J, world.energy_J())};
}

TourRow kick_row() {
  return {"direct kick", "eq. (1), 10 m/s",
          fmt::format("V(k = 12) = {:.2f} m/s, V(24) = {:.2f} m/s; no kick below k = {:g}, k = {:g} at most",
                      kick_speed_m_s(kSeedKick, 0.012, 1.0), kick_speed_m_s(kSeedKick, 0.024, 1.0),
                      kSeedKick.k_least, kSeedKick.k_most)};
}

TourRow chip_row(const RobotModel& model) {
  const ChipKick kick = chip_kick(handling_of(model).chip, 6.0, 0.0);
  return {"chip kick", "network of 12 and 2 neurons",
          fmt::format("k = 6, ball in the middle: {:.2f} m/s at {:.1f} deg, {:.2f} m high, {:.2f} m far",
                      kick.speed_m_s, kick.angle_rad * 180.0 / M_PI, chip_apex_m(kick),
                      chip_distance_m(kick, 0.0))};
}

TourRow beam_row(const RobotModel& model) {
  World world = world_of(model, 1);
  const BallHandling& h = handling_of(model);
  const double radius_m = world.options().ball.radius_m;
  world.put_ball(0.4, 0.0, 0.0, {-1.0, 0, 0});
  double cut_s = -1.0, seen_s = -1.0;
  for (int step = 0; step < 2000 && seen_s < 0.0; ++step) {
    world.advance(500'000);
    const double now_s = 1e-9 * static_cast<double>(world.now_ns());
    const double x_m = world.ball()->position.x() - world.plant().planar_state(0).x_m;
    if (cut_s < 0.0 && x_m - radius_m < h.outline.front_m + h.beam.forward_m) cut_s = now_s;
    if (world.handling(0).ball_seen) seen_s = now_s;
  }
  return {"break beam", "ray from sender to receiver",
          fmt::format("a ball at 1 m/s is told {:.1f} ms after it cuts the ray", 1e3 * (seen_s - cut_s))};
}

TourRow dribbler_row(const RobotModel& model) {
  const BallHandling& h = handling_of(model);
  const BallParams ball;
  World world = world_of(model, 1);
  world.put_ball(h.dribbler.bar_x_m + 0.0223, 0.0, 0.0, {0, 0, 0});
  RobotDrive drive{};
  drive.dribbler_ratio = 1.0;
  world.write(0, drive);
  world.advance(1'500'000'000);
  const double with_ball_A = world.handling(0).dribbler_current_A;
  world.take_ball_away();
  world.advance(1'500'000'000);
  return {"dribbler", "a roller, friction to be set",
          fmt::format("holds the ball up to {:.1f} m/s2 of braking; {:.2f} A with the ball, {:.2f} A without",
                      held_acceleration_m_s2(h.dribbler, h.outline.front_m, ball.radius_m, ball.mass_kg,
                                             Carpet{}.sliding_friction),
                      with_ball_A, world.handling(0).dribbler_current_A)};
}

// The paper's way on a robot that is pushed evenly, forward and back: force over slip, and a curve through it.
TourRow tyre_row(const RobotModel& model) {
  World world = world_of(model, 1);
  TyrePoints points;
  for (int push = 0; push < 6; ++push) {
    for (int ms = 0; ms < 400; ++ms) {
      RobotDrive drive{};
      const double duty = (push % 2 == 0 ? 1.0 : -1.0) * (0.1 + 0.1 * push) * (1.0 + ms / 100.0);
      for (std::size_t i = 0; i < kWheels; ++i) {
        drive.mode[i] = OMNIHIL_DRIVE_DUTY;
        drive.duty_ratio[i] = std::clamp(-duty * std::sin(model.wheel_angle_rad[i]), -1.0, 1.0);
      }
      world.write(0, drive);
      world.advance(1'000'000);
      const RobotTruth truth = world.plant().truth(0);
      for (std::size_t i = 0; i < kWheels; ++i)
        points.all.push_back({static_cast<int>(i), 1e-9 * static_cast<double>(world.now_ns()),
                              -truth.slip_longitudinal_ratio[i], 1e-4,
                              truth.force_longitudinal_N[i] / std::max(0.1, truth.load_N[i]), 1e-3, 1.0});
    }
  }
  const TyreCurve found = fit_tyre_curve(points.all).curve;
  return {
      "tyre curve", "force over slip, eqs. (5) to (7), Fig. 8",
      fmt::format(
          "six pushes: grip {:.3f} at slip {:.3f}, {:.3f} sliding; the model has {:.3f} at {:.3f}, {:.3f}",
          found.extremum_value, found.extremum_slip, found.asymptote_value,
          model.tyre_longitudinal.extremum_value, model.tyre_longitudinal.extremum_slip,
          model.tyre_longitudinal.asymptote_value)};
}

TourRow wheel_row(const RobotModel& model) {
  for (const WheelManoeuvre& m : wheel_manoeuvres(model)) {
    if (m.name != "diagonal") continue;
    const RollerParams rollers;
    const WheelDifference d = difference_of(run_full_wheel(model, rollers, m, 1e-4),
                                            run_simplified(model, m, Physics::kPlanar, 5e-4));
    return {
        "omni wheel", "two tyre curves instead of 18 side wheels, as accurate and cheaper",
        fmt::format("{:.2f} m diagonally on the same voltages: {:.1f} mm between {} rollers and two curves "
                    "(`field wheel`: more manoeuvres, cost)",
                    d.way_m, 1e3 * d.end_m, 4 * rollers.count)};
  }
  return {"omni wheel", "", "no such manoeuvre"};
}

TourRow wireless_row() {
  // What a robot 8 m away gets, against eqs. (2) and (3).
  constexpr double kAway_m = 8.0;
  constexpr int kPackets = 100'000;
  AirLoss air({.by_distance = true}, 1, [=](int) { return std::pair(kAway_m, 0.0); });
  for (int n = 0; n < kPackets; ++n) air.lost(0, AirWay::kToRobot);
  return {
      "wireless", "eqs. (2), (3): loss by distance",
      fmt::format("{:.2f} % lost at 0.1 m, {:.2f} % at 5 m, {:.2f} % at 8 m; of {} packets to 8 m {:.2f} %",
                  100.0 * distance_loss_mean(0.1), 100.0 * distance_loss_mean(5.0),
                  100.0 * distance_loss_mean(kAway_m), kPackets,
                  100.0 * static_cast<double>(air.counts().to_robot) / kPackets)};
}

TourRow vision_row(const RobotModel& model) {
  VisionOptions options;
  options.field = kFieldSeedPaper;
  options.cameras = 2;
  options.delay_least_s = 0.006;
  options.delay_most_s = 0.024;
  options.digit_mm = 2.0;
  options.seed = 1;
  Vision vision(options);
  std::vector<LeagueRobot> robots(10);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].id = static_cast<int>(i % 5);
    robots[i].team = i < 5 ? Team::kBlue : Team::kYellow;
    robots[i].model = &model;
    robots[i].sample.vision = {0.5 * static_cast<double>(i) - 2.5, 0.0, 0.0};
  }
  const BallState ball = resting_ball(BallParams{}, 0.0, 1.0);
  int packets = 0;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  for (std::int64_t now_ns = 0; now_ns < 10 * kSecond_ns; now_ns += 1'000'000) {
    vision.capture(now_ns, robots, &ball);
    while (vision.due(now_ns)) ++packets;
  }
  return {
      "vision", "SSL-Vision, two cameras, 60 frames a second, 6 to 24 ms late",
      fmt::format("ten robots and a ball from two cameras: {:.0f} packets a second of 6 to 24 ms delay, in "
                  "pixels of {:.0f} mm",
                  packets / 10.0, options.digit_mm)};
}

TourRow pass_row(const RobotModel& model) {
  int goals[2] = {0, 0};
  constexpr int kPlays = 4;
  for (std::uint64_t seed = 1; seed <= kPlays; ++seed) {
    goals[0] += play_pass_and_shoot(model, MotorLoop::kDuty, {.seed = seed}).scored;
    goals[1] += play_pass_and_shoot(model, MotorLoop::kEmotional, {.seed = seed}).scored;
  }
  return {"pass and shoot", "two robots, wheels by emotional learning (BELBIC)",
          fmt::format("of {} plays over a lossy radio and a late camera {} goals with PI, {} with BELBIC",
                      kPlays, goals[0], goals[1])};
}

TourRow mixed_row(const RobotModel& model) {
  World world = world_of(model, 1, &kFieldSeedPaper);
  Mover real;
  real.state.x_m = -0.5;
  real.state.v_x_m_s = 0.5;
  world.set_movers(std::vector{real});
  world.advance(2'000'000'000);
  return {"mixed match", "future work: virtual and real robots play together",
          fmt::format("a real robot at 0.5 m/s, as vision tells it, pushes a virtual one {:.2f} m along",
                      world.plant().planar_state(0).x_m)};
}

TourRow goal_row(const RobotModel& model) {
  World world = world_of(model, 1, &kFieldSeedPaper);
  world.put_robot(0, 1.5, 0.0, 0.0);
  world.put_ball(1.5 + handling_of(model).outline.front_m + 0.03, 0.0, 0.0, {0, 0, 0});
  RobotDrive drive{};
  drive.charge = 1;
  world.write(0, drive);
  world.advance(3'000'000'000);
  drive = {};
  drive.kick = OMNIHIL_KICK_STRAIGHT;
  drive.kick_pulse_s = 5e-3;
  world.write(0, drive);
  double kick_m_s = 0.0, recoil_m_s = 0.0;
  for (int ms = 1; ms < 3000; ++ms) {
    world.advance(1'000'000);
    for (const WorldEvent& e : world.events()) {
      if (e.kind == WorldEventKind::kKick) {
        kick_m_s = e.size;
        recoil_m_s = -world.plant().planar_state(0).v_x_m_s;
      }
      if (e.kind == WorldEventKind::kGoal)
        return {"kick and goal", "",
                fmt::format("5 ms pulse: {:.2f} m/s, robot back at {:.2f} m/s, goal after {:.2f} s", kick_m_s,
                            recoil_m_s, 1e-3 * ms)};
    }
  }
  return {"kick and goal", "", "no goal"};
}

}  // namespace

std::string TourRow::text() const {
  return fmt::format("{:<24}{}\n{:<24}{}\n", system, here, "", paper.empty() ? "" : "paper: " + paper);
}

std::vector<TourRow> seed_tour(const RobotModel& model) {
  return {robot_row(model),  wheel_row(model), tyre_row(model), ball_row(),          robots_row(model),
          kick_row(),        chip_row(model),  beam_row(model), dribbler_row(model), wireless_row(),
          vision_row(model), pass_row(model),  goal_row(model), mixed_row(model)};
}

}  // namespace omnihil
