// Sensors that are slower than the rows they were logged in.
#include <gtest/gtest.h>

#include "tests/identify/checks/data_findings.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// A telemetry of a tenth of the rate, repeated in the rows between: no counts were dropped and none jump.
TEST(CheckHeld, ASlowSensorsReadingsThatAreRepeated) {
  Bench bench = simulated_bench({.with = {}, .model = ""});
  for (std::size_t r = 0; r < 3; ++r) {
    std::vector<double>& ticks = bench.dataset.runs[r].signals["encoder"];
    for (std::size_t k = 0; k < ticks.size(); ++k) ticks[k] = ticks[k - k % 10];
  }
  const auto findings = check_data(bench.dataset, bench.nominal);
  const DataFinding* f = find(findings, "held_readings");
  ASSERT_NE(f, nullptr) << text_of(findings);
  EXPECT_GE(f->grade, Grade::kDoubt) << text_of(findings);
  EXPECT_NE(f->sentence.find("encoder is new in one row of 10 only"), std::string::npos) << f->sentence;
  EXPECT_EQ(find(findings, "glitch"), nullptr) << text_of(findings);
  EXPECT_EQ(find(findings, "dropped_counts"), nullptr) << text_of(findings);
  for (std::size_t r = 0; r < 3; ++r) {  // left empty they are sound
    std::vector<double>& ticks = bench.dataset.runs[r].signals["encoder"];
    for (std::size_t k = 0; k < ticks.size(); ++k) ticks[k] = k % 10 == 0 ? ticks[k] : kMissing;
  }
  EXPECT_EQ(find(check_data(bench.dataset, bench.nominal), "held_readings"), nullptr);
}

}  // namespace
}  // namespace omnihil
