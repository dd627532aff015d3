// Tables as text, units, and what columns mean: on lines as the tools write them.
#include "hil/logs/csv_log.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hil/logs/known_names.h"
#include "hil/logs/log_dataset.h"
#include "hil/logs/log_rows.h"
#include "hil/logs/recognise.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

std::string refusal(std::string_view text, const LogOptions& options = {}) {
  try {
    parse_csv_log(text, "log.csv", options);
  } catch (const BadLog& bad) {
    return bad.what();
  }
  return "";
}

TEST(CsvLog, SeparatorsAndDecimalCommasAreTold) {
  for (const char* text : {"a,b\n1.5,2\n3,4\n", "a;b\r\n1,5;2\r\n3;4\r\n", "a\tb\n1.5\t2\n3\t4\n",
                           "a b\n1.5  2\n3 4\n", "\xEF\xBB\xBF# x\n\"a\",b\n1.5,2\n3,4\n"}) {
    const LogTable log = parse_csv_log(text, "log.csv", {});
    ASSERT_EQ(log.series.size(), 2u) << text;
    EXPECT_EQ(log.series[0].name, "a") << text;
    EXPECT_EQ(log.series[0].value, (std::vector<double>{1.5, 3.0})) << text;
    EXPECT_EQ(log.series[1].value, (std::vector<double>{2.0, 4.0})) << text;
  }
}

// Rows as MATLAB ends them; a semicolon inside the row still separates.
TEST(CsvLog, ASemicolonThatEndsARowSeparatesNothing) {
  const LogTable log = parse_csv_log("% made by hand\n0.0,1.5,2;\n0.1,3,4;\nnan,nan,nan;\n", "log.csv",
                                     {{"t_s", "duty", "rpm"}});
  ASSERT_EQ(log.series.size(), 3u);
  EXPECT_EQ(log.series[1].value[1], 3.0);
  EXPECT_EQ(log.series[2].value[0], 2.0);
  EXPECT_TRUE(std::isnan(log.series[0].value[2]));
}

TEST(CsvLog, WhatIsNotMeasuredIsMissingAndSaid) {
  const LogTable log = parse_csv_log("t,v,word\n0,1,on\n1,,off\n2,nan,on\n3,x,on\n4,2", "log.csv", {});
  ASSERT_EQ(log.series.size(), 2u);
  EXPECT_EQ(log.series[1].value.size(), 4u);  // the last line is cut
  EXPECT_TRUE(std::isnan(log.series[1].value[1]) && std::isnan(log.series[1].value[2]) &&
              std::isnan(log.series[1].value[3]));
  std::string all;
  for (const std::string& note : log.notes) all += note + "\n";
  EXPECT_NE(all.find("log.csv:6: the last line is cut"), std::string::npos) << all;
  EXPECT_NE(all.find("v: 1 cells are no numbers"), std::string::npos) << all;
  EXPECT_NE(all.find("columns without a number left out: word"), std::string::npos) << all;
}

TEST(CsvLog, LinesBelowTheHeaderWithoutANumberBelongToIt) {
  const LogTable log =
      parse_csv_log("Time;motor speed;camera\nms;rpm;pix;\nt;v;x\n0;60;833\n10;;834\n", "log.csv", {});
  ASSERT_EQ(log.series.size(), 3u);
  EXPECT_EQ(log.series[0].unit, "ms");
  EXPECT_EQ(log.series[1].unit, "rpm");
  EXPECT_EQ(log.series[2].unit, "");  // no unit that is known
  EXPECT_EQ(log.series[0].value, (std::vector<double>{0, 10}));
  ASSERT_EQ(log.notes.size(), 1u);
  EXPECT_NE(log.notes[0].find("2 lines below the header have no number"), std::string::npos) << log.notes[0];
  MeaningContext context;
  const LogMeaning m = recognise(log, context, {{"motor speed", "velocity", ""}, {"camera", "-", ""}});
  EXPECT_DOUBLE_EQ(m.of("time")->scale.scale, 1e-3);
  EXPECT_DOUBLE_EQ(m.of("velocity")->scale.scale, kTurn / 60);
  // A row that a logger left without numbers is a row.
  EXPECT_EQ(parse_csv_log("t,v\n0,1\n-,-\n2,1\n", "log.csv", {}).series[0].value.size(), 3u);
}

