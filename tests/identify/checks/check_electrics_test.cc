#include <gtest/gtest.h>

#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "tests/identify/checks/data_findings.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

std::vector<DataFinding> check(const Bench& bench) { return check_data(bench.dataset, bench.nominal); }

// Three times the resistance, 0.7 V at the largest current: a bridge may take as much. Not nearly all there is.
TEST(CheckDataElectrics, ACurrentThatIsTooSmallByWhatABridgeLosesIsADoubt) {
  const auto with_current_over = [](double divisor) {
    Bench bench = simulated_bench({.with = {}, .model = ""});
    for (omnihil::Run& run : bench.dataset.runs) {
      for (double& v : run.signals.find("motor_current")->second) v /= divisor;
    }
    return check(bench);
  };
  const auto few = with_current_over(3.0), many = with_current_over(30.0);
  const DataFinding *doubt = find(few, "wrong_scale"), *fault = find(many, "wrong_scale");
  ASSERT_NE(doubt, nullptr) << text_of(few);
  EXPECT_EQ(doubt->grade, Grade::kDoubt) << doubt->sentence;
  EXPECT_NE(doubt->sentence.find("a bridge that loses up to"), std::string::npos) << doubt->sentence;
  ASSERT_NE(fault, nullptr) << text_of(many);
  EXPECT_EQ(fault->grade, Grade::kFault) << fault->sentence;
}

TEST(CheckDataElectrics, AFrozenPositionBesideASpeedThatMovesIsNoStall) {
  Bench bench = simulated_bench({.with = {}, .counts_per_turn = 0.0, .model = ""});
  bench.dataset.channels.push_back({.signal = "velocity", .column = "w", .unit = "rad/s"});
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& x = run.signals.find("position")->second;
    std::vector<double>& speed = run.signals["velocity"];
    for (std::size_t k = 0; k < x.size(); ++k) speed.push_back(k == 0 ? 0.0 : (x[k] - x[k - 1]) / 1e-3);
  }
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& x = run.signals.find("position")->second;
    x.assign(x.size(), 1.0);
  }
  const auto findings = check(bench);
  EXPECT_EQ(find(findings, "near_stall"), nullptr) << text_of(findings);
}

// Speed against voltage of a drive whose bridge takes most of what a slow controller asks: a fifth of the ideal slope,
// through zero. In one run it is driven fully and reaches its speed, so the scale is right; without that run nobody can tell.
TEST(CheckDataElectrics, ADriveThatADeadBandEatsHasNoWrongScale) {
  constexpr double kIdeal_rad_s_per_V = 1.0 / 0.0335;
  const auto bench_with_fastest = [&](double fast_share) {
    Bench bench = simulated_bench({.with = {}, .counts_per_turn = 0.0, .model = ""});
    for (omnihil::Run& run : bench.dataset.runs) {
      const bool fast = run.file == bench.dataset.runs.back().file;
      run.split = fast ? Split::kExtrapolation : Split::kTraining;
      std::vector<double>& x = run.signals.find("position")->second;
      std::vector<double>& duty = run.signals.find("duty")->second;
      double angle = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        duty[k] = (fast ? 1.0 : 0.3) * std::sin(2e-3 * static_cast<double>(k));
        angle += 1e-3 * duty[k] * 24.0 * kIdeal_rad_s_per_V * (fast ? fast_share : 0.2) /
                 3.0;  // at the output, gear 3
        x[k] = angle;
      }
    }
    return bench;
  };
  EXPECT_EQ(find(check(bench_with_fastest(0.9)), "wrong_scale"), nullptr)
      << text_of(check(bench_with_fastest(0.9)));
  EXPECT_NE(find(check(bench_with_fastest(0.2)), "wrong_scale"), nullptr);
}

