// Scenario files.
#include "hil/scenario/scenario.h"
#include "tests/fuzz/fuzz_target.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  const ScenarioReading reading = read_scenario(text_of(bytes), "fuzz.toml");
  demand(reading.scenario.has_value() == reading.problems.empty(), "a scenario or a problem");
  for (const ModelProblem& problem : reading.problems) demand(!problem.text().empty(), "a problem has words");
}
