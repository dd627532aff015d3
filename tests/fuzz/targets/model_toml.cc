// Model files: a robot, an axis or a motor..
#include "sim/model/axis_model.h"
#include "sim/model/model_figures.h"
#include "sim/model/model_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/whole_file.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  static const std::string kMotor = whole_file(OMNIHIL_SOURCE_DIR "/models/motors/nanotec_df45.toml");
  const MotorFileLoader motor = [](const std::string& name) { return MotorFileText{name, kMotor, {}}; };
  const ModelReading reading = read_model(text_of(bytes), "fuzz.toml", motor);
  demand(reading.model.has_value() == reading.problems.empty(), "a model or a problem");
  for (const ModelProblem& problem : reading.problems) demand(!problem.text().empty(), "a problem has words");
  if (reading.model) model_figures(*reading.model);
  const AxisReading axis = read_axis_model(text_of(bytes), "fuzz.toml", motor);
  demand(axis.model.has_value() == axis.problems.empty(), "an axis or a problem");
}
