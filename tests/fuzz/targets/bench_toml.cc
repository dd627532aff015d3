// Benches as files: `serve --bench`.
#include "tests/fuzz/fuzz_target.h"
#include "tools/options/bench_file.h"

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  static const std::vector<BenchOption> kOptions = {{"robot"},        {"robots"},      {"team"},
                                                    {"with"},         {"duration"},    {"strict", true},
                                                    {"league", true}, {"league-sync"}, {"air-loss"}};
  const BenchArguments read =
      bench_arguments(std::string(text_of(bytes)), "fuzz.toml", "", kOptions, {"team"});
  for (const ModelProblem& problem : read.problems) demand(!problem.text().empty(), "a problem has words");
}
