// Units as people write them, and the way from one to another.
//
//   std::string fault;
//   std::optional<UnitScale> c = unit_scale("rpm", "rad/s", {}, fault);        // signal = value * c->scale
//   split_unit("motor current [mA]");                                          // {"motor current", "mA"}
//
// Known: times, angles, speeds, currents, voltages, torques, forces, lengths, accelerations, temperatures, ratios,
// counts. "-rad" is a radian the other way round, "0.0018*m" 1.8 mm for each of the column's own (pixels, a converter's counts).
// Electrical speeds and angles ("erpm", "erad/s", "erad") need the number of pole pairs. Turns are full turns;
// "Hz" of a speed is turns a second. Cannot: prefixes and products in general.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

struct UnitScale {
  double scale = 1.0;
  double offset = 0.0;  // signal = value * scale + offset
};

struct UnitContext {
  double pole_pairs = 0.0;  // 0: not known
};

// None: not of one kind, or not known; `fault` says which and what is allowed.
std::optional<UnitScale> unit_scale(std::string_view from, std::string_view to, const UnitContext& context,
                                    std::string& fault);

// The units that a signal in `to` may be given in: {"rad/s", "rpm", "deg/s", …}.
std::vector<std::string> units_for(std::string_view to);
bool is_unit(std::string_view word);

// A column's name without the unit that it ends in, and that unit; "" where it says none.
std::pair<std::string, std::string> split_unit(std::string_view name);

}  // namespace omnihil
