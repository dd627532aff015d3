// Benches as files: `serve --bench`.
#include "tests/fuzz/fuzz_target.h"
#include "tools/options/bench_file.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  static const std::vector<BenchOption> kOptions = {{"robot"},
                                                    {"robots"},
                                                    {"team"},
                                                    {"with"},
                                                    {"duration"},
                                                    {"strict", true},
                                                    {"league", true},
                                                    {"league-sync"},
                                                    {"air-loss"},
                                                    {"air-latency"},
                                                    {"robot-of"},
                                                    {"firmware-of"},
                                                    {"with-of"},
                                                    {"start"},
                                                    {"fault"},
                                                    {"opponents"},
                                                    {"opponents-device"},
                                                    {"opponents-radio"},
                                                    {"physics"},
                                                    {"field"},
                                                    {"ball"},
                                                    {"seed"},
                                                    {"radio"},
                                                    {"air-bit-errors"}};
  const BenchArguments read =
      bench_arguments(std::string(text_of(bytes)), "fuzz.toml", "", kOptions, {"team"});
  for (const ModelProblem& problem : read.problems) demand(!problem.text().empty(), "a problem has words");
  demand(read.problems.empty() || read.arguments.empty(), "arguments or problems");
  for (const std::string& argument : read.arguments) demand(argument.starts_with("--"), "an option");
}
