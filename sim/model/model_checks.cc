#include "sim/model/model_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/robot/ball_handling.h"
#include "sim/robot/electric_model.h"

namespace omnihil {
namespace {

class Checks {
 public:
  Checks(const ParameterTable& table, std::vector<ModelConflict>& out) : table_(table), out_(out) {}

  double operator[](std::string_view path) const { return table_.value_or(path, 0.0); }

  void need(bool good, std::string_view path, std::string what, std::string allowed) {
    if (!good) out_.push_back({table_.find(path), std::move(what), std::move(allowed)});
  }

 private:
  const ParameterTable& table_;
  std::vector<ModelConflict>& out_;
};

void check_encoder(Checks& c) {
  c.need(c["encoder.direction"] != 0.0, "encoder.direction", "the counter has no direction",
         "allowed: 1 or -1");
  c.need(c["encoder.index_offset_counts"] < c["encoder.counts_per_turn"], "encoder.index_offset_counts",
         "lies beyond one turn",
         fmt::format("allowed: 0 to {:g} (counts_per_turn - 1)", c["encoder.counts_per_turn"] - 1));
}

void check_tyre(Checks& c, const std::string& section) {
  const double extremum_slip = c[section + ".extremum_slip"], extremum = c[section + ".extremum_value"];
  c.need(c[section + ".asymptote_slip"] > extremum_slip, section + ".asymptote_slip",
         "the curve must reach its extremum first",
         fmt::format("allowed: more than extremum_slip, {:g}", extremum_slip));
  c.need(c[section + ".asymptote_value"] <= extremum, section + ".asymptote_value",
         "grip beyond the extremum cannot be larger than at it",
         fmt::format("allowed: 0 to extremum_value, {:g}", extremum));
}

void check_wheels(Checks& c, const std::vector<double>& angle_deg) {
  constexpr double kApart_deg = 5.0;
  for (std::size_t i = 0; i < angle_deg.size(); ++i) {
    for (std::size_t j = i + 1; j < angle_deg.size(); ++j) {
      const double apart_deg = std::abs(std::remainder(angle_deg[i] - angle_deg[j], 360.0));
      c.need(apart_deg >= kApart_deg, "robot.wheel_angle_deg",
             fmt::format("wheels {} and {} sit in the same place ({:g} and {:g} deg)", i + 1, j + 1,
                         angle_deg[i], angle_deg[j]),
             fmt::format("allowed: at least {:g} deg apart", kApart_deg));
    }
  }
}

// A differential drive stands on wheels without rollers: what holds them sideways is not the usual roller's drag.
void check_sideways(Checks& c, const ParameterTable& table) {
  const std::vector<double>& angle_deg = table.find("robot.wheel_angle_deg")->values;
  // of 180 degrees, as in geometry.h
  constexpr double kParallel_deg = 0.05;
  const bool parallel = std::all_of(angle_deg.begin(), angle_deg.end(), [&](double a) {
    return std::abs(std::remainder(a - angle_deg.front(), 180.0)) < kParallel_deg;
  });
  const Parameter* grip = table.find("tyre.lateral.extremum_value");
  c.need(!parallel || grip->origin != Origin::kDefault, "tyre.lateral.extremum_value",
         "is not given, and all axles are parallel: only the wheels' own grip holds the robot sideways",
         "needed: a [tyre.lateral] of wheels without rollers, as large as [tyre.longitudinal]");
}

// "motor.pole_pairs = 0: a three-phase drive needs 1 or more", each at the number it names.
void check_electrics(const ParameterTable& table, std::vector<ModelConflict>& out) {
  for (const std::string& problem : electric_problems(robot_model_of(table))) {
    const std::string path = problem.substr(0, problem.find_first_of(" :,"));
    const Parameter* at = table.find(path);
    out.push_back(
        {at != nullptr ? at : table.find("drive.kind"), problem.substr(problem.find(": ") + 2), ""});
  }
}

void check_masses(Checks& c, std::size_t wheels) {
  const double mass_kg = c["robot.mass_kg"];
  c.need(static_cast<double>(wheels) * c["robot.wheel_mass_kg"] < mass_kg, "robot.wheel_mass_kg",
         fmt::format("{} wheels weigh more than the robot", wheels == 4 ? "four" : std::to_string(wheels)),
         fmt::format("allowed: less than {:g} kg, {} of robot.mass_kg", mass_kg / static_cast<double>(wheels),
                     wheels == 4 ? "a quarter" : fmt::format("1/{}", wheels)));
  const double radius_m = c["robot.wheel_center_radius_m"];
  const double offset_m = std::hypot(c["robot.center_of_mass_x_m"], c["robot.center_of_mass_y_m"]);
  const char* larger = std::abs(c["robot.center_of_mass_x_m"]) >= std::abs(c["robot.center_of_mass_y_m"])
                           ? "robot.center_of_mass_x_m"
                           : "robot.center_of_mass_y_m";
  c.need(offset_m < radius_m, larger, "the centre of mass lies outside the wheels: the robot would tip over",
         fmt::format("allowed: an offset below wheel_center_radius_m, {:g} m", radius_m));
}

}  // namespace

std::vector<ModelConflict> model_conflicts(const ParameterTable& table, std::uint32_t rig) {
  std::vector<ModelConflict> out;
  Checks c(table, out);
  if (rig != kRigLinearAxis) check_encoder(c);
  if (rig == kRigAxis) {
    c.need(c["load.inertia_kg_m2"] > 0.0 || c["motor.rotor_inertia_kg_m2"] > 0.0, "load.inertia_kg_m2",
           "there is nothing to move",
           "needed: a rotor_inertia_kg_m2 in [motor] or an inertia_kg_m2 in [load]");
  }
  if (rig == kRigRobot) {
    check_tyre(c, "tyre.longitudinal");
    check_tyre(c, "tyre.lateral");
    check_wheels(c, table.find("robot.wheel_angle_deg")->values);
    check_sideways(c, table);
    check_masses(c, table.find("robot.wheel_angle_deg")->values.size());
    if (const Parameter* const chip = table.find("kicker.chip_network");
        chip != nullptr && !chip->text.empty())
      c.need(chip_of_text(chip->text).has_value(), "kicker.chip_network", "is no network",
             "allowed: the 70 numbers that omnihil field chip prints");
    check_electrics(table, out);
  }
  return out;
}

}  // namespace omnihil
