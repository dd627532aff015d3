#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "identify/select/diagnosis.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "tests/identify/checks/data_findings.h"
#include "tests/identify/simulated_bench.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil {
namespace {

std::vector<DataFinding> check(const Bench& bench) { return check_data(bench.dataset, bench.nominal); }

// Every kind of drive, without any effect that the nominal model lacks.
TEST(CheckData, SoundDataBringNoDoubts) {
  const struct {
    CommandKind drive;
    const char* name;
    double amplitude;
  } kDrives[] = {{CommandKind::kDuty, "duty", 0.6},
                 {CommandKind::kMotorVoltage, "motor_voltage", 14.0},
                 {CommandKind::kMotorTorque, "motor_torque", 0.02}};
  for (const auto& drive : kDrives) {
    for (const double counts : {4096.0, 0.0}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Bench bench = simulated_bench({.drive = drive.drive,
                                             .drive_name = drive.name,
                                             .amplitude = drive.amplitude,
                                             .with = {},
                                             .counts_per_turn = counts,
                                             .seed = seed,
                                             .model = ""});
        const auto findings = check(bench);
        EXPECT_EQ(count(findings, Grade::kDoubt), 0) << drive.name << " " << counts << "\n"
                                                     << text_of(findings);
      }
    }
  }
}

// An effect is physics, however strong; only what cannot be physics is a fault.
TEST(CheckData, HiddenEffectsAreNoFaults) {
  for (const EffectEntry* entry : all_effects()) {
    const std::string id(entry->info->id);
    if ((entry->info->rigs & kOnAxis) == 0 || id == "expression") continue;
    const Bench bench = simulated_bench({.with = {id}, .duration_s = 6.0, .model = ""});
    const auto findings = check(bench);
    EXPECT_EQ(count(findings, Grade::kFault), 0) << id << "\n" << text_of(findings);
  }
}

class SpoiltData : public testing::Test {
 protected:
  SpoiltData() : bench(simulated_bench({.with = {}, .model = ""})) {}
  std::vector<double>& signal(std::size_t run, const char* name) {
    return bench.dataset.runs[run].signals.find(name)->second;
  }
  double rad_per_count() const {  // of the output; kWheelModel's gear
    const Channel& encoder = *bench.dataset.channel("encoder");
    return 2.0 * 3.14159265358979 / encoder.counts_per_rev / (encoder.on_output ? 1.0 : 3.0);
  }
  // A channel `velocity` of the output, in rad/s, from the counts by central differences over 20 ms.
  void add_true_speed() {
    for (omnihil::Run& run : bench.dataset.runs) {
      const std::vector<double>& ticks = *run.signal("encoder");
      std::vector<double> speed(ticks.size(), 0.0);
      for (std::size_t k = 10; k + 10 < ticks.size(); ++k) {
        const double turned = rad_per_count() * (ticks[k + 10] - ticks[k - 10]);
        speed[k] = turned / (run.time_s[k + 10] - run.time_s[k - 10]);
      }
      run.signals["velocity"] = speed;
    }
    bench.dataset.channels.push_back(*bench.dataset.channel("encoder"));
    bench.dataset.channels.back().signal = bench.dataset.channels.back().column = "velocity";
  }
  void expect(const char* kind, const char* words, Grade least = Grade::kFault) {
    const auto findings = check(bench);
    const DataFinding* f = find(findings, kind);
    ASSERT_NE(f, nullptr) << text_of(findings);
    EXPECT_GE(f->grade, least) << text_of(findings);
    EXPECT_NE(f->sentence.find(words), std::string::npos) << f->sentence;
  }
  Bench bench;
};

TEST_F(SpoiltData, GlitchesOfTheCounterAreCounted) {
  std::vector<double>& ticks = signal(0, "encoder");
  for (const std::size_t k : {500u, 1500u, 2500u, 3700u, 5100u}) ticks[k] += 3000.0;
  expect("glitch", "has 5 glitches");
}

TEST_F(SpoiltData, AnEncoderThatCountsBackwards) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "encoder")) v = -v;
  }
  expect("swapped_sign", "the sign of encoder or of duty is swapped");
}

// The duty of a board with a pin for the direction, logged without that pin.
TEST_F(SpoiltData, ADutyWhoseDirectionWasNotLogged) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "duty")) v = std::abs(v);
  }
  expect("drive_without_sign", "the direction was not logged");
}

