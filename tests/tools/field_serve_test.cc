// `serve` with robots that differ, a carpet of one's own, a snapshot to begin from: recordings carry it all.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/hil/recording/fake_run.h"
#include "tests/tools/cli.h"

namespace omnihil {
namespace {

class FieldServe : public CliTest {
 protected:
  Ran serve(const std::string& options) {
    return run_omnihil("serve --clock free --physics planar --quiet --device" + shell(folder_ / "dongle") +
                       options);
  }
  nlohmann::json header_of(const std::string& name) {
    const std::string text = text_of(folder_ / name);
    return nlohmann::json::parse(text.substr(2, text.find('\n') - 2));
  }
  fake::TempFolder folder_;
};

TEST_F(FieldServe, RobotsOfSeveralModelsAndTheirReplay) {
  const Ran ran = serve(
      "--robots 0-2 --robot-of 1=ulaval_delta --opponents 1,2 --opponents-robot roboteam_2024 --spread 1 "
      "--ball 0.3,0 --duration 0.2 --record" +
      shell(folder_ / "a.omnirec"));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  const nlohmann::json header = header_of("a.omnirec");
  ASSERT_EQ(header["other_robots"].size(), 2u);
  EXPECT_EQ(header["other_robots"][0]["robot"], "ulaval_delta");
  EXPECT_EQ(header["other_robots"][1]["robot_ids"], nlohmann::json({33, 34}));
  const Ran again = run_omnihil("replay" + shell(folder_ / "a.omnirec"));
  EXPECT_EQ(again.exit_code, 0) << again.text;
  EXPECT_TRUE(again.says("identical")) << again.text;
}

TEST_F(FieldServe, ARobotThatIsNotThereIsNamed) {
  const Ran ran = serve("--robots 0,1 --robot-of 4=ulaval_delta --firmware-of 7=x.so --duration 0.1");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_TRUE(ran.says("--robot-of: robot 4 is not on the floor")) << ran.text;
  EXPECT_EQ(serve("--robots 0 --opponents-robot ulaval_delta --duration 0.1").exit_code, 2);
  EXPECT_EQ(serve("--robots 0 --opponents-firmware x.so --duration 0.1").exit_code, 2);
  EXPECT_TRUE(serve("--robots 0 --robot-of 0 --duration 0.1").says("allowed: IDS=MODEL"));
}

TEST_F(FieldServe, FirmwareOfSingleRobotsAndOfTheOtherTeam) {
  const Ran ran = serve(
      "--robots 0,1 --opponents 0 --firmware-of 1=reference --opponents-firmware reference "
      "--duration 0.05 --record" +
      shell(folder_ / "f.omnirec"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  const Ran bad = serve("--robots 0,1 --firmware-of 1=nowhere.so --duration 0.05");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_TRUE(bad.says("nowhere.so")) << bad.text;
  EXPECT_TRUE(
      serve("--robots 0,1 --firmware-of 7=reference --duration 0.05").says("robot 7 is not on the floor"));
}

TEST_F(FieldServe, TheCarpetIsInTheRecording) {
  const Ran ran = serve(
      "--robots 0 --ball 0,1 --carpet-sliding 0.3 --carpet-nap 0.2 --carpet-nap-deg 90 "
      "--carpet-patch 0,1,-1,1,0.5,2 --ball-lift 0.1 --duration 0.05 --record" +
      shell(folder_ / "c.omnirec"));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  const nlohmann::json field = header_of("c.omnirec")["field"];
  EXPECT_EQ(field["carpet"]["sliding"], 0.3);
  EXPECT_NEAR(field["carpet"]["nap_rad"].get<double>(), 1.5707963, 1e-6);
  EXPECT_EQ(field["carpet"]["patches"], nlohmann::json::parse("[[0.0,1.0,-1.0,1.0,0.5,2.0]]"));
  EXPECT_EQ(field["ball_lift"], 0.1);
  EXPECT_EQ(run_omnihil("replay" + shell(folder_ / "c.omnirec")).exit_code, 0);
  EXPECT_TRUE(serve("--robots 0 --carpet-patch 1,0,0,1,1,1 --duration 0.05").says("patch x 1 to 0"));
  EXPECT_TRUE(serve("--robots 0 --carpet-patch 1,0 --duration 0.05").says("allowed: X1,X2,Y1,Y2"));
}

TEST_F(FieldServe, BeginsAsASnapshotWas) {
  ASSERT_EQ(serve("--robots 0,1 --ball 1,0.5 --duration 0.5 --sample-every 1 --record" +
                  shell(folder_ / "a.omnirec"))
                .exit_code,
            0);
  const Ran kept = run_omnihil("replay --snapshot" + shell(folder_ / "a.snapshot") + "--snapshot-at 0.2" +
                               shell(folder_ / "a.omnirec"));
  ASSERT_EQ(kept.exit_code, 0) << kept.text;
  const Ran ran = serve("--robots 0,1 --duration 0.1 --from" + shell(folder_ / "a.snapshot") + "--record" +
                        shell(folder_ / "b.omnirec"));
  ASSERT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_NE(text_of(folder_ / "b.omnirec").find(" 1 0.5 0.0215 0 0 0\n"), std::string::npos)
      << "no ball where it lay";
  const Ran again = run_omnihil("replay" + shell(folder_ / "b.omnirec"));
  EXPECT_EQ(again.exit_code, 0) << again.text;
  EXPECT_TRUE(again.says("identical")) << again.text;
  const Ran other = serve("--robots 0-2 --duration 0.1 --from" + shell(folder_ / "a.snapshot"));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(other.says("snapshot is of other robots")) << other.text;
  EXPECT_TRUE(serve("--robots 0 --from" + shell(folder_ / "a.omnirec")).says("omnihil-snapshot/1"));
  EXPECT_EQ(run_omnihil("replay --snapshot" + shell(folder_ / "x.snapshot") + "--snapshot-at 9" +
                        shell(folder_ / "a.omnirec"))
                .exit_code,
            2);
}

// Everything random comes from the seed, and nothing from how many cores there are.
TEST_F(FieldServe, ARecordingReplaysToTheSameBytesOnOneCoreAndOnAll) {
  if (std::system("command -v taskset > /dev/null") != 0) GTEST_SKIP() << "needs taskset (util-linux)";
  ASSERT_EQ(serve("--robots 0-5 --opponents 0-5 --field division-b --ball 0,0 --spread 1 --air-loss 5 "
                  "--duration 1 --opponents-device" +
                  shell(folder_ / "other") + "--record" + shell(folder_ / "m.omnirec"))
                .exit_code,
            0);
  const Ran all = run_omnihil("replay --sha256" + shell(folder_ / "m.omnirec"));
  ASSERT_EQ(all.exit_code, 0) << all.text;
  const std::filesystem::path out = folder_ / "one.txt";
  EXPECT_EQ(std::system(("taskset -c 0 '" OMNIHIL_PROGRAM "' replay --sha256" + shell(folder_ / "m.omnirec") +
                         ">" + shell(out))
                            .c_str()),
            0);
  EXPECT_EQ(text_of(out), all.text);
}

}  // namespace
}  // namespace omnihil
