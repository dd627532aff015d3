// Every key a model file may have, one row each: the single place where a parameter is named, bounded and
// explained. The format is omnihil-model/1; docs/model-files.md lists the rows for people.
#pragma once
#include <span>
#include <string_view>

#include "sim/model/params.h"

namespace omnihil {

inline constexpr std::string_view kModelFormat = "omnihil-model/1";

std::span<const ParameterRow> model_rows();

// The row of a key, or null. Section "effects.coulomb_friction", key "torque_Nm".
const ParameterRow* find_model_row(std::string_view section, std::string_view key);

// True for "motor", "tyre", "tyre.lateral", "effects": something under it has a row.
bool is_model_section(std::string_view section);

// Names of the physical effects that [effects.NAME] may hold.
std::span<const std::string_view> effect_names();

// "robot", "axis", "motor", with "linear axis" said apart: for messages.
std::string rig_names(std::uint32_t rigs);

}  // namespace omnihil
