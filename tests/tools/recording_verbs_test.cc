// replay, check and convert as a user runs them: what they say and with which exit code they end.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <thread>

#include "tests/hil/recording/real_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

// What the program calls itself: "0.1.0 (COMMIT)".
std::string program_commit() {
  const std::string text = run_omnihil("--version").text;
  const std::size_t open = text.find('(');
  return text.substr(open + 1, text.find(')') - open - 1);
}

class RecordingVerbs : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    if (IsSkipped()) return;
    text_ = sound();
    fake::write_text(path_, text_);
  }
  static const std::string& sound() {
    static const std::string text = [] {
      Recording recorded = real::record(real::setup(real::kHermes), 120);
      recorded.header.commit = program_commit();
      return real::text_of(recorded);
    }();
    return text;
  }
  // Line n (from 1) of the recording replaced, and written.
  void plant(std::size_t at, const std::string& from, const std::string& to) {
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(text_.substr(at, from.size()), from);
    text_.replace(at, from.size(), to);
    fake::write_text(path_, text_);
  }
  std::string recording() const { return shell(path_); }
  // Every verb that reads a recording, without its name.
  std::vector<std::string> reading_verbs() const {
    return {"replay", "check", "convert --to csv --out" + shell(folder_ / "out")};
  }

  fake::TempFolder folder_;
  std::filesystem::path path_ = folder_ / "run.omnirec";
  std::string text_;
};

TEST_F(RecordingVerbs, ReplaySaysThatTheBytesAreIdentical) {
  const Ran ran = run_omnihil("replay" + recording());
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("bytes      identical: ")) << ran.text;
  const Ran hash = run_omnihil("replay --sha256" + recording());
  EXPECT_EQ(hash.exit_code, 0);
  EXPECT_EQ(hash.text.size(), 65U) << hash.text;
  EXPECT_TRUE(ran.says(hash.text.substr(0, 64))) << ran.text;
}

TEST_F(RecordingVerbs, ReplaySaysThatTheBytesDiffer) {
  plant(text_.find("\n< ") + 3, text_.substr(text_.find("\n< ") + 3, 1), "");  // an earlier time
  const Ran ran = run_omnihil("replay" + recording());
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("bytes      differ: ")) << ran.text;
}

TEST_F(RecordingVerbs, ReplayWritesARecordingThatReplaysToTheSame) {
  const auto again = folder_ / "again.omnirec";
  EXPECT_EQ(run_omnihil("replay" + recording() + "--out" + shell(again)).exit_code, 0);
  EXPECT_EQ(run_omnihil("replay --sha256" + shell(again)).text,
            run_omnihil("replay --sha256" + recording()).text);
  const Ran onto_itself = run_omnihil("replay" + recording() + "--out" + recording());
  EXPECT_EQ(onto_itself.exit_code, 2) << onto_itself.text;
  EXPECT_EQ(fake::read_text(path_), text_);
}

TEST_F(RecordingVerbs, CheckAgrees) {
  const Ran ran = run_omnihil("check" + recording());
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  const bool knows_its_commit = program_commit() != "unknown";  // built from a folder without git
  EXPECT_EQ(ran.says("exact: recorded by this same commit"), knows_its_commit) << ran.text;
  EXPECT_TRUE(ran.says("\nagrees\n")) << ran.text;
  EXPECT_TRUE(ran.says("true_slip_longitudinal_ratio ")) << ran.text;
}

TEST_F(RecordingVerbs, CheckNamesAPlantedDigit) {
  // The last digit of the last value of the last sample.
  const std::size_t end = text_.rfind("\n# {\"end\"");
  const char digit = text_[end - 1];
  plant(end - 1, std::string(1, digit), std::string(1, digit == '5' ? '6' : '5'));
  const Ran ran = run_omnihil("check --exact" + recording());
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("differs    first at 0.115000 s, robot 3: true_load_N_4: recorded ")) << ran.text;
  EXPECT_EQ(run_omnihil("check --tolerance default" + recording()).exit_code, 0);
}

TEST_F(RecordingVerbs, CheckNamesAPlantedBitOfThePackets) {
  const std::size_t line = text_.find("\n< ") + 1;
  const std::size_t last = text_.find('\n', line) - 3;  // of the byte before the delimiter
  const char digit = text_[last];
  plant(last, std::string(1, digit), std::string(1, digit == '1' ? '3' : '1'));
  for (const char* how : {"check --exact", "check --tolerance default"}) {
    const Ran ran = run_omnihil(how + recording());
    EXPECT_EQ(ran.exit_code, 1) << ran.text;
    EXPECT_TRUE(ran.says("BATTERIE_RESPONSE")) << ran.text;
    EXPECT_TRUE(ran.says("refused (checksum)")) << ran.text;
  }
}