TEST(CsvLog, BrokenTablesAreRefusedWithTheirLine) {
  EXPECT_NE(refusal("t,v\n0,1\n1,2,3\n2,3\n").find("log.csv:3: 3 cells; allowed: 2"), std::string::npos);
  EXPECT_NE(refusal("t,t\n0,1\n1,2\n").find("stands twice"), std::string::npos);
  EXPECT_NE(refusal("t,v\n").find("has 1 lines"), std::string::npos);
  EXPECT_NE(refusal("0,1,2\n1,2,3\n").find("--columns"), std::string::npos);
  EXPECT_NE(refusal("0,1,2\n1,2,3\n", {{"a", "b"}}).find("2 names, the table 3 columns"), std::string::npos);
  EXPECT_NE(refusal("a,b\nx,y\nz,w\n").find("has no numbers"), std::string::npos);
}

// The first lines of a log that VESC Tool's app wrote, with columns left out; each ends in a semicolon.
TEST(CsvLog, VescToolsLogIsKnownByItsColumns) {
  const LogTable log = parse_csv_log(
      "ms_today;input_voltage;temp_motor;current_motor;q_axis_current;erpm;duty_cycle;fault_code;\n"
      "80069026;55.3;26.9;0;0;0;0;0;\n80069188;55.3;26.9;0.5;0.4;4200;0.25;0;\n80069300;55.2;26.9;0.5;0.4;"
      "4300;0.25;0;\n",
      "vesc.csv", {});
  EXPECT_EQ(log.format, LogFormat::kVesc);
  MeaningContext context;
  context.pole_pairs = 7;
  const LogMeaning m = recognise(log, context, {});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  ASSERT_NE(m.of("velocity"), nullptr);
  EXPECT_DOUBLE_EQ(m.of("velocity")->scale.scale, kTurn / 60 / 7);
  EXPECT_EQ(log.series[m.of("motor_current")->series].name, "q_axis_current");  // before current_motor
  EXPECT_DOUBLE_EQ(m.of("time")->scale.scale, 1e-3);
  context.pole_pairs = 0;
  ASSERT_EQ(recognise(log, context, {}).doubts.size(), 1u);
  EXPECT_NE(recognise(log, context, {}).doubts[0].find("motor.pole_pairs"), std::string::npos);
}

TEST(CsvLog, SimpleFocsMonitorNeedsNoHeaderButAPeriod) {
  const LogTable log =
      parse_csv_log("MOT: Ready.\n2.0\t1.5\t10.2\t0.1\n2.0\t1.6\t10.4\t0.2\n", "mon.txt", {});
  EXPECT_EQ(log.format, LogFormat::kSimpleFoc);
  MeaningContext context;
  EXPECT_NE(recognise(log, context, {}).doubts.at(0).find("--period"), std::string::npos);
  context.period_s = 0.001;
  const LogMeaning m = recognise(log, context, {});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  EXPECT_EQ(log.series[m.of("motor_voltage")->series].value[1], 1.6);
  EXPECT_EQ(log_rows(log, m, context, "mon.txt").time_s[1], 0.001);
}

LogMeaning meaning(std::string_view text, std::vector<ColumnMap> asked = {}) {
  return recognise(parse_csv_log(text, "log.csv", {}), {}, asked);
}

TEST(Meaning, AUnitInTheNameSettlesIt) {
  const LogMeaning m = meaning("t_ms,pwm_percent,speed [rpm],I (mA)\n0,10,60,1\n1,20,120,2\n",
                               {{"I (mA)", "motor_current", "mA"}});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  EXPECT_DOUBLE_EQ(m.of("time")->scale.scale, 1e-3);
  EXPECT_DOUBLE_EQ(m.of("duty")->scale.scale, 0.01);
  EXPECT_DOUBLE_EQ(m.of("velocity")->scale.scale, kTurn / 60);
  EXPECT_DOUBLE_EQ(m.of("motor_current")->scale.scale, 1e-3);
}

TEST(Meaning, WithoutAUnitTheFlagsToGiveAreSaid) {
  const LogMeaning m = meaning("time_s,duty,speed\n0,0.1,60\n0.01,0.2,120\n");
  ASSERT_EQ(m.doubts.size(), 1u);
  EXPECT_NE(m.doubts[0].find("--map \"speed=velocity:rad/s\""), std::string::npos) << m.doubts[0];
  const LogMeaning angle = meaning("time_s,duty,theta\n0,0.1,60\n0.01,0.2,120\n");
  ASSERT_EQ(angle.doubts.size(), 1u);
  EXPECT_NE(angle.doubts[0].find("theta=position:turn"), std::string::npos) << angle.doubts[0];
  EXPECT_TRUE(
      meaning("time_s,duty,speed\n0,0.1,60\n0.01,0.2,120\n", {{"speed", "velocity", "rpm"}}).doubts.empty());
}