// One row of a speed whose 16-bit counter went through zero.
TEST_F(SpoiltData, ASpeedFromACounterThatOverflowed) {
  add_true_speed();
  signal(0, "velocity")[1234] = -12854.4;
  expect("glitch", "velocity reads -1.285e+04 in 1 row");
}

TEST_F(SpoiltData, ASpeedBesideItsPositionIsNoGlitchAndOfNoWrongScale) {
  add_true_speed();
  const auto findings = check(bench);
  EXPECT_EQ(find(findings, "glitch"), nullptr) << text_of(findings);
  EXPECT_EQ(find(findings, "position_against_speed"), nullptr) << text_of(findings);
}

TEST_F(SpoiltData, ASpeedInTurnsIsOfAWrongScale) {
  add_true_speed();
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "velocity")) v /= 6.283185307179586;
  }
  expect("position_against_speed", "turns for radians");
}

// Kicks of 1 ms, each between two rows of 5 ms: the speed shows the tail of each, the position all of it. Many of them, of
// which it shows more than half; one alone, of which it shows a quarter.
TEST_F(SpoiltData, AKickBetweenTwoRowsSaysNothingOfScales) {
  constexpr std::size_t kRows = 1600;
  constexpr double kPeriod_s = 0.005, kCounts = 20.0;
  struct {
    std::size_t every;
    double seen;  // of a kick's displacement, in the speed
  } constexpr kKicks[] = {{160, 0.6}, {kRows, 0.25}};
  omnihil::Run& run = bench.dataset.runs[0];
  for (const auto& kicks : kKicks) {
    for (auto& [name, values] : run.signals) values = std::vector<double>(kRows, 0.0);
    run.signals["velocity"] = std::vector<double>(kRows, 0.0);
    run.time_s = std::vector<double>(kRows, 0.0);
    std::vector<double>&ticks = run.signals["encoder"], &speed = run.signals["velocity"];
    for (std::size_t k = 1; k < kRows; ++k) {
      run.time_s[k] = kPeriod_s * static_cast<double>(k);
      const bool kicked = k % kicks.every == 70;
      ticks[k] = ticks[k - 1] + (kicked ? kCounts : 0.0);
      speed[k] = kicked ? kicks.seen * kCounts * rad_per_count() / kPeriod_s : 0.0;
    }
    const auto findings = check(bench);
    EXPECT_EQ(find(findings, "position_against_speed"), nullptr) << kicks.every << "\n" << text_of(findings);
  }
}

TEST_F(SpoiltData, ACurrentOfTheWrongSign) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "motor_current")) v = -v;
  }
  expect("swapped_sign", "motor_current falls where the voltage rises");
}

TEST_F(SpoiltData, CountsPerTurnOfAnotherEncoder) {
  for (Channel& channel : bench.dataset.channels) channel.counts_per_rev /= 4.0;
  expect("wrong_scale", "gear ratio, counts_per_rev");
}

TEST_F(SpoiltData, CurrentInMilliamperes) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "motor_current")) v *= 1000.0;
  }
  expect("wrong_scale", "milliamperes");
}

TEST_F(SpoiltData, DutyInPerCent) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "duty")) v *= 100.0;
  }
  expect("wrong_scale", "looks like per cent");
}

TEST_F(SpoiltData, CountsDroppedWhileTheCounterStood) {
  std::vector<double>& ticks = signal(0, "encoder");
  for (const std::size_t from : {700u, 1900u, 3100u, 4300u}) {
    const double lost = ticks[from + 30] - ticks[from];
    for (std::size_t k = from; k < ticks.size(); ++k)
      ticks[k] = k < from + 30 ? ticks[from] : ticks[k] - lost;
  }
  expect("dropped_counts", "times in full motion");
}

TEST_F(SpoiltData, RowsThatRepeatAnOldValueAreNoLostCounts) {
  std::vector<double>& ticks = signal(0, "encoder");
  for (const std::size_t from : {700u, 1900u, 3100u, 4300u}) {
    for (std::size_t k = from; k < from + 5; ++k) ticks[k] = ticks[from];
  }
  const auto findings = check(bench);
  const DataFinding* f = find(findings, "old_values");
  ASSERT_NE(f, nullptr) << text_of(findings);
  EXPECT_EQ(find(findings, "dropped_counts"), nullptr) << text_of(findings);
}

