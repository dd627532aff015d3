// Recordings as regression tests: what is said of an unchanged firmware, of planted changes, and of another robot.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "hil/check/check_history.h"
#include "hil/check/check_page.h"
#include "hil/check/check_recording.h"
#include "hil/check/check_report.h"
#include "hil/check/compare_versions.h"
#include "hil/check/console_difference.h"
#include "hil/check/firmware_alone.h"
#include "hil/check/law_difference.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/effect_overrides.h"
#include "hil/loop/reference_firmware.h"
#include "hil/text/json_text.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

const std::string kReference = OMNIHIL_BUILD_DIR "/firmware_iface/libomnihil_reference_firmware.so";
std::string planted(const std::string& name) {
  return std::string(OMNIHIL_BUILD_DIR "/tests/firmware/lib") + name + ".so";
}

ReplayOptions with_firmware(const std::string& file) {
  const FirmwareChoice choice{.file = file};
  ReplayOptions options;
  options.firmware_files = firmware_files(choice);
  options.firmware = [choice](const SessionConfig& config) { return open_firmware(choice, config); };
  return options;
}

// Driven for 0.4 s, then the host says no more: made with the team's own library.
Recording driven_then_silent(int sample_every = 1) {
  const SessionSetup setup = real::setup(real::kHermes);
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = sample_every;
  header.firmware_files = firmware_files({.file = kReference});
  const SessionConfig config = session_config(setup);
  Session session(config, open_firmware({.file = kReference}, config));
  header.firmware = session.firmware(0).name();
  RecordingMemory memory(header);
  session.set_observer(&memory);
  const RadioFormat& format = *find_radio_format(setup.radio_format);
  std::vector<std::uint8_t> out;
  for (int n = 0; n < 900; ++n)
    session.step(n < 400 ? real::host_bytes(format, setup.robot_ids, n) : real::Bytes{}, out);
  return memory.take(session.now_ns());
}

CheckOutcome check(const Recording& recording, const ReplayOptions& options, std::size_t charts = 0) {
  CheckOptions all;
  all.replay = options;
  all.charts = charts;
  return check_recording("drive.omnirec", recording, *find_radio_format(recording.header.radio_format), all);
}

std::string all_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

class CheckOfAFirmware : public testing::Test {
 protected:
  static void SetUpTestSuite() { recording_ = new Recording(driven_then_silent()); }
  static void TearDownTestSuite() { delete recording_; }
  static Recording* recording_;
};
Recording* CheckOfAFirmware::recording_ = nullptr;

TEST_F(CheckOfAFirmware, HashesOfItsFilesSurviveTheHeader) {
  std::vector<std::string> problems;
  const auto read = parse_recording_header(to_json(recording_->header), problems);
  ASSERT_TRUE(read) << all_of(problems);
  EXPECT_EQ(read->firmware_files, recording_->header.firmware_files);
  EXPECT_EQ(read->firmware_files.at(0).name, "libomnihil_reference_firmware.so");
  EXPECT_EQ(read->firmware_files.at(0).sha256.size(), 64U);
}

TEST_F(CheckOfAFirmware, AnUnchangedOneAgreesEveryTime) {
  for (int i = 0; i < 20; ++i) {
    const CheckOutcome outcome = check(*recording_, with_firmware(kReference));
    EXPECT_TRUE(outcome.passed()) << check_text(outcome, true);
    EXPECT_TRUE(outcome.comparison.bytes_identical && outcome.comparison.samples_identical);
    EXPECT_TRUE(outcome.changed.empty()) << all_of(outcome.changed);
  }
}