TEST(Meaning, SiIsTheUsersWordForUnitsThatAreNotSaid) {
  MeaningContext context;
  context.si = true;
  const LogTable log =
      parse_csv_log("time_s,duty,speed,current_mA\n0,0.1,60,5\n0.01,0.2,120,6\n", "log.csv", {});
  const LogMeaning m = recognise(log, context, {});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  EXPECT_EQ(m.of("velocity")->unit, "rad/s");
  EXPECT_EQ(m.of("motor_current")->unit, "mA");  // said by its name
}

TEST(Meaning, ADutyBeyondOneIsInDoubt) {
  const LogMeaning m = meaning("time_s,duty,speed_rpm\n0,10,60\n0.01,20,120\n");
  ASSERT_EQ(m.doubts.size(), 1u);
  EXPECT_NE(m.doubts[0].find("duty=duty:%"), std::string::npos) << m.doubts[0];
}

// analogWrite takes 0 to 255, and that is what such logs hold.
TEST(Meaning, ATimersCompareValueIsAShareOfItsRange) {
  const char* text = "time_ms,MotorPWM,Encoder\n0,255,0\n10,51,4\n20,0,8\n";
  ASSERT_EQ(meaning(text).doubts.size(), 1u);
  EXPECT_NE(meaning(text).doubts[0].find("MotorPWM=duty:/255"), std::string::npos) << meaning(text).doubts[0];
  const LogMeaning m = meaning(text, {{"MotorPWM", "duty", "/255"}});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  EXPECT_DOUBLE_EQ(51.0 * m.of("duty")->scale.scale, 0.2);
}

// Of a timer that counts to 5319 no unit of the list is right, and those by which the duty would go beyond one are wrong.
TEST(Meaning, UnitsThatTheValuesForbidAreNotNamed) {
  const LogMeaning m = meaning("time_ms,PWM,speed_rpm\n0,0,0\n10,1299,100\n20,-5199,-400\n");
  ASSERT_EQ(m.doubts.size(), 1u);
  for (const char* wrong : {"duty:1\"", "duty:%", "duty:/255", "duty:/1023", "duty:/4095"})
    EXPECT_EQ(m.doubts[0].find(wrong), std::string::npos) << wrong << ": " << m.doubts[0];
  EXPECT_NE(m.doubts[0].find("PWM=duty:0.000192*1"), std::string::npos) << m.doubts[0];
  EXPECT_DOUBLE_EQ(meaning("t_s,PWM,speed_rpm\n0,0,0\n0.01,5319,9\n", {{"PWM", "duty", "0.000188*1"}})
                       .of("duty")
                       ->scale.scale,
                   0.000188);
}

TEST(Meaning, AUnitDecidesBetweenTwoSignalsOfOneName) {
  const LogMeaning m = meaning("time_s,u [V],angular_velocity [rad/s]\n0,1,60\n0.01,2,120\n");
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  ASSERT_NE(m.of("motor_voltage"), nullptr);  // volts are no duty
  EXPECT_NE(m.of("velocity"), nullptr);
  EXPECT_EQ(meaning("time_s,u,speed_rpm\n0,1,60\n0.01,2,120\n").doubts.size(), 1u);
}

TEST(Meaning, AClockInOddStepsIsInDoubt) {
  EXPECT_EQ(meaning("t,duty,speed_rpm\n0,0.1,1\n10,0.2,2\n20,0.2,2\n").doubts.size(), 1u);
  EXPECT_TRUE(meaning("t,duty,speed_rpm\n0,0.1,1\n0.01,0.2,2\n0.02,0.2,2\n").doubts.empty());
}

TEST(Meaning, TwoColumnsForOneSignalAreInDoubtUntilOneIsNamed) {
  const char* text = "time_s,duty,speed_rpm,omega_rad_s\n0,0.1,60,6\n0.01,0.2,120,12\n";
  ASSERT_EQ(meaning(text).doubts.size(), 1u);
  EXPECT_NE(meaning(text).doubts[0].find("2 columns may be velocity"), std::string::npos);
  const LogMeaning m = meaning(text, {{"omega_rad_s", "velocity", "rad/s"}});
  EXPECT_TRUE(m.doubts.empty()) << m.doubts.front();
  EXPECT_EQ(m.of("velocity")->series, 3u);
}