// To and fro at one speed, 20 ms at rest at every turn: play and friction do that.
TEST_F(SpoiltData, ADriveThatTurnsBackMayStandInBetween) {
  std::vector<double>& ticks = signal(0, "encoder");
  for (std::size_t k = 1; k < ticks.size(); ++k) {
    const double direction = k / 1000 % 2 == 0 ? 1.0 : -1.0;
    ticks[k] = ticks[k - 1] + (k % 1000 < 20 ? 0.0 : 20.0 * direction);
  }
  const auto findings = check(bench);
  EXPECT_EQ(find(findings, "dropped_counts"), nullptr) << text_of(findings);
  EXPECT_EQ(find(findings, "old_values"), nullptr) << text_of(findings);
}

TEST_F(SpoiltData, ACounterThatWraps) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (double& v : signal(r, "encoder")) v -= 65536.0 * std::floor(v / 65536.0);
  }
  expect("counter_wraps", "wraps around");
}

TEST_F(SpoiltData, RowsStampedLate) {
  for (omnihil::Run& run : bench.dataset.runs) {
    double delay = 0.0, last = -1.0;
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
      if (uniform(5, 0, k) < 0.01) delay = 0.003 + 0.006 * uniform(5, 1, k);
      delay = std::max(0.0, delay - 0.0007);
      last = std::max(last + 2e-5, run.time_s[k] + delay);
      run.time_s[k] = last;
    }
  }
  expect("late_timestamps", "rows are stamped late");
}

TEST_F(SpoiltData, GapsAreCounted) {
  for (double& t : bench.dataset.runs[0].time_s) t += t > 4.0 ? 0.7 : 0.0;
  expect("gaps", "1 gaps in time, the longest 0.7", Grade::kNote);
}

TEST_F(SpoiltData, ASensorThatWasNotConnected) {
  for (double& v : signal(1, "encoder")) v = 17.0;
  expect("constant", "encoder is 17 throughout");
}

// A sweep's first duties do not move the drive: stiction is what they show. What such a run's speed is, is an offset of any sign.
TEST_F(SpoiltData, ADriveBelowItsBreakaway) {
  add_true_speed();
  for (omnihil::Run& run : bench.dataset.runs) run.signals.erase("encoder");
  std::erase_if(bench.dataset.channels, [](const Channel& c) { return c.signal == "encoder"; });
  for (double& u : signal(1, "duty")) u = 0.1 * std::abs(u);
  for (double& w : signal(1, "velocity")) w = -2.3e-17;
  expect("constant", "throughout: below the drive's breakaway", Grade::kDoubt);
  EXPECT_EQ(find(check(bench), "swapped_sign"), nullptr) << text_of(check(bench));
  EXPECT_EQ(count(check(bench), Grade::kFault), 0) << text_of(check(bench));
}

TEST_F(SpoiltData, ASupplyThatTheModelDoesNotName) {
  EXPECT_EQ(set_value(bench.nominal, "supply.voltage_V", 15.0), "");
  expect("wrong_supply", "the model's supply.voltage_V says 15", Grade::kDoubt);
}

TEST_F(SpoiltData, ABusVoltageThatNoSupplyGives) {
  omnihil::Run& run = bench.dataset.runs[0];
  std::vector<double> bus(run.time_s.size(), 15.9);
  for (std::size_t k = bus.size() - 300; k < bus.size(); ++k) bus[k] = 33.0;
  run.signals["bus_voltage"] = bus;
  expect("glitch", "bus_voltage reads up to 33 V in 300 rows", Grade::kDoubt);
}

TEST_F(SpoiltData, ALoadThatTheTorqueContainsAlready) {
  omnihil::Run& run = bench.dataset.runs[0];
  std::vector<double> load(run.time_s.size(), 0.0), torque(run.time_s.size(), 0.01);
  for (std::size_t k = 0; k < load.size(); ++k) {
    load[k] = k % 500 < 100 ? 0.05 : 0.0;
    torque[k] += load[k];
  }
  run.signals["load_torque"] = load;
  run.signals["motor_torque"] = torque;
  bench.dataset.channels.push_back(bench.dataset.channels.back());
  bench.dataset.channels.back().signal = "load_torque";
  bench.dataset.channels.push_back(bench.dataset.channels.back());
  bench.dataset.channels.back().signal = "motor_torque";
  expect("duplicate_force", "would be counted twice");
}