TEST_F(CheckOfAFirmware, ItsOwnIsAskedForAndTheReferenceIsTakenWhereNamed) {
  EXPECT_NE(firmware_missing(recording_->header, {}).find("libomnihil_reference_firmware.so"),
            std::string::npos);
  EXPECT_EQ(firmware_missing(recording_->header, with_firmware("reference")), "");
  const CheckOutcome outcome = check(*recording_, with_firmware("reference"));
  EXPECT_TRUE(outcome.passed());  // the same code in this process
  EXPECT_EQ(outcome.changed.at(0), "the reference firmware instead of libomnihil_reference_firmware.so");
}

TEST_F(CheckOfAFirmware, ASignErrorIsNamedWithItsWheel) {
  const CheckOutcome outcome = check(*recording_, with_firmware(planted("sign_error")));
  EXPECT_FALSE(outcome.passed());
  ASSERT_TRUE(outcome.drive);
  EXPECT_EQ(outcome.drive->wheel, 2);
  EXPECT_NEAR(outcome.drive->ratio[2], -1.0, 1e-6);
  EXPECT_NEAR(outcome.drive->ratio[3], 1.0, 1e-6);
  EXPECT_NE(outcome.drive->text().find(": a sign"), std::string::npos) << outcome.drive->text();
  EXPECT_NE(all_of(outcome.cause).find("the firmware answers"), std::string::npos);
}

TEST_F(CheckOfAFirmware, AGainChangedByFivePercentIsNamedAndItsSizeFound) {
  const CheckOutcome outcome = check(*recording_, with_firmware(planted("gain_five_percent")));
  EXPECT_FALSE(outcome.passed());
  const std::string cause = all_of(outcome.cause);
  for (const char* wheel : {"robot 0, wheel 1", "robot 0, wheel 4", "robot 3, wheel 2"})
    EXPECT_NE(cause.find(wheel), std::string::npos) << cause;
  EXPECT_NE(cause.find("a P gain"), std::string::npos) << cause;
  EXPECT_EQ(cause.find("an I gain"), std::string::npos) << cause;
  // The slope is 5 % of the gain that the firmware says it has: V s/rad at the rotor, seen at the wheel.
  const SessionConfig config = session_config(session_setup(recording_->header));
  const Session session(config, reference_firmware_for(config));
  const double p_rotor = session.firmware(0).gains().p[OMNIHIL_LOOPS - 1];
  const FirmwareAlone alone = run_firmware_alone(*recording_, with_firmware(planted("gain_five_percent")));
  const auto law = law_difference(*recording_, alone.answer, 0, 0);
  ASSERT_TRUE(law);
  EXPECT_GT(law->r_squared, 0.99);
  EXPECT_GT(p_rotor, 0.0);
  EXPECT_NEAR(law->slope, 0.05 * p_rotor * config.robots[0].gear_ratio,
              0.05 * 0.05 * p_rotor * config.robots[0].gear_ratio);
}

TEST_F(CheckOfAFirmware, ALostTimeOutIsNamed) {
  const CheckOutcome outcome = check(*recording_, with_firmware(planted("no_timeout")));
  EXPECT_FALSE(outcome.passed());
  ASSERT_TRUE(outcome.drive);
  EXPECT_GT(outcome.drive->host_silent_s, 0.2);
  EXPECT_NE(outcome.drive->text().find("a time-out"), std::string::npos) << outcome.drive->text();
}

TEST_F(CheckOfAFirmware, AnotherRobotIsNotTheFirmwaresDoing) {
  ReplayOptions options = with_firmware(kReference);
  options.model = session_setup(recording_->header).model;
  std::vector<std::string> faults;
  add_effects(*options.model, {"floor_tilt"}, faults);
  ASSERT_TRUE(faults.empty()) << all_of(faults);
  const CheckOutcome outcome = check(*recording_, options);
  EXPECT_FALSE(outcome.passed());
  EXPECT_FALSE(outcome.drive) << outcome.drive->text();
  EXPECT_NE(all_of(outcome.cause).find("the robot differs"), std::string::npos) << all_of(outcome.cause);
  EXPECT_NE(all_of(outcome.changed).find("another text than recorded"), std::string::npos);
}