TEST(Meaning, MissingDriveOrMotionIsSaid) {
  EXPECT_NE(meaning("time_s,speed_rpm\n0,1\n1e-2,2\n")
                .doubts.at(0)
                .find("no column is what was asked of the drive"),
            std::string::npos);
  EXPECT_NE(meaning("time_s,duty\n0,1\n1e-2,0.2\n").doubts.at(0).find("no column is a motion"),
            std::string::npos);
}

// A table of two axes, "a1 velocity [rad/s]": which it is only the user knows, but the flags need no thought.
TEST(Meaning, ColumnsThatMayBeTheMissingOneByTheirUnitsAreNamed) {
  const LogMeaning m =
      meaning("time [s],a1 torque cmd [Nm],a1 velocity [rad/s],mode\n0,0.1,60,1\n0.01,0.2,120,1\n");
  ASSERT_EQ(m.doubts.size(), 2u);
  EXPECT_NE(m.doubts[0].find("may be: --map \"a1 torque cmd [Nm]=motor_torque:Nm\""), std::string::npos)
      << m.doubts[0];
  EXPECT_NE(m.doubts[1].find("may be: --map \"a1 velocity [rad/s]=velocity:rad/s\""), std::string::npos)
      << m.doubts[1];
  EXPECT_EQ(m.doubts[0].find("a1 velocity"), std::string::npos) << m.doubts[0];
}

LogRun run_of(std::string_view text, const char* path, Split use) {
  LogRun run;
  run.path = run.file.name = path;
  run.table = parse_csv_log(text, path, {});
  run.use = use;
  return run;
}

// A closed-loop log has the reference beside, an open-loop one has not.
TEST(LogDataset, AMapOfAColumnThatOnlySomeLogsHaveIsNoFault) {
  const std::vector<LogRun> runs = {
      run_of("t,duty,y\n0,0.1,1\n0.01,0.2,2\n0.02,0.2,2\n", "open.csv", Split::kTraining),
      run_of("t,speed,duty,y\n0,9,0.1,1\n0.01,9,0.2,2\n0.02,9,0.2,2\n", "closed.csv", Split::kValidation)};
  LogDatasetOptions options;
  options.asked = {{"y", "velocity", "rad/s"}, {"speed", "-", ""}};
  const LogDataset made = make_log_dataset(runs, options);
  EXPECT_TRUE(made.doubts.empty()) << made.doubts.front();
  options.asked.push_back({"sped", "-", ""});  // that no log has
  EXPECT_FALSE(make_log_dataset(runs, options).doubts.empty());
}

// A sensor at 50 Hz, logged at 500: what was asked of the drive stays as it is, a reading stands once.
TEST(LogDataset, ReadingsThatRowsRepeatAreLeftOnce) {
  std::string text = "t_s,duty,angle_rad,current_A\n";
  for (int k = 0; k < 1000; ++k) {
    const double at_s = 0.02 * (k / 10);
    text += fmt::format("{:.3f},{},{:.6f},{:.3f}\n", 0.002 * k, k / 10 % 2, std::sin(3.0 * at_s),
                        0.1 * std::sin(0.01 * k) + 0.001 * (k % 7));
  }
  const LogDataset made = make_log_dataset({run_of(text, "slow.csv", Split::kTraining)}, {});
  ASSERT_TRUE(made.doubts.empty()) << made.doubts.front();
  ASSERT_EQ(made.notes.size(), 1u);
  EXPECT_NE(made.notes[0].find("position is new in one row of 10 only, about every 20 ms"), std::string::npos)
      << made.notes[0];
  const std::string& csv = made.files.back().text;
  EXPECT_NE(csv.find("\n0.04,0,0.119712,"), std::string::npos) << csv.substr(0, 800);
  EXPECT_NE(csv.find("\n0.042,0,,"), std::string::npos) << csv.substr(0, 800);
}

TEST(Meaning, MisspeltMapsAreNamed) {
  const LogMeaning m = meaning("time_s,duty,speed_rpm\n0,0.1,60\n0.01,0.2,120\n",
                               {{"sped_rpm", "velocity", "rpm"}, {"duty", "dutty", "1"}});
  ASSERT_GE(m.doubts.size(), 2u);
  EXPECT_NE(m.doubts[0].find("did you mean \"speed_rpm\""), std::string::npos) << m.doubts[0];
  EXPECT_NE(m.doubts[1].find("did you mean \"duty\""), std::string::npos) << m.doubts[1];
  std::vector<std::string> faults;
  parse_map("speed", faults);
  parse_map("speed=velocity:furlong", faults);
  EXPECT_EQ(faults.size(), 2u);
}

