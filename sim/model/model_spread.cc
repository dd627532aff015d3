#include "sim/model/model_spread.h"

#include <algorithm>

#include "sim/law/random.h"
#include "sim/robot/validate.h"

namespace omnihil {
namespace {

constexpr double kMostSigmas = 3.0;
constexpr std::uint64_t kMostTries = 50;

ParameterTable drawn(const ParameterTable& table, double spread, std::uint64_t seed, std::uint64_t robot,
                     std::uint64_t attempt) {
  ParameterTable out = table;
  for (Parameter& p : out.parameters) {
    if (!p.tolerance || is_text(*p.row) || p.row->kind == ParameterKind::kWholeNumber) continue;
    const std::uint64_t stream = mix_bits(stream_of(parameter_path(*p.row)) + robot);
    for (std::size_t i = 0; i < p.values.size(); ++i) {
      const double sigmas =
          std::clamp(gaussian(seed, stream, kMostTries * i + attempt), -kMostSigmas, kMostSigmas);
      const double value = p.values[i] * (1.0 + spread * *p.tolerance * sigmas);
      if (within_bounds(*p.row, value)) p.values[i] = value;
    }
  }
  return out;
}

}  // namespace

RobotModel spread_robot(const ModelFile& model, double spread, std::uint64_t seed, int robot,
                        const PlantOptions& options) {
  if (!(spread > 0.0)) return *model.robot;
  for (std::uint64_t attempt = 0; attempt < kMostTries; ++attempt) {
    RobotModel one =
        robot_model_of(drawn(model.parameters, spread, seed, static_cast<std::uint64_t>(robot), attempt));
    one.name = model.robot->name;
    one.motor.name = model.robot->motor.name;
    one.told = std::make_shared<const RobotModel>(*model.robot);
    if (plant_problems({&one, 1}, options).empty()) return one;
  }
  return *model.robot;
}

}  // namespace omnihil
