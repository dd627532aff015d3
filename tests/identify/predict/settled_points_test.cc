// Settled points of a robot: each row alone, its duties held until all has settled.
#include "identify/predict/settled_points.h"

#include <cmath>
#include <numbers>

#include "hil/dataset/dataset_reader.h"
#include "tests/identify/dataset_folder.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

// Of duties that are the same at all wheels the robot turns on the spot.
Dataset turning(const std::vector<double>& duties) {
  Dataset d;
  d.rig = &rig_robot();
  omnihil::Run run;
  run.file = "points.csv";
  run.steady = true;
  for (std::size_t k = 0; k < duties.size(); ++k) run.time_s.push_back(60.0 * static_cast<double>(k));
  for (int i = 1; i <= kWheels; ++i) {
    const std::string wheel = "_" + std::to_string(i);
    d.channels.push_back({.signal = "duty" + wheel, .column = "duty" + wheel, .unit = "1"});
    d.channels.push_back(
        {.signal = "wheel_speed" + wheel, .column = "w" + wheel, .unit = "rad/s", .sigma = 0.01});
    d.channels.push_back(
        {.signal = "motor_current" + wheel, .column = "i" + wheel, .unit = "A", .sigma = 0.01});
    run.signals["duty" + wheel] = duties;
    run.signals["wheel_speed" + wheel].assign(duties.size(), 0.0);
    run.signals["motor_current" + wheel].assign(duties.size(), 0.0);
  }
  d.runs = {run, run};
  d.runs[1].split = Split::kValidation;
  return d;
}

std::vector<double> predicted(const Dataset& d, const std::string& name) {
  const auto p = make_predictor(d, robot_candidate(), {});
  const Prediction y = p->predict(robot_candidate(), 0);
  EXPECT_TRUE(y.finite);
  for (std::size_t s = 0; s < p->compared(0).size(); ++s)
    if (p->compared(0)[s].name == name) return y.values[s];
  ADD_FAILURE() << name;
  return {};
}

// d V = R i + k w, k i = tau_c + b w: rotor speed w, of the numbers in kRobotModel.
TEST(SettledPoints, ARobotThatTurnsHasItsMotorsClosedForm) {
  constexpr double kR = 0.464, kK = 0.0335, kB = 4e-6, kCoulomb = 0.0027, kV = 22.2, kGear = 3.0;
  const std::vector<double> duties = {0.1, -0.3, 0.5};
  const Dataset d = turning(duties);
  const std::vector<double> speed = predicted(d, "wheel_speed_2"), current = predicted(d, "motor_current_2");
  for (std::size_t k = 0; k < duties.size(); ++k) {
    const double sign = std::copysign(1.0, duties[k]);
    const double w = (duties[k] * kV - sign * kR * kCoulomb / kK) / (kK + kR * kB / kK);
    EXPECT_NEAR(speed[k], w / kGear, 1e-3 * std::abs(w / kGear)) << duties[k];
    EXPECT_NEAR(current[k], (sign * kCoulomb + kB * w) / kK, 2e-3 * std::abs(current[k])) << duties[k];
  }
}

TEST(SettledPoints, NoneKnowsOfAnother) {
  const std::vector<double> there = predicted(turning({0.1, -0.3, 0.5}), "wheel_speed_1");
  const std::vector<double> back = predicted(turning({0.5, -0.3, 0.1}), "wheel_speed_1");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(there[k], back[2 - k]);
}

TEST(SettledPoints, WithoutADutyNothingTurns) {
  const std::vector<double> speed = predicted(turning({0.0, 0.0}), "wheel_speed_3");
  for (const double w : speed) EXPECT_EQ(w, 0.0);
}

TEST(SettledPoints, TheModelThatMadeThemLeavesTheirNoise) {
  std::vector<double> duties;
  for (int k = 0; k < 200; ++k) duties.push_back(0.5 * std::cos(2.0 * std::numbers::pi * (k + 0.5) / 200.0));
  const Candidate truth = robot_candidate();
  const auto p = make_predictor(turning(duties), truth, {})->simulated(truth, 5);
  const Prediction y = p->predict(truth, 0);
  for (std::size_t s = 0; s < p->compared(0).size(); ++s) {
    const ComparedSignal& c = p->compared(0)[s];
    double square = 0.0;
    for (std::size_t k = 0; k < duties.size(); ++k)
      square += std::pow((c.measured[k] - y.values[s][k]) / c.noise_sigma, 2) / 200.0;
    EXPECT_NEAR(square, 1.0, 5.0 * std::sqrt(2.0 / 200.0)) << c.name;
  }
}

TEST(SettledPoints, HaveNoTime) {
  const auto p = make_predictor(turning({0.1, 0.2}), robot_candidate(), {});
  for (const RegimeTrack& t : p->regimes(robot_candidate(), 0)) {
    EXPECT_NE(t.name, "time");
    EXPECT_NE(t.name, "time_since_step");
    EXPECT_NE(t.name, "acceleration");
  }
}

TEST(SettledPoints, UnderCommandsAreRefused) {
  DatasetFolder folder;
  folder.write("model.toml", kRobotModel);
  std::string channels = "time = { column = \"t\" }\n";
  for (const char* axis : {"vx", "vy", "w"})
    channels += "command_" + std::string(axis) + " = { column = \"" + axis + "\" }\n";
  for (const char* wheel : {"1", "2", "3", "4"})
    channels += "wheel_speed_" + std::string(wheel) + " = { column = \"w" + wheel + "\" }\n";
  folder.write("dataset.toml",
               "format = \"omnihil-dataset/1\"\ntitle = \"t\"\nrig = \"robot\"\nmodel = "
               "\"model.toml\"\n[channels]\n" +
                   channels + "[[runs]]\nfile = \"fit.csv\"\nuse = \"fit\"\nkind = \"steady\"\n");
  folder.write("fit.csv", "t,vx,vy,w,w1,w2,w3,w4\n0,0.1,0,0,1,2,3,4\n1,0.2,0,0,1,2,3,4\n");
  const DatasetReading r = read_dataset(folder.path());
  EXPECT_FALSE(r.dataset);
  EXPECT_NE(all_text(r.problems).find("is of settled points under commands"), std::string::npos)
      << all_text(r.problems);
}

}  // namespace
}  // namespace omnihil::test
