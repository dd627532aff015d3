// `omnihil import` of logs of numbers: from every format a dataset that the model of the simulated drive fits.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

class ImportVerb : public CliTest {
 protected:
  static void SetUpTestSuite() {
    logs_ = fs::temp_directory_path() / ("omnihil-import-verb-" + std::to_string(::getpid()));
    fs::remove_all(logs_);
    const std::string command =
        "/usr/bin/python3 '" OMNIHIL_SOURCE_DIR "/tests/hil/logs/make_logs.py' '" + logs_.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  static void TearDownTestSuite() { fs::remove_all(logs_); }

  Ran import(const std::string& log, const std::string& more = "") const {
    fs::remove_all(out());
    return run_omnihil("import" + shell(logs_ / log) + "--model" + shell(logs_ / "model.toml") + "--out" +
                       shell(out()) + more + " </dev/null");
  }
  static fs::path out() { return logs_ / "made"; }

  // Of the held-out run, in rad/s; the drive was simulated in Python, in steps of 0.1 ms.
  static double velocity_error() {
    const Ran ran = run_omnihil("compare" + shell(out()) + "--json -");
    const nlohmann::json j = nlohmann::json::parse(ran.text, nullptr, false);
    return j.is_discarded() ? 1e9 : j["holdout"]["velocity"]["rmse"].get<double>();
  }
  static fs::path logs_;
};
fs::path ImportVerb::logs_;

TEST_F(ImportVerb, EveryFormatGivesTheDriveThatWasLogged) {
  const std::pair<const char*, const char*> all[] = {{"plain.csv", ""},
                                                     {"comma.csv", ""},
                                                     {"moteus.csv", ""},
                                                     {"vesc.csv", ""},
                                                     {"run4.mat", ""},
                                                     {"run73.mat", ""},
                                                     {"simplefoc.txt", " --period 0.002"},
                                                     {"run.mat", ""},
                                                     {"run.wpilog", ""},
                                                     {"run.ulg", ""},
                                                     {"plain.mcap", ""},
                                                     {"zstd.mcap", ""},
                                                     {"lz4.mcap", ""},
                                                     {"run.db3", ""}};
  for (const auto& [log, flags] : all) {
    if (!fs::exists(logs_ / log)) continue;
    const Ran ran = import(log, std::string(" --split 0.6") + flags);
    EXPECT_EQ(ran.exit_code, 0) << log << "\n" << ran.text;
    EXPECT_TRUE(ran.says("2 runs, 2000 rows")) << log << "\n" << ran.text;
    EXPECT_LT(velocity_error(), 0.15) << log;  // of 175 rad/s rms; the two simulations' steps differ
    EXPECT_TRUE(fs::exists(out() / "import.svg")) << log;
  }
}

// Torque-controlled: the model is run the other way round.
TEST_F(ImportVerb, OdriveLogsAreDrivenByTheirTorque) {
  const Ran ran = import("odrive.csv", " --split 0.6");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_NE(
      text_of(out() / "dataset.toml").find("motor_torque = { column = \"axis0.controller.input_torque\" }"),
      std::string::npos);
  EXPECT_EQ(run_omnihil("compare" + shell(out())).exit_code, 0);
}

TEST_F(ImportVerb, InDoubtTheFlagsAreSaidAndNothingIsWritten) {
  std::ofstream(logs_ / "doubt.csv") << "time_s,duty,speed\n0,0.1,1\n0.01,0.2,2\n0.02,0.2,3\n";
  const Ran ran = import("doubt.csv");
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("--map \"speed=velocity:rad/s\"")) << ran.text;
  EXPECT_FALSE(fs::exists(out()));
  const Ran given = import("doubt.csv", " --map speed=velocity:rpm");
  EXPECT_NE(given.exit_code, 2) << given.text;
  EXPECT_NE(text_of(out() / "dataset.toml").find("velocity = { column = \"speed\", scale = 0.1047"),
            std::string::npos);
}