TEST(Meaning, ANameOfTwoSignalsIsInDoubt) {
  const char* text = "time_s,voltage_V,speed_rpm\n0,1,60\n0.01,2,120\n";
  ASSERT_GE(meaning(text).doubts.size(), 1u);
  EXPECT_NE(meaning(text).doubts[0].find("may be motor_voltage or bus_voltage"), std::string::npos)
      << meaning(text).doubts[0];
  EXPECT_TRUE(meaning(text, {{"voltage_V", "motor_voltage", "V"}}).doubts.empty());
  EXPECT_EQ(usual_signal("battery_status.voltage", rig_axis()), "bus_voltage");
  EXPECT_EQ(usual_signal("battery.current", rig_axis()), "");
}

TEST(Meaning, TwoDriveInputsAreInDoubt) {
  const char* text = "time_s,duty,motor_voltage,speed_rpm\n0,0.1,1,60\n0.01,0.2,2,120\n";
  ASSERT_EQ(meaning(text).doubts.size(), 1u);
  EXPECT_NE(meaning(text).doubts[0].find("leave all but one out"), std::string::npos);
  EXPECT_TRUE(meaning(text, {{"duty", "-", ""}}).doubts.empty());
}

TEST(Meaning, OfARobotNamesEndInTheWheel) {
  EXPECT_EQ(usual_signal("duty_3", rig_robot()), "duty_3");
  EXPECT_EQ(usual_signal("enc1", rig_robot()), "encoder_1");
  EXPECT_EQ(usual_signal("enc0", rig_robot()), "");
  EXPECT_EQ(usual_signal("enc5", rig_robot()), "");
  EXPECT_EQ(usual_signal("Motor Current 4", rig_robot()), "motor_current_4");
  EXPECT_EQ(usual_signal("/drive/velocity", rig_axis()), "velocity");
}

TEST(Units, LeadToTheSignalsOwn) {
  std::string fault;
  EXPECT_DOUBLE_EQ(unit_scale("turn/s", "rad/s", {}, fault)->scale, kTurn);
  EXPECT_DOUBLE_EQ(unit_scale("deg", "rad", {}, fault)->scale, kTurn / 360);
  EXPECT_DOUBLE_EQ(unit_scale("erad/s", "rad/s", {4}, fault)->scale, 0.25);
  EXPECT_DOUBLE_EQ(unit_scale("mNm", "N m", {}, fault)->scale, 1e-3);
  EXPECT_DOUBLE_EQ(unit_scale("-rad", "rad", {}, fault)->scale, -1.0);
  EXPECT_DOUBLE_EQ(unit_scale("-0.0018*m", "m", {}, fault)->scale, -0.0018);  // pixels of a camera
  EXPECT_DOUBLE_EQ(unit_scale("0.0625*rpm", "rad/s", {}, fault)->scale, 0.0625 * kTurn / 60);
  for (const char* wrong : {"0*m", "x*m", "1e999*m", "nan*m", "2*", "2*parsec", "2m", "*m"})
    EXPECT_FALSE(unit_scale(wrong, "m", {}, fault)) << wrong;
  EXPECT_FALSE(unit_scale("A", "rad/s", {}, fault));
  EXPECT_NE(fault.find("allowed: rad/s"), std::string::npos) << fault;
  EXPECT_EQ(split_unit("current_A").second, "A");
  EXPECT_EQ(split_unit("Motor_Speed(RPM)"), (std::pair<std::string, std::string>("Motor_Speed", "RPM")));
  EXPECT_EQ(split_unit("omega_rad_s"), (std::pair<std::string, std::string>("omega", "rad/s")));
  EXPECT_EQ(split_unit("alpha_a").second, "");
}

TEST(Rows, ClocksThatGoBackwardsAreRefusedRepeatedOnesCounted) {
  MeaningContext context;
  const LogTable back =
      parse_csv_log("time_s,duty,speed_rpm\n0,0.1,60\n0.02,0.2,120\n0.01,0.2,120\n", "log.csv", {});
  EXPECT_THROW(log_rows(back, recognise(back, context, {}), context, "log.csv"), BadLog);
  const LogTable twice =
      parse_csv_log("time_s,duty,speed_rpm\n5,0.1,60\n5.01,0.2,120\n5.01,0.2,120\n,1,1\n", "log.csv", {});
  const LogRows rows = log_rows(twice, recognise(twice, context, {}), context, "log.csv");
  EXPECT_EQ(rows.time_s.size(), 2u);
  EXPECT_EQ(rows.time_s[0], 0.0);
  EXPECT_EQ(rows.notes.size(), 2u);
}

}  // namespace
}  // namespace omnihil
