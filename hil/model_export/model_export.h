// A robot in the formats of other programs: MJCF (MuJoCo), URDF, a C header; each with the list of what does not survive.
//
//   const ModelExport made = export_robot(*stored.model, ExportFormat::kMjcf, "my_robot");
//   for (const std::string& line : made.lost) std::puts(line.c_str());
//
// MJCF: masses, wheels with their rollers as free bodies, the DC motor as a linear actuator whose control is the duty.
// URDF: masses, wheels, friction of the joints; the motor is numbers in comments. C header: every number of the file.
// What these formats need and the model does not have is assumed, and listed in `assumed`. Both lists stand at the head of
// the file as well. Cannot: FMU; effects other than Coulomb friction; anything that is no robot.
#pragma once
#include <string>
#include <vector>

#include "sim/model/model_file.h"

namespace omnihil {

enum class ExportFormat : std::uint8_t { kMjcf, kUrdf, kC };

struct ModelExport {
  std::string text;
  std::vector<std::string> lost;     // what the format does not hold, a line each
  std::vector<std::string> assumed;  // what the format needs and the model does not say
  std::string problem;               // not empty: cannot be written, and why; the text is then empty
};

// `name`: of the model in the file. A model that is no robot has a problem.
ModelExport export_robot(const ModelFile& model, ExportFormat format, const std::string& name);

}  // namespace omnihil
