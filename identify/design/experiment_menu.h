// Menu of excitations: values of -1 … 1 over time, for one drive, for each of a robot's, or for its body.
//
//   for (const MenuRun& run : axis_menu(time_s, seed)) run.drive[0][k];
//   for (const MenuRun& run : body_menu(time_s, seed)) run.drive[0][k];      // ahead, to the left, turn
//   for (const MenuRun& run : robot_menu(time_s, wheel_angle_rad, seed)) run.drive[i][k];
//
// Besides those of sim/bench/excitation.h: multisine (harmonics with Schroeder's phases), staircase,
// reversals, pulses with rests, acceleration and braking in pairs, and hold: warm up at a level between two
// equal probes. For a robot the same along x, y and the turn, and a scan of directions. The first of a menu
// is the generic run that others are held against. Source: Schroeder 1970 (phases of a flat multisine);
// Pintelon and Schoukens 2012, ch. 2 (periodic inputs).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace omnihil {

struct MenuRun {
  std::string excitation;                  // "reversals_1s"
  std::string words;                       // "turns round every second"
  std::vector<std::vector<double>> drive;  // [drive][sample], of no unit
};

std::vector<MenuRun> axis_menu(const std::vector<double>& time_s, std::uint64_t seed);
std::vector<MenuRun> robot_menu(const std::vector<double>& time_s, std::span<const double> wheel_angle_rad,
                                std::uint64_t seed);
std::vector<MenuRun> body_menu(const std::vector<double>& time_s, std::uint64_t seed);

}  // namespace omnihil