TEST_F(RecordingVerbs, CheckTakesSettingsAndFilesOfSettings) {
  const std::size_t end = text_.rfind("\n# {\"end\"");
  const std::size_t value = text_.rfind(' ', end) + 1;
  plant(value, text_.substr(value, end - value), "99");  // true_load_N_4
  fake::write_text(folder_ / "loose.txt", "# wheel loads are of no interest\ntrue_load_N_4 = 1000\n");
  EXPECT_EQ(run_omnihil("check --quiet --tolerance default" + recording()).exit_code, 1);
  EXPECT_EQ(run_omnihil("check --quiet --tolerance unit:N=1000" + recording()).exit_code, 0);
  EXPECT_EQ(run_omnihil("check --quiet --tolerance" + shell(folder_ / "loose.txt") + recording()).exit_code,
            0);
  const Ran unknown = run_omnihil("check --tolerance true_load_M=1" + recording());
  EXPECT_EQ(unknown.exit_code, 2) << unknown.text;
  EXPECT_TRUE(unknown.says("did you mean 'true_load_N'?")) << unknown.text;
  EXPECT_EQ(run_omnihil("check --tolerance /nonexistent/t" + recording()).exit_code, 3);
  EXPECT_EQ(run_omnihil("check --exact --tolerance default" + recording()).exit_code, 2);
}

TEST_F(RecordingVerbs, CheckOfACutRunSaysSo) {
  text_.resize(text_.size() * 3 / 4);
  fake::write_text(path_, text_);
  const Ran ran = run_omnihil("check --quiet" + recording());
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("the run was cut off")) << ran.text;
  EXPECT_TRUE(ran.says("last line is incomplete")) << ran.text;
}

TEST_F(RecordingVerbs, CheckOfAFolderGivesEachItsVerdictAndAllReports) {
  const auto all = folder_ / "recordings";
  std::filesystem::create_directories(all / "old");
  fake::write_text(all / "a.omnirec", text_);
  std::string changed = text_;
  const std::size_t value = changed.rfind(' ', changed.rfind("\n# {\"end\"")) + 1;
  changed.replace(value, changed.find('\n', value) - value, "99");  // true_load_N_4
  fake::write_text(all / "old" / "b.omnirec", changed);
  fake::write_text(all / "c.omnirec", "no recording\n");
  fake::write_text(all / "notes.txt", "of no concern\n");
  const auto junit = folder_ / "junit.xml", json = folder_ / "check.json", html = folder_ / "check.html",
             summary = folder_ / "summary.md", history = folder_ / "history.jsonl";
  const std::string reports = "--junit" + shell(junit) + "--json" + shell(json) + "--html" + shell(html) +
                              "--summary" + shell(summary) + "--history" + shell(history) + "--label c1";
  const Ran ran = run_omnihil("check " + reports + shell(all));
  EXPECT_EQ(ran.exit_code, 2) << ran.text;  // the greatest
  EXPECT_TRUE(ran.says("3 recordings: 1 agree, 1 differ, 1 without a verdict")) << ran.text;
  EXPECT_TRUE(ran.says("a.omnirec: 0.120 s")) << ran.text;
  EXPECT_NE(fake::read_text(junit).find("tests=\"3\" failures=\"1\" errors=\"1\""), std::string::npos);
  EXPECT_NE(fake::read_text(json).find("\"verdict\":\"unusable\""), std::string::npos);
  EXPECT_NE(fake::read_text(summary).find("**differs**"), std::string::npos);
  EXPECT_NE(fake::read_text(html).find("true_load_N_4"), std::string::npos);
  EXPECT_EQ(run_omnihil("check " + reports + shell(all)).exit_code, 2);
  EXPECT_EQ(std::ranges::count(fake::read_text(history), '\n'), 6);
  EXPECT_NE(fake::read_text(html).find("run by run"), std::string::npos);
  const Ran nowhere =
      run_omnihil("check --junit" + shell(all / "a.omnirec" / "junit.xml") + shell(all / "old"));
  EXPECT_EQ(nowhere.exit_code, 3) << nowhere.text;
  std::filesystem::create_directories(folder_ / "none");
  EXPECT_EQ(run_omnihil("check" + shell(folder_ / "none")).exit_code, 2);
}

