#include "tools/options/firmware_cost.h"

#include <fmt/format.h>

#include <cstdio>

namespace omnihil {

void say_firmware_ahead(const char* verb, const FirmwareMeter& meter, const Predictor& predictor,
                        const Candidate& candidate, std::size_t numbers) {
  const FirmwareUse before = meter.seen();
  int runs = 0;
  for (int r = 0; r < predictor.run_count(); ++r) {
    if (predictor.run(r).split != kTraining) continue;
    predictor.predict(candidate, r);
    ++runs;
  }
  const FirmwareUse after = meter.seen();
  if (after.simulations == before.simulations) return;
  const double once_s = after.wall_s - before.wall_s;
  const std::size_t step = 2 * numbers + 1;
  fmt::print(
      stderr,
      "omnihil {}: the firmware runs in every simulation: {:.3g} s for the {} to fit, {:.3g} times as fast "
      "as the robot; a step of a fit takes {} of them for {} number{}, {:.3g} s on one thread\n",
      verb, once_s, runs == 1 ? "run" : fmt::format("{} runs", runs),
      (after.simulated_s - before.simulated_s) / once_s, step, numbers, numbers == 1 ? "" : "s",
      once_s * static_cast<double>(step));
}

void say_firmware_cost(const char* verb, const FirmwareMeter& meter) {
  const FirmwareUse seen = meter.seen();
  if (seen.simulations == 0) return;
  fmt::print(stderr,
             "omnihil {}: {} simulation{} of a run with the firmware, {:.3g} s each, {:.3g} s together\n",
             verb, seen.simulations, seen.simulations == 1 ? "" : "s",
             seen.wall_s / static_cast<double>(seen.simulations), seen.wall_s);
  if (seen.failed > 0)
    fmt::print(stderr, "omnihil {}: the firmware failed in {} of them: {}\n", verb, seen.failed,
               seen.failure);
}

}  // namespace omnihil