TEST_F(ImportVerb, UnusableInputIsNamedAndNothingIsWritten) {
  std::ofstream(logs_ / "back.csv") << "time_s,duty,velocity_rad_s\n0,0.1,1\n0.02,0.2,2\n0.01,0.2,3\n";
  const Ran back = import("back.csv");
  EXPECT_EQ(back.exit_code, 2) << back.text;
  EXPECT_TRUE(back.says("row 3: time goes backwards")) << back.text;
  EXPECT_FALSE(fs::exists(out()));
  const Ran no_model = run_omnihil("import" + shell(logs_ / "plain.csv") + "--out" + shell(out()));
  EXPECT_EQ(no_model.exit_code, 2);
  EXPECT_TRUE(no_model.says("--model: found none")) << no_model.text;
  EXPECT_EQ(import("plain.csv", " --map nonsense").exit_code, 2);
  std::ofstream(logs_ / "noise.bin", std::ios::binary) << std::string("\0\1\2\3noise", 9);
  EXPECT_EQ(import("noise.bin").exit_code, 2);
  fs::create_directories(out());
  std::ofstream(out() / "mine") << "x";
  EXPECT_EQ(run_omnihil("import" + shell(logs_ / "plain.csv") + "--model" + shell(logs_ / "model.toml") +
                        "--out" + shell(out()))
                .exit_code,
            2);
  EXPECT_TRUE(fs::exists(out() / "mine"));
}

TEST_F(ImportVerb, SeveralLogsBecomeRunsOfTheirUse) {
  const Ran ran = import("plain.csv", " --holdout" + shell(logs_ / "plain.csv") + "--title 'two runs'");
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  const std::string toml = text_of(out() / "dataset.toml");
  EXPECT_NE(toml.find("file = \"plain_2.csv\"\nuse = \"holdout\""), std::string::npos) << toml;
  EXPECT_NE(toml.find("title = \"two runs\""), std::string::npos);
}

// The columns of a whole robot are known by the wheel's number; a simulated one comes back with the same errors.
TEST_F(ImportVerb, RobotsComeBackAsTheyWereLogged) {
  const fs::path made = logs_ / "robot";
  ASSERT_EQ(run_omnihil("sim omni_default --excite steps --duration 2 --out" + shell(made)).exit_code, 0);
  const std::string files = shell(made / "steps.csv") + "--holdout" + shell(made / "steps_holdout.csv");
  fs::remove_all(out());
  const Ran doubt =
      run_omnihil("import" + files + "--model omni_default --out" + shell(out()) + "</dev/null");
  EXPECT_EQ(doubt.exit_code, 2) << doubt.text;
  EXPECT_EQ(doubt.text.find("gyro_z:rad/s"), doubt.text.rfind("gyro_z:rad/s"))
      << "asked once, not once a run";
  const Ran ran =
      run_omnihil("import" + files + "--model" + shell(made / "model.toml") + "--si --out" + shell(out()));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  // A log states no noise; with the bus sensor's the model's input would be smoothed.
  std::string stated = text_of(made / "dataset.toml");
  const std::string bus = ", sigma = 0.02";
  ASSERT_NE(stated.find(bus), std::string::npos);
  stated.erase(stated.find(bus), bus.size());
  std::ofstream(made / "dataset.toml") << stated;
  const auto error = [](const fs::path& bench) {
    const nlohmann::json j = nlohmann::json::parse(run_omnihil("compare" + shell(bench) + "--json -").text);
    return j["holdout"]["gyro_z"]["rmse"].get<double>();
  };
  EXPECT_NEAR(error(out()), error(made), 1e-3 * error(made));
}

// A wrong scale is a fault of the data: the dataset is there, and the exit code says so.
TEST_F(ImportVerb, FaultsOfTheDataAreSaid) {
  const Ran ran = import("plain.csv", " --map 'speed_rpm=velocity:rad/s' --split 0.6");
  EXPECT_EQ(ran.exit_code, 1) << ran.text;
  EXPECT_TRUE(ran.says("data fault: ")) << ran.text;
}

// Real recordings of a robot with three wheels, where they are at hand.
TEST_F(ImportVerb, LiftedWheelsOfARealRobotBecomeDatasets) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  const fs::path recordings = fs::path(shared == nullptr ? "" : shared) / "data/kiwi_omni";
  if (!fs::exists(recordings)) GTEST_SKIP() << "no recordings: $OMNIHIL_SHARED/data/kiwi_omni";
  fs::remove_all(out());
  const std::string command = "'" OMNIHIL_SOURCE_DIR "/examples/import/kiwi_omni.sh'" + shell(recordings) +
                              shell(out()) + "'" OMNIHIL_PROGRAM "' </dev/null >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* wheel : {"wheel_1", "wheel_2", "wheel_3"}) {
    const Ran ran = run_omnihil("compare" + shell(out() / wheel));
    EXPECT_EQ(ran.exit_code, 0) << ran.text;
    EXPECT_TRUE(ran.says("velocity  holdout")) << ran.text;
  }
  // the whole robot: three duties, three speeds, a heading, a video on its clock
  const std::string toml = text_of(out() / "robot/dataset.toml");
  for (const char* channel :
       {"duty_3 = ", "wheel_speed_3 = ", "vision_x = ", "vision_theta = ", "rig = \"robot\""})
    EXPECT_NE(toml.find(channel), std::string::npos) << channel;
  EXPECT_EQ(toml.find("duty_4"), std::string::npos);
  const Ran ran = run_omnihil("compare" + shell(out() / "robot"));
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  for (const char* signal : {"wheel_speed_1", "wheel_speed_3", "vision_x", "vision_theta"})
    EXPECT_TRUE(ran.says(signal)) << ran.text;
}