TEST_F(RecordingVerbs, CheckAndReplayTakeAnotherModelAndSeed) {
  const Ran heavier = run_omnihil("check --quiet --with floor_tilt" + recording());
  EXPECT_EQ(heavier.exit_code, 1) << heavier.text;
  EXPECT_TRUE(heavier.says("changed    robot ulaval_delta: another text than recorded")) << heavier.text;
  const Ran seeded = run_omnihil("check --quiet --seed 7" + recording());
  EXPECT_TRUE(seeded.says("changed    seed 7 instead of 0")) << seeded.text;
  EXPECT_EQ(run_omnihil("replay --with floor_tilt" + recording()).exit_code, 0);
  const Ran unknown = run_omnihil("check --robot no_such_robot" + recording());
  EXPECT_EQ(unknown.exit_code, 2) << unknown.text;
  const Ran both = run_omnihil("check --versus-with floor_tilt" + recording());
  EXPECT_EQ(both.exit_code, 0) << both.text;
  EXPECT_TRUE(both.says("A to B, RMS")) << both.text;
}

TEST_F(RecordingVerbs, DumpPrintsPacketsOfBothWaysAndOnlyThoseAskedFor) {
  const Ran all = run_omnihil("dump" + recording());
  EXPECT_EQ(all.exit_code, 0) << all.text;
  EXPECT_TRUE(all.says("> {\"packet\":\"SPEED_MOVE_ADVANCE\"")) << all.text;
  EXPECT_TRUE(all.says("< {\"packet\":\"BATTERIE_RESPONSE\"")) << all.text;
  EXPECT_TRUE(all.says("refused (")) << all.text;  // the host sent damage too
  const Ran one = run_omnihil("dump --robot 3 --packet BATTERIE_RESPONSE --from 0.02 --hex" + recording());
  EXPECT_FALSE(one.says("\"robot\":0")) << one.text;
  EXPECT_FALSE(one.says("SPEED_MOVE_ADVANCE")) << one.text;
  EXPECT_TRUE(one.says("\"robot\":3")) << one.text;
  EXPECT_EQ(run_omnihil("dump --packet NO_SUCH" + recording()).exit_code, 2);
}

TEST_F(RecordingVerbs, ConvertMakesCapturesOnce) {
  for (const std::string kind : {"pcap", "mcap"}) {
    const auto out = folder_ / ("run." + kind);
    const Ran ran = run_omnihil("convert --to " + kind + " --out" + shell(out) + recording());
    EXPECT_EQ(ran.exit_code, 0) << ran.text;
    EXPECT_GT(std::filesystem::file_size(out), 1000U);
    EXPECT_EQ(run_omnihil("convert --to " + kind + " --out" + shell(out) + recording()).exit_code, 2);
  }
}

// A log of both ways, in Unix time: the model that was recorded agrees with it, another one does not.
TEST_F(RecordingVerbs, ImportMakesARecordingOfALog) {
  const Recording recorded = real::record(real::setup(real::kRem), 600);
  std::string log = "# heard on the field\n";
  for (const RecordedChunk& chunk : recorded.chunks) {
    if (chunk.bytes.empty()) continue;
    const bool host = chunk.kind == RecordedChunk::Kind::kHostBytes;
    const auto hex = to_hex(chunk.bytes);
    std::string time = std::to_string(1'700'000'000'000'000'000 + chunk.now_ns);
    log += time.insert(time.size() - 9, ".") + (host ? " > " : " < ") + hex + "\n";
  }
  fake::write_text(folder_ / "field.txt", log);
  const auto out = folder_ / "field.omnirec";
  const std::string import =
      "import" + shell(folder_ / "field.txt") + "--robot roboteam_2024 --robots 0,3 --out" + shell(out);
  const Ran ran = run_omnihil(import);
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_EQ(run_omnihil(import).exit_code, 2);  // never overwritten
  const Ran same = run_omnihil("check --quiet --physics planar" + shell(out));
  EXPECT_TRUE(same.says("samples not recorded")) << same.text;
  EXPECT_TRUE(same.says("compared ")) << same.text;
  const Ran dumped = run_omnihil("dump" + shell(out));
  EXPECT_TRUE(dumped.says("REM_RobotFeedback")) << dumped.text;
  fake::write_text(folder_ / "bad.txt", "1.0 > 0f\n0.5 < 00\n2 = 11\n3 > 0\nx > 11\n");
  const Ran bad = run_omnihil("import" + shell(folder_ / "bad.txt") + "--robot roboteam_2024 --out" +
                              shell(folder_ / "b.omnirec"));
  EXPECT_EQ(bad.exit_code, 2);
  for (const char* place : {"bad.txt:2: time", "bad.txt:3: line", "bad.txt:4: bytes", "bad.txt:5: time"})
    EXPECT_TRUE(bad.says(place)) << bad.text;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.omnirec"));
}

