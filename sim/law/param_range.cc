#include "sim/law/param_range.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "sim/law/linear_scale.h"

namespace omnihil {
namespace {

// Replaces `from` by `to` where it stands as a word between underscores (a power may follow).
std::string with_word(std::string key, std::string_view from, std::string_view to) {
  for (std::size_t at = key.find(from); at != std::string::npos; at = key.find(from, at + to.size())) {
    const std::size_t end = at + from.size();
    const bool starts = at > 0 && key[at - 1] == '_';
    const bool ends =
        end == key.size() || key[end] == '_' || std::isdigit(static_cast<unsigned char>(key[end]));
    if (starts && ends) key.replace(at, from.size(), to);
  }
  return key;
}

}  // namespace

std::string param_key(const EffectParam& row, bool linear) {
  if (!linear || row.trait == ParamTrait::kPeriodic) return std::string(row.name);
  return with_word(with_word(std::string(row.name), "Nm", "N"), "rad", "m");
}

ParamRange param_range(const EffectParam& row, bool linear, double torque_scale) {
  const std::string key(row.name);
  const bool torque = key.find("_Nm") != std::string::npos && key.find("per_Nm") == std::string::npos;
  const bool force = linear && torque && param_key(row, true) != key;
  const bool speed = linear && row.unit == "rad/s";
  const double strong = torque && !linear ? torque_scale : 1.0;
  const double scale = force ? kForceOverTorque_per_m : (speed ? kTravelOverAngle_m_per_rad : strong);
  return {row.lower * scale, row.upper * scale, row.prior_scale * scale, scale};
}

std::string allowed_range(const EffectParam& row, bool linear) {
  const ParamRange range = param_range(row, linear, kStrongestDrive);
  const std::string key = param_key(row, linear);
  std::string unit(row.unit == "1" ? "" : row.unit);
  if (key != row.name) {
    if (const std::size_t at = unit.find("N m"); at != std::string::npos) unit.replace(at, 3, "N");
    if (const std::size_t at = unit.find("rad"); at != std::string::npos) unit.replace(at, 3, "m");
  }
  return fmt::format("{:g} to {:g}{}{}", range.lower, range.upper, unit.empty() ? "" : " ", unit);
}

}  // namespace omnihil
