// What is wrong with robot models and plant options: every problem at once, in words a model's author can act
// on.
//
//   for (const std::string& problem : plant_problems(robots, options)) std::puts(problem.c_str());
//   // robot 0 "ours": mass_kg = -2.4 kg; must be more than 0
//
// Checked: every number against its range; mass and inertia left for the chassis; wheel loads not negative
// and summing to m g within 1e-9; wheels that span three speeds; the steps dividing each other; the explicit
// step short enough for tyre, inertia and load (stiffest contact mode).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/robot/plant.h"

namespace omnihil {

std::vector<std::string> robot_problems(const RobotModel& model);
std::vector<std::string> plant_problems(std::span<const RobotModel> robots, const PlantOptions& options);
// Throws std::invalid_argument with all of them, a line each, if there are any.
void require_valid(std::span<const RobotModel> robots, const PlantOptions& options);

// Decay rate (1/s) of the stiffest sliding mode of the four contacts at standstill. Explicit integration is
// stable while rate * step < explicit_limit(integrator).
//   rate = largest eigenvalue of D (r^2 / J + T M^-1 T'),  D = 1.5 mu N_max / (s_ext floor),
//   T = rim speeds per body speed (eq. 5), M = body mass matrix.
double stiffest_contact_rate(const RobotModel& model);
double explicit_limit(Integrator integrator);

// Same models and options give the same number; any other almost surely another.
std::uint64_t plant_fingerprint(std::span<const RobotModel> robots, const PlantOptions& options);

}  // namespace omnihil