// The reference firmware is configured by the model: with another motor it computes other duties, which is no change of
// its code.
TEST_F(CheckOfAFirmware, ToldOfAnotherRobotIsSaidSo) {
  ReplayOptions options = with_firmware(kReference);
  options.model = real::setup(real::kRem).model;
  const CheckOutcome outcome = check(*recording_, options);
  EXPECT_FALSE(outcome.passed());
  EXPECT_NE(all_of(outcome.cause).find("told of another robot"), std::string::npos) << all_of(outcome.cause);
  EXPECT_EQ(all_of(outcome.cause).find("gain"), std::string::npos) << all_of(outcome.cause);
}

TEST_F(CheckOfAFirmware, ThatCrashesHasNoVerdict) {
  const CheckOutcome outcome = check(*recording_, with_firmware(planted("abort")));
  EXPECT_EQ(outcome.fault, CheckFault::kFirmware);
  EXPECT_NE(outcome.fault_text.find("robot 0: firmware "), std::string::npos) << outcome.fault_text;
}

TEST_F(CheckOfAFirmware, TwoBuildsStandSideBySide) {
  const RadioFormat& format = *find_radio_format(recording_->header.radio_format);
  const VersionsComparison both = compare_versions(*recording_, format, with_firmware(kReference),
                                                   with_firmware(planted("sign_error")), {});
  ASSERT_TRUE(both.first);
  const auto duty = std::ranges::find(both.rows, "duty_ratio", &VersionRow::signal);
  ASSERT_NE(duty, both.rows.end());
  EXPECT_EQ(duty->a_rms, 0.0);
  EXPECT_GT(duty->b_rms, 0.01);
  EXPECT_NEAR(duty->b_rms, duty->between_rms, 1e-12);
  EXPECT_NE(versions_table(both).find("duty_ratio "), std::string::npos);
}

TEST_F(CheckOfAFirmware, ReportsNameRecordingAndFirstDifference) {
  const std::vector<CheckOutcome> outcomes{
      check(*recording_, with_firmware(kReference)),
      check(*recording_, with_firmware(planted("sign_error")), kPageCharts)};
  const std::string junit = check_junit(outcomes);
  EXPECT_NE(junit.find("tests=\"2\" failures=\"1\" errors=\"0\""), std::string::npos) << junit;
  EXPECT_NE(junit.find("<failure message=\"differs first at "), std::string::npos) << junit;
  const auto json = json_of(check_json(outcomes, "omnihil abc"));
  EXPECT_EQ(json["recordings"].size(), 2U);
  EXPECT_EQ(json["recordings"][0]["verdict"], "agrees");
  EXPECT_EQ(json["recordings"][1]["verdict"], "differs");
  EXPECT_NE(check_markdown(outcomes).find("| **differs** |"), std::string::npos);
  EXPECT_NE(check_summary(outcomes).find("2 recordings: 1 agree, 1 differ, 0 without"), std::string::npos);
  ASSERT_FALSE(outcomes[1].charts.empty());
  const std::string page = check_page(outcomes, {}, "omnihil <abc>");
  EXPECT_NE(page.find("<polyline"), std::string::npos);
  EXPECT_NE(page.find("omnihil &lt;abc&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST(FirmwareAlone, SaysWhatItNeeds) {
  const Recording thinned = driven_then_silent(5);
  EXPECT_NE(run_firmware_alone(thinned, {}).why_not.find("--sample-every 1"), std::string::npos);
  const CheckOutcome outcome = check(thinned, with_firmware(planted("sign_error")));
  EXPECT_NE(all_of(outcome.cause).find("not told apart"), std::string::npos) << all_of(outcome.cause);
}

TEST(CheckWithoutSamples, ComparesPacketsAlone) {
  Recording recording = real::record(real::setup(real::kHermes), 300);
  std::erase_if(recording.chunks,
                [](const auto& chunk) { return chunk.kind == RecordedChunk::Kind::kSample; });
  const CheckOutcome same = check(recording, {});
  EXPECT_TRUE(same.passed()) << check_text(same, true);
  EXPECT_EQ(same.comparison.samples, 0U);
  EXPECT_GT(same.comparison.packets, 10U);
}

TEST(CheckHistory, KeepsWhatItUnderstandsAndCountsTheRest) {
  CheckOutcome outcome;
  outcome.file = "a \"b\".omnirec";
  SignalSummary signal;
  signal.name = "x";
  signal.tolerance = 0.5;
  signal.largest = 0.25;
  outcome.comparison.signals.push_back(signal);
  fake::TempFolder folder;
  const std::string path = folder / "history.jsonl";
  EXPECT_TRUE(load_history(path).runs.empty());
  append_history(path, std::span(&outcome, 1), "c1", "2026-01-01");
  fake::write_text(path, fake::read_text(path) + "not json\n{\"label\":1}\n");
  append_history(path, std::span(&outcome, 1), "c2", "2026-01-02");
  const CheckHistory history = load_history(path);
  EXPECT_EQ(history.lines_not_understood, 2U);
  const auto runs = history.runs_of(outcome.file);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1].label, "c2");
  EXPECT_EQ(runs[1].signal, "x");
  EXPECT_DOUBLE_EQ(runs[1].over_tolerance, 0.5);
  EXPECT_NE(check_page(std::span(&outcome, 1), history, "p").find("run by run"), std::string::npos);
}

