#include "hil/dataset/dataset_model.h"

#include <array>
#include <string_view>

#include "sim/model/effect_reader.h"
#include "sim/model/model_writer.h"

namespace omnihil {
namespace {

struct Key {
  std::string_view section;
  std::string_view key;
};
// In the order of the format's own example.
constexpr std::array kModelKeys{
    Key{"motor", "resistance_ohm"},
    Key{"motor", "inductance_H"},
    Key{"motor", "torque_constant_Nm_per_A"},
    Key{"motor", "pole_pairs"},
    Key{"motor", "slots"},
    Key{"motor", "rotor_inertia_kg_m2"},
    Key{"motor", "viscous_friction_Nm_s_per_rad"},
    Key{"gear", "ratio"},
    Key{"supply", "voltage_V"},
    Key{"robot", "mass_kg"},
    Key{"robot", "yaw_inertia_kg_m2"},
    Key{"robot", "center_of_mass_height_m"},
    Key{"robot", "wheel_center_radius_m"},
    Key{"robot", "wheel_radius_m"},
    Key{"robot", "wheel_inertia_kg_m2"},
    Key{"robot", "wheel_angle_deg"},
    Key{"robot", "rollers_per_wheel"},
    Key{"robot", "slip_speed_floor_m_s"},
    Key{"encoder", "counts_per_turn"},
    Key{"tyre.longitudinal", "extremum_slip"},
    Key{"tyre.longitudinal", "extremum_value"},
    Key{"tyre.longitudinal", "asymptote_slip"},
    Key{"tyre.longitudinal", "asymptote_value"},
    Key{"tyre.lateral", "extremum_slip"},
    Key{"tyre.lateral", "extremum_value"},
    Key{"tyre.lateral", "asymptote_slip"},
    Key{"tyre.lateral", "asymptote_value"},
    Key{"effects.coulomb_friction", "torque_Nm"},
};

}  // namespace

std::string dataset_model_text(const ModelFile& model) {
  std::string text = "format = \"omnihil-model/1\"\nrig = \"robot\"\n";
  if (!model.name.empty()) text += "name = " + toml_text(model.name) + "\n";
  if (!model.source.empty()) text += "source = " + toml_text(model.source) + "\n";
  std::string_view section;
  for (const Key& key : kModelKeys) {
    const Parameter* parameter = model.parameters.find(std::string(key.section) + "." + std::string(key.key));
    if (parameter == nullptr || parameter->values.empty()) continue;
    const bool is_count = parameter->row->kind == ParameterKind::kWholeNumber;
    if (is_count && parameter->value() == 0.0) continue;  // 0 poles, slots or rollers: not known
    if (key.section != section) text += "\n[" + std::string(key.section) + "]\n";
    section = key.section;
    text += parameter_line(key.key, *parameter);
  }
  const bool more = model.robot && model.robot->effects != nullptr;
  return more ? text + write_effects(*model.robot->effects, false) : text;
}

}  // namespace omnihil