// One duty throughout, at the speed that it gives. The battery recovers by a thousandth while the drive runs warm and gains 4 % of
// its speed: a line over that thousandth rises forty times as steeply as a motor's, and says nothing of a scale.
TEST(CheckDataElectrics, AtOneWorkingPointNoScaleIsTold) {
  constexpr double kIdeal_rad_s_per_V = 1.0 / 0.0335, kBus_V = 24.0, kDuty = 0.3, kGear = 3.0;
  Bench bench = simulated_bench({.with = {}, .counts_per_turn = 0.0, .model = ""});
  bench.dataset.channels.push_back({.signal = "bus_voltage", .column = "bus", .unit = "V"});
  std::uint64_t stream = 0;
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& x = run.signals.find("position")->second;
    std::vector<double>& bus_V = run.signals["bus_voltage"];
    run.signals.find("duty")->second.assign(x.size(), kDuty);
    ++stream;
    double angle = 0.0, wander = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double warm = static_cast<double>(k) / static_cast<double>(x.size());
      bus_V.push_back(kBus_V * (1.0 + 1e-3 * warm));
      wander += 1e-2 * (gaussian(1, stream, k) - 0.5 * wander);  // 2 Hz, of 10 %
      angle += 1e-3 * kDuty * kBus_V * kIdeal_rad_s_per_V * 0.8 * (1.0 + 0.04 * warm + 0.3 * wander) / kGear;
      x[k] = angle;
    }
  }
  EXPECT_EQ(find(check(bench), "wrong_scale"), nullptr) << text_of(check(bench));
}

// Three times too fast for its duty: within the whole bus a bridge that coasts in its off-time does that as well.
TEST(CheckDataElectrics, ASpeedWithinTheBusMayBeACoastingBridge) {
  for (const double amplitude : {0.2, 0.9}) {
    Bench bench = simulated_bench({.amplitude = amplitude, .with = {}, .model = ""});
    for (Channel& channel : bench.dataset.channels) channel.counts_per_rev /= 3.0;
    const auto findings = check(bench);
    const DataFinding* f = find(findings, "wrong_scale");
    ASSERT_NE(f, nullptr) << amplitude << text_of(findings);
    EXPECT_EQ(f->sentence.find("coast_mode") != std::string::npos, amplitude < 0.3) << f->sentence;
  }
}

// The same of a bridge that does coast: its ratio falls with the duty, and it is no fault.
TEST(CheckDataElectrics, ABridgeThatCoastsIsADoubt) {
  Bench bench = simulated_bench(
      {.amplitude = 0.3,
       .with = {"coast_mode.coast_share=1", "coast_mode.time_constant_s=2e-6", "coast_mode.return_ratio=1"},
       .excitations = {Excitation::kRamp, Excitation::kRamp, Excitation::kRamp},
       .duration_s = 20.0,
       .model = ""});
  for (omnihil::Run& run : bench.dataset.runs) run.signals.erase("motor_current");
  const auto findings = check(bench);
  EXPECT_EQ(count(findings, Grade::kFault), 0) << text_of(findings);
  const DataFinding* f = find(findings, "wrong_scale");
  ASSERT_NE(f, nullptr) << text_of(findings);
  EXPECT_NE(f->sentence.find("falls with the duty"), std::string::npos) << f->sentence;
  bench.nominal = with_effect(bench.nominal, *find_effect("coast_mode"));
  ASSERT_EQ(set_value(bench.nominal, "coast_mode.coast_share", 1.0), "");
  EXPECT_EQ(find(check(bench), "wrong_scale"), nullptr) << "the model has it";
}

// Three times too fast at a fifth of the current: no one wrong scale does both, a bridge that coasts does. Of a duty that reaches
// beyond the bus it is none.
TEST(CheckDataElectrics, ABridgeThatCoastsIsADoubtByItsCurrentToo) {
  struct {
    double amplitude, counts, current;
    bool doubt;
  } constexpr kCases[] = {{0.2, 3.0, 0.2, true}, {0.2, 3.0, 1.0, false}, {0.9, 3.0, 0.2, false}};
  for (const auto& c : kCases) {
    Bench bench = simulated_bench({.amplitude = c.amplitude, .with = {}, .model = ""});
    for (Channel& channel : bench.dataset.channels) channel.counts_per_rev /= c.counts;
    for (omnihil::Run& run : bench.dataset.runs)
      for (double& v : run.signals["motor_current"]) v *= c.current;
    const auto findings = check(bench);
    const DataFinding* f = find(findings, "wrong_scale");
    ASSERT_NE(f, nullptr) << c.amplitude << text_of(findings);
    EXPECT_EQ(f->sentence.find("two wrong scales") != std::string::npos, c.doubt) << f->sentence;
    EXPECT_EQ(count(findings, Grade::kFault) == 0, c.doubt) << text_of(findings);
  }
}

}  // namespace
}  // namespace omnihil