TEST_F(SpoiltData, ADriveThatHardlyMoves) {
  for (std::size_t r = 0; r < 3; ++r) {
    std::vector<double>& ticks = signal(r, "encoder");
    for (std::size_t k = ticks.size() / 4; k < ticks.size(); ++k) ticks[k] = ticks[ticks.size() / 4];
  }
  expect("near_stall", "limit of friction", Grade::kDoubt);
}

// Noise that the firmware draws faster than it logs. At the controller's own ticks the same is no fault.
TEST_F(SpoiltData, AnInputFasterThanItsRows) {
  omnihil::Run& run = bench.dataset.runs[1];
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    signal(1, "duty")[k] = uniform(5, 2, k) - 0.5;
  }
  EXPECT_EQ(find(check(bench), "fast_command"), nullptr);
  for (std::size_t k = 0; k < run.time_s.size(); ++k) run.time_s[k] += 4e-4 * (uniform(5, 3, k) - 0.5);
  expect("fast_command", "what the drive was asked between them is not known", Grade::kDoubt);
}

// Holds of three of the blocks that are looked at, each step in the last row of one.
TEST_F(SpoiltData, HoldsAtOddTimesAreNoInputFasterThanTheirRows) {
  constexpr std::size_t kRows = 600, kBlock = 20;  // of 0.5 s
  omnihil::Run& run = bench.dataset.runs[1];
  run.time_s.resize(kRows);
  for (auto& [name, values] : run.signals) values.resize(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    const double odd = k % kBlock == 0 ? 0.0 : 0.4 * (uniform(5, 3, k) - 0.5);
    run.time_s[k] = 0.02501 * (static_cast<double>(k) + odd);
    signal(1, "duty")[k] = uniform(5, 4, (k + 1) / (3 * kBlock)) - 0.5;
  }
  EXPECT_EQ(find(check(bench), "fast_command"), nullptr);
}

// One step in a run changes from one row to the next as far as it ever does.
TEST_F(SpoiltData, AStepAtOddTimesIsNoInputFasterThanItsRows) {
  omnihil::Run& run = bench.dataset.runs[1];
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    run.time_s[k] += 4e-4 * (uniform(5, 3, k) - 0.5);
    signal(1, "duty")[k] = run.time_s[k] < 2.0 ? 0.0 : 0.4;
  }
  EXPECT_EQ(find(check(bench), "fast_command"), nullptr);
}

TEST_F(SpoiltData, ADutyAtItsLimitMostOfTheTime) {
  for (double& v : signal(0, "duty")) v = v > 0.0 ? 1.0 : -1.0;
  expect("saturated_command", "is at full duty in", Grade::kDoubt);
}

TEST_F(SpoiltData, AVoltageThatIsCutOff) {
  omnihil::Run& run = bench.dataset.runs[1];  // the chirp
  std::vector<double> voltage = *run.signal("duty");
  for (double& v : voltage) v = std::clamp(24.0 * v, -5.0, 5.0);
  run.signals.erase("duty");
  run.signals["motor_voltage"] = voltage;
  bench.dataset.channels.push_back(*bench.dataset.channel("duty"));
  bench.dataset.channels.back().signal = "motor_voltage";
  bench.dataset.channels.back().column = "voltage";
  expect("saturated_command", "motor_voltage is cut off at 5", Grade::kDoubt);
}

TEST_F(SpoiltData, ARecordTooShortToSettle) {
  for (omnihil::Run& run : bench.dataset.runs) {
    run.time_s.resize(20);
    for (auto& [name, values] : run.signals) values.resize(20);
  }
  expect("few_rows", "has 20 rows only", Grade::kDoubt);
  expect("too_short", "too short to see a steady speed", Grade::kDoubt);
}

TEST_F(SpoiltData, AHoldoutOfAnotherKind) {
  for (double& v : signal(2, "duty")) v *= 0.1;
  expect("holdout_differs", "the holdout is another kind of motion", Grade::kNote);
}

TEST_F(SpoiltData, AFlagOfOppositeMeaning) {
  for (omnihil::Run& run : bench.dataset.runs) {
    run.signals["enable"] = std::vector<double>(run.time_s.size(), 0.0);
    std::vector<double> speed(run.time_s.size(), 0.0);
    for (std::size_t k = 1; k < speed.size(); ++k) speed[k] = 500.0 * (*run.signal("duty"))[k - 1];
    run.signals["velocity"] = speed;
  }
  for (const char* name : {"enable", "velocity"}) {
    bench.dataset.channels.push_back(bench.dataset.channels.back());
    bench.dataset.channels.back().signal = name;
    bench.dataset.channels.back().column = name;
  }
  expect("opposite_flag", "the flag has the opposite meaning");
}