// A log as the authors of the Robotino's recordings write it: three lines of header, currents without a sign, pixels.
std::string robotino_log(double vx_m_s, double vy_m_s) {
  const double angle_rad[] = {std::numbers::pi / 3, std::numbers::pi, 5 * std::numbers::pi / 3};
  std::string text =
      "Time;Set robot speed along X axis;Set robot speed along Y axis;Set rotational robot velocity;"
      "1st motor set speed;2st motor set speed;3st motor set speed;"
      "1st motor position;2nd motor position;3rd motor position;"
      "1st motor velocity;2nd motor velocity;3rd motor velocity;"
      "1st motor current;2nd motor current;3rd motor current;X axis current;Y axis curent;Rotational current;"
      "X axis global position;Y axis global position;Angle;\n"
      "ms;m/s;m/s;rad/s;rad/s;rad/s;rad/s;ticks;ticks;ticks;rad/s;rad/s;rad/s;A;A;A;A;A;A;pix;pix;deg;\n"
      "t;xsetspeed;ysetspeed;setvel;a;b;c;d;e;f;g;h;i;j;k;l;m;n;o;xpos;ypos;ang;\n";
  double driven_s = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double share = -std::expm1(-std::max(0.0, 0.03 * k - 0.1) / 0.05);
    driven_s += 0.03 * share;
    std::string speeds, currents;
    for (const double a : angle_rad) {
      const double motor_rad_s = 400.0 * share * (-std::sin(a) * vx_m_s + std::cos(a) * vy_m_s);
      speeds += fmt::format("{:.5g};", motor_rad_s);
      currents += fmt::format("{:.5g};", 0.02 * std::abs(motor_rad_s));
    }
    text += fmt::format("{};{};{};0;0;0;0;0;0;0;{}{}0;0;0;{:.6g};{:.6g};{:.1f};\n", 30 * k, vx_m_s, vy_m_s,
                        speeds, currents, 800.0 - vy_m_s * driven_s / 0.00184,
                        900.0 - vx_m_s * driven_s / 0.00184, 0.1 * (k % 3));
  }
  return text;
}

TEST_F(ImportVerb, TheExampleOfASlippingRobotReadsItsAuthorsLogs) {
  const fs::path from = logs_ / "robotino";
  for (const char* floor : {"gray_surface", "brown_surface"}) {
    fs::create_directories(from / floor);
    for (const int n : {0, 6, 12, 18, 24, 30, 36, 42, 48, 54, 72, 78, 84, 90, 96, 144, 150}) {
      const double towards_rad = 5.0 * n * std::numbers::pi / 180;
      std::ofstream(from / floor / fmt::format("exp{:02}.csv", n))
          << robotino_log(0.1 * std::cos(towards_rad), 0.1 * std::sin(towards_rad));
    }
  }
  fs::remove_all(out());
  const fs::path said = logs_ / "robotino.txt";
  const std::string command = "'" OMNIHIL_SOURCE_DIR "/examples/import/robotino.sh'" + shell(from) +
                              shell(out()) + "'" OMNIHIL_PROGRAM "' </dev/null >" + shell(said) + "2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << text_of(said);
  const std::string merged = "2 lines below the header have no number: part of it (and in 12 more)";
  EXPECT_NE(text_of(said).find(merged), std::string::npos) << text_of(said);
  const std::string last = text_of(out() / "gray/00.csv");  // forward: wheel 1 turns backwards
  EXPECT_NE(last.find(",34.641,-0.69282,"), std::string::npos) << "a current has the sign of its speed\n"
                                                               << last;
  const Ran ran = run_omnihil("compare" + shell(out() / "gray") + "--json -");
  const nlohmann::json j = nlohmann::json::parse(ran.text, nullptr, false);
  ASSERT_FALSE(j.is_discarded()) << ran.text;
  // What the guessed gain leaves of a speed without an integral, 1 - kp / (kp + k) = 9 % of 0.3 m of way.
  EXPECT_LT(j["holdout"]["vision_x"]["rmse"].get<double>(), 0.09 * 0.3);
  EXPECT_LT(j["holdout"]["vision_y"]["rmse"].get<double>(), 0.09 * 0.3);
}

}  // namespace
}  // namespace omnihil
