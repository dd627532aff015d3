// What a robot has for the ball: hull, kicker with its capacitor, chip kicker, dribbler, break beam. Plain numbers.
//
//   BallHandling h = handling_of(model);             // the defaults where a model says nothing
//   h.kick = kSeedKick;                              // the seed paper's eq. (1)
//
// Laws over these numbers: sim/field/{kicker,chip_kick,dribbler,break_beam}.h. Frame: body, x forward.
// A bar at axis (x, z) touches a ball of radius R on the floor that stands against the front at an angle
// asin((z - R) / (r_bar + R)) above the ball's middle; numbers of a bar that is used are checked by dribbler.h.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sim/contact/ball.h"
#include "sim/contact/convex_shape.h"

namespace omnihil {

struct RobotModel;

// v = (V / V_full) (c0 + c1 k + c2 k^2 + c3 k^3),  k = pulse / unit, k_least <= k <= k_most.
struct KickLaw {
  double pulse_unit_s = 1e-3;
  std::array<double, 4> c{0.0, 1.0, 0.0,
                          0.0};  // guess, +-50 %: 1 m/s per ms, as the reference firmware reckons
  double k_least = 0.0, k_most = 10.0;
};

struct KickCapacitor {
  double capacitance_F = 2.2e-3;
  double full_V = 200.0;         // of the league's kickers
  double charge_power_W = 60.0;  // out of the bus; guess, +-50 %
  double charge_efficiency = 0.8;
  double kick_efficiency = 0.15;  // of the capacitor's energy in the ball: guess, +-50 %
};

// Two layers: 12 neurons (tanh), 2 neurons (linear). In: power k and the ball's place on the front, both scaled to
// -1 … 1; out: speed and angle, likewise.
inline constexpr std::size_t kChipHidden = 12;
struct ChipNetwork {
  std::array<std::array<double, 2>, kChipHidden> w1{};
  std::array<double, kChipHidden> b1{};
  std::array<std::array<double, kChipHidden>, 2> w2{};
  std::array<double, 2> b2{};
  std::array<double, 2> in_least{0, -0.03}, in_most{10, 0.03};  // k, y in m
  std::array<double, 2> out_least{0, 0.5}, out_most{8, 1.1};    // m/s, rad
};

// A network as a model file has it: its numbers one after another, w1 row by row, b1, w2, b2, least and most of k and y,
// least and most of speed and angle. Back: none for another count, a number that is not finite, or an empty range.
std::string chip_text(const ChipNetwork& network);
std::optional<ChipNetwork> chip_of_text(std::string_view text);

// Trained on the stated model of sim/field/chip_kick.h.
extern const ChipNetwork kDefaultChip;

struct DribblerModel {
  double bar_x_m = 0.0797, bar_z_m = 0.0386, bar_radius_m = 0.007, half_width_m = 0.035;
  double friction = 0.8;  // of its material on the ball: guess, +-30 % (silicone)
  double mount_stiffness_N_per_m = 300.0, mount_damping_N_s_per_m = 6.0;  // guess, +-50 %: 0.8 of critical
  double inertia_kg_m2 = 4.8e-6;                                          // bar and rotor, at the bar
  double gear_ratio = 1.67;                                               // rotor turns per turn of the bar
  double resistance_ohm = 1.2, torque_constant_Nm_per_A = 0.0133;
  double friction_Nm = 1e-3;  // bearings and belt, at the bar: guess, +-50 %
  double current_limit_A = 10.0;
};

struct BreakBeam {
  double forward_m = 0.020;  // before the front
  double height_m = 0.0215;
  double reaction_s = 0.5e-3;
  double false_rate_Hz = 0.0;  // false triggers: how often, and how long each
  double false_time_s = 5e-3;
};

struct BallHandling {
  RobotOutline outline;
  double kick_reach_m = 0.015;  // from the front: how far the plunger takes the ball
  double kick_half_width_m = 0.035;
  double restitution = 0.35, friction = 0.3;  // of the hull: guess, +-30 %
  KickLaw kick;
  KickCapacitor capacitor;
  ChipNetwork chip{};  // handling_of() gives kDefaultChip where a model says nothing
  DribblerModel dribbler;
  BreakBeam beam;
};

// Bakhshandeh and Sharbafi 2012, eq. (1). Below k = 1.9 it is negative: no kick; they kick 10 m/s, k = 24.
inline constexpr KickLaw kSeedKick{1e-3, {-0.0098, -0.0315, 0.0213, -0.0001}, 2.0, 24.0};

const BallHandling& handling_of(const RobotModel& model);

}  // namespace omnihil