Recording recorded_console(std::vector<std::string> texts) {
  Recording recording;
  for (const std::string& text : texts) {
    RecordedChunk chunk;
    chunk.kind = RecordedChunk::Kind::kConsole;
    chunk.now_ns = 5'000'000;
    chunk.robot_id = 1;
    chunk.port = "RTT";
    chunk.text = text;
    recording.chunks.push_back(chunk);
  }
  return recording;
}

TEST(ConsoleDifference, NamesTheFirstLineThatIsAnotherThanRecorded) {
  const std::vector<ConsoleLine> now{{1'000'000, 1, 0, "RTT", "boot"}, {8'000'000, 1, 0, "RTT", "stall"}};
  EXPECT_EQ(console_difference(recorded_console({"boot", "stall"}), now), "");
  EXPECT_EQ(console_difference(recorded_console({}), now), "") << "recorded without a console";
  EXPECT_EQ(console_difference(recorded_console({"boot", "ready"}), now),
            "robot 1 RTT, line 2: \"stall\" at 0.008 s, recorded \"ready\" at 0.005 s");
  EXPECT_EQ(console_difference(recorded_console({"boot"}), now),
            "robot 1 RTT, line 2: \"stall\" at 0.008 s, recorded nothing");
  EXPECT_EQ(console_difference(recorded_console({"boot", "stall", "end"}), now),
            "robot 1 RTT, line 3: nothing, recorded \"end\" at 0.005 s");
}

TEST(CheckReport, TheConsoleStandsInEveryReport) {
  CheckOutcome o;
  o.file = "a.omnirec";
  o.fault = CheckFault::kFirmware;
  o.console = {{8'000'000, 1, 0, "RTT", "stall"}};
  o.console_difference = "robot 1 RTT, line 2";
  EXPECT_NE(
      check_text(o, false).find("said       0.008 s robot 1 RTT | stall\nconsole    robot 1 RTT, line 2\n"),
      std::string::npos);
  EXPECT_NE(check_junit({{o}}).find("said: 0.008 s robot 1 RTT | stall"), std::string::npos);
  const std::string json = check_json({{o}}, "p");
  EXPECT_NE(json.find("\"text\":\"stall\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"console_difference\":\"robot 1 RTT, line 2\""), std::string::npos) << json;
}

}  // namespace
}  // namespace omnihil