TEST(CheckDataPosition, DegreesInPlaceOfRadiansAreNamed) {
  Bench bench = simulated_bench({.with = {}, .counts_per_turn = 0.0, .model = ""});
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& x = run.signals.find("position")->second;
    std::vector<double> speed(x.size(), 0.0);
    for (std::size_t k = 1; k + 1 < x.size(); ++k) speed[k] = (x[k + 1] - x[k - 1]) / 2e-3;
    for (double& v : x) v *= 180.0 / M_PI;
    run.signals["velocity"] = speed;
  }
  bench.dataset.channels.push_back(bench.dataset.channels.back());
  bench.dataset.channels.back().signal = "velocity";
  const auto findings = check(bench);
  const DataFinding* f = find(findings, "position_against_speed");
  ASSERT_NE(f, nullptr) << text_of(findings);
  EXPECT_NE(f->sentence.find("degrees for radians"), std::string::npos) << text_of(findings);
}

// A potentiometer on a converter of ten bits: the angle stands still for rows and moves on by a step of 3.5 degrees, and
// single readings are off by a step or two.
TEST(CheckDataPosition, AConverterOfFewBitsDropsNoCounts) {
  constexpr double kStep_rad = 0.0614;
  Bench bench = simulated_bench({.amplitude = 0.15, .with = {}, .counts_per_turn = 0.0, .model = ""});
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& x = run.signals.find("position")->second;
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = kStep_rad * std::round(x[k] / kStep_rad + 0.3 * gaussian(1, 2, k));
  }
  const auto findings = check(bench);
  EXPECT_EQ(count(findings, Grade::kFault), 0) << text_of(findings);
  EXPECT_EQ(find(findings, "dropped_counts"), nullptr) << text_of(findings);
  EXPECT_EQ(find(findings, "glitch"), nullptr) << text_of(findings);
}

TEST(CheckDataClosedLoop, TheControllersGainIsNamed) {
  Bench bench = simulated_bench({.drive = CommandKind::kMotorTorque,
                                 .drive_name = "motor_torque",
                                 .amplitude = 0.02,
                                 .with = {},
                                 .counts_per_turn = 0.0,
                                 .model = ""});
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double> speed(run.time_s.size()), torque(run.time_s.size());
    for (std::size_t k = 0; k < speed.size(); ++k) {
      speed[k] = 6.28 + std::sin(0.05 * static_cast<double>(k)) + 0.1 * gaussian(1, 2, k);
      torque[k] = 0.09 * (6.28 - speed[k]) + 0.002;
    }
    run.signals["velocity"] = speed;
    run.signals["motor_torque"] = torque;
    run.signals.erase("position");
  }
  bench.dataset.channels.push_back(bench.dataset.channels.back());
  bench.dataset.channels.back().signal = "velocity";
  const auto findings = check(bench);
  const DataFinding* f = find(findings, "closed_loop");
  ASSERT_NE(f, nullptr) << text_of(findings);
  EXPECT_NEAR(f->size, 0.09, 1e-6);
}

// Published recordings have their troubles, none that forbids a diagnosis.
TEST(SharedDataQuality, NoFolderHasAFault) {
  const auto data = shared_data();
  if (!data) GTEST_SKIP() << "OMNIHIL_SHARED names no folder of measurements";
  for (const auto& entry : std::filesystem::directory_iterator(*data)) {
    if (!std::filesystem::exists(entry.path() / "dataset.toml")) continue;  // raw recordings
    const DatasetReading r = read_dataset(entry.path().string());
    ASSERT_TRUE(r.dataset) << all_text(r.problems);
    const auto findings = check_data(*r.dataset, *r.nominal);
    if (std::getenv("OMNIHIL_SHOW") != nullptr)
      std::printf("== %s\n%s", entry.path().filename().c_str(), text_of(findings).c_str());
    EXPECT_EQ(count(findings, Grade::kFault), 0) << entry.path() << "\n" << text_of(findings);
  }
}

}  // namespace
}  // namespace omnihil