TEST_F(RecordingVerbs, CheckOfNothingIsNoAgreement) {
  text_.resize(text_.find('\n') + 1);
  fake::write_text(path_, text_);
  const Ran ran = run_omnihil("check" + recording());
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("nothing to compare")) << ran.text;
}

TEST_F(RecordingVerbs, BrokenRecordingEndsWithTwoAndItsPlace) {
  plant(text_.find("\n> ") + 1, ">", "?");
  for (const std::string& verb : reading_verbs()) {
    const Ran ran = run_omnihil(verb + recording());
    EXPECT_EQ(ran.exit_code, 2) << ran.text;
    EXPECT_TRUE(ran.says("run.omnirec:2: line tag: found '?', allowed: '>', '<', '}',")) << ran.text;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(RecordingVerbs, MissingFileEndsWithThree) {
  for (const std::string& verb : reading_verbs()) {
    const Ran ran = run_omnihil(verb + " /nonexistent/run.omnirec");
    EXPECT_EQ(ran.exit_code, 3) << ran.text;
    EXPECT_TRUE(ran.says("/nonexistent/run.omnirec")) << ran.text;
  }
}

TEST_F(RecordingVerbs, UnusableArgumentsEndWithTwo) {
  for (const char* arguments : {"check", "replay", "convert", "play", "check --physics jelly x",
                                "convert --to video --out x y", "replay --no-such-flag x"}) {
    EXPECT_EQ(run_omnihil(arguments).exit_code, 2) << arguments;
  }
}

TEST_F(RecordingVerbs, HelpListsTolerancesAndExitCodes) {
  const Ran ran = run_omnihil("check --help");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_TRUE(ran.says("unit:rad/s 0.05")) << ran.text;
  EXPECT_TRUE(ran.says("1 differs")) << ran.text;
}

TEST_F(RecordingVerbs, ConvertMakesADatasetOnceAndNeverOverwrites) {
  const auto out = folder_ / "made/dataset";
  const Ran ran = run_omnihil("convert --to dataset --out" + shell(out) + recording());
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_TRUE(ran.says("every 5th tick was recorded")) << ran.text;
  for (const char* name : {"dataset.toml", "model.toml", "robot_0.csv", "robot_3.csv"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
  const std::string before = fake::read_text(out / "robot_0.csv");
  const Ran again = run_omnihil("convert --to dataset --robot 0 --out" + shell(out) + recording());
  EXPECT_EQ(again.exit_code, 2) << again.text;
  EXPECT_EQ(fake::read_text(out / "robot_0.csv"), before);
  // Nothing half written beside it.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "made"), {}), 1);
}

TEST_F(RecordingVerbs, ConvertRefusesWhatItCannotDo) {
  const Ran robot = run_omnihil("convert --to csv --robot 7 --out" + shell(folder_ / "x") + recording());
  EXPECT_EQ(robot.exit_code, 2) << robot.text;
  EXPECT_TRUE(robot.says("allowed: 0, 3")) << robot.text;
  EXPECT_EQ(run_omnihil("convert --to csv --out /proc/nowhere/x" + recording()).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x"));
}

TEST_F(RecordingVerbs, ConvertedStreamIsTheHostsBytes) {
  const auto out = folder_ / "host.txt";
  EXPECT_EQ(run_omnihil("convert --to stream --out" + shell(out) + recording()).exit_code, 0);
  const std::string text = fake::read_text(out);
  EXPECT_NE(text.find("\n0 "), std::string::npos) << text;
  EXPECT_NE(text.find("\n0.033 11220033\n"), std::string::npos) << text;
}

TEST_F(RecordingVerbs, PlayNamesWhatIsWrong) {
  const auto stream = folder_ / "host.txt";
  fake::write_text(stream, "0 0300\n");
  const auto device = folder_ / "dongle";
  const Ran nothing = run_omnihil("play" + shell(stream) + "--device" + shell(device));
  EXPECT_EQ(nothing.exit_code, 3) << nothing.text;
  EXPECT_TRUE(nothing.says(device.string())) << nothing.text;
  EXPECT_EQ(run_omnihil("play" + shell(stream) + "--device" + shell(stream)).exit_code, 3);
  EXPECT_EQ(run_omnihil("play /nonexistent/s --device" + shell(device)).exit_code, 3);
  const Ran radio = run_omnihil("play" + shell(stream) + "--radio smoke --device" + shell(device));
  EXPECT_EQ(radio.exit_code, 2) << radio.text;
  EXPECT_TRUE(radio.says("ulaval-hermes")) << radio.text;
  const Ran wire = run_omnihil("play" + shell(stream) + "--device serail:/dev/ttyACM0");
  EXPECT_EQ(wire.exit_code, 2) << wire.text;
  EXPECT_TRUE(wire.says("did you mean serial?")) << wire.text;
  fake::write_text(stream, "0 xx\n");
  EXPECT_EQ(run_omnihil("play" + shell(stream) + "--device" + shell(device)).exit_code, 2);
}

TEST_F(RecordingVerbs, ServeRecordsWhatPlayPlaysAndCheckAgrees) {
  const auto stream = folder_ / "host.txt";
  const auto made = folder_ / "served.omnirec";
  const auto device = folder_ / "dongle";
  ASSERT_EQ(run_omnihil("convert --to stream --out" + shell(stream) + recording()).exit_code, 0);
  Ran serve;
  std::thread bench([&] {
    serve =
        run_omnihil("serve --quiet --robot ulaval_delta --robots 0,3 --physics planar --duration 3 --device" +
                    shell(device) + "--record" + shell(made));
  });
  const Ran play =
      run_omnihil("play --wait --linger 0.2 --radio ulaval-hermes --device" + shell(device) + shell(stream));
  bench.join();
  EXPECT_EQ(play.exit_code, 0) << play.text;
  EXPECT_EQ(serve.exit_code, 0) << serve.text;
  const Ran check = run_omnihil("check" + shell(made));
  EXPECT_EQ(check.exit_code, 0) << check.text;
  EXPECT_TRUE(check.says("bytes identical, samples identical")) << check.text;
}

// A team's own format from its file, through the device and back: the stick's bytes are those of `encode`.
TEST_F(RecordingVerbs, ServeWithAFormatFromAFileDrivesAndItsRecordingReplays) {
  const auto stream = folder_ / "host.txt";
  const auto made = folder_ / "served.omnirec";
  const auto device = folder_ / "dongle";
  const std::string format = "--format" + shell(OMNIHIL_SOURCE_DIR "/examples/radio/our_team.toml");
  const auto json = folder_ / "line.json";
  fake::write_text(json, "{\"robot\": 3, \"forward\": 0.5}\n");
  const Ran hex = run_omnihil("encode " + format + "MOVE <" + shell(json));
  ASSERT_EQ(hex.exit_code, 0) << hex.text;
  std::string lines;
  for (int i = 1; i <= 20; ++i) lines += std::to_string(0.02 * i) + " " + hex.text;
  fake::write_text(stream, lines);
  Ran serve;
  std::thread bench([&] {
    serve = run_omnihil("serve --quiet --robots 3 --physics planar --duration 2 " + format + "--device" +
                        shell(device) + "--record" + shell(made));
  });
  const Ran play = run_omnihil("play --wait --linger 0.2 --device" + shell(device) + shell(stream));
  bench.join();
  EXPECT_EQ(play.exit_code, 0) << play.text;
  EXPECT_EQ(serve.exit_code, 0) << serve.text;
  const Ran check = run_omnihil("check " + format + shell(made));
  EXPECT_EQ(check.exit_code, 0) << check.text;
  EXPECT_TRUE(check.says("bytes identical, samples identical")) << check.text;
  EXPECT_EQ(run_omnihil("replay " + format + shell(made)).exit_code, 0);
  const Ran without = run_omnihil("replay" + shell(made));
  EXPECT_EQ(without.exit_code, 2) << without.text;
  EXPECT_TRUE(without.says("our-team")) << without.text;
}

// A hundred runs of the program have one hash: half of them idle, half with both cores busy. The busy loops
// end with the runs.
TEST_F(RecordingVerbs, SlowHundredReplaysHaveOneHashIdleAndBusy) {
  const std::string first = run_omnihil("replay --sha256" + recording()).text;
  ASSERT_EQ(first.size(), 65U) << first;
  for (const bool busy : {false, true}) {
    std::atomic<bool> stop{!busy};
    std::vector<std::thread> loops;
    for (int i = 0; i < 2; ++i) {
      loops.emplace_back([&stop] {
        for (volatile double x = 1.0; !stop;) x = x * 1.0000001;
      });
    }
    int same = 0;
    for (int n = 0; n < 50; ++n) same += run_omnihil("replay --sha256" + recording()).text == first ? 1 : 0;
    stop = true;
    for (std::thread& loop : loops) loop.join();
    EXPECT_EQ(same, 50) << (busy ? "busy" : "idle");
  }
}

}  // namespace
}  // namespace omnihil
