// Whose error it is that ULaval's robot turns too slowly and rolls on after a stop. Its law, computed on the host on the
// same plant, does both as its image on the emulated board does (docs/mcu-third-party.md): neither is the
// emulation's or the bridge's.
#include <gtest/gtest.h>

#include <algorithm>

#include "hil/scenario/scenario_suite.h"

namespace omnihil {
namespace {

const std::string kHead =
    "format = \"omnihil-scenario/1\"\ntitle = \"t\"\nlevel = \"robot\"\nrobot = \"ulaval_delta_board\"\n"
    "commands = \"hal\"\nduration_s = 4.5\n";

std::vector<CheckResult> results(const std::string& library, const std::string& text) {
  const ScenarioReading reading = read_scenario(kHead + text, "t.toml");
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  SuiteOptions o;
  if (!library.empty())
    o.firmware.file = std::string(OMNIHIL_BUILD_DIR) + "/tests/firmware/lib" + library + ".so";
  o.model_folders = {std::string(OMNIHIL_SOURCE_DIR) + "/models"};
  return run_one(*reading.scenario, o).results;
}

struct Slow {
  double body_ratio, worst_wheel_ratio;
};
Slow turning(const std::string& library, double omega_rad_s) {
  const auto found = results(
      library, "[[step]]\nat_s = 0.1\ndo = \"command\"\nomega_body_rad_s = " + std::to_string(omega_rad_s) +
                   "\n[[check]]\nis = \"steady_error\"\nsignal = \"omega_body_rad_s\"\nat_most_ratio = 1.0\n"
                   "[[check]]\nis = \"steady_error\"\nat_most_ratio = 1.0\n");
  Slow slow{*found.at(0).measured, 0.0};
  for (std::size_t i = 1; i < found.size(); ++i)
    slow.worst_wheel_ratio = std::max(slow.worst_wheel_ratio, *found[i].measured);
  return slow;
}

double speed_after_stop_m_s(const std::string& library, const std::string& stop) {
  return *results(library,
                  "[[step]]\nat_s = 0.1\ndo = \"command\"\nv_forward_m_s = 1.0\n[[step]]\nat_s = 2.1\n"
                  "do = \"command\"\n" +
                      stop +
                      "\n[[check]]\nis = \"signal\"\nsignal = \"v_forward_m_s\"\nfrom_s = 2.8\nto_s = 2.802\n"
                      "at_most_m_s = 9.0\n")
              .at(0)
              .measured;
}

// The image's figures: 2.8 % and 4.2 % at 3 rad/s, 1.3 % and 2.5 % at 10 rad/s.
TEST(UlavalLaw, TurnsAsMuchTooSlowlyOnTheHostAsOnTheEmulatedBoard) {
  const Slow slow = turning("windowed_integral", 3.0), fast = turning("windowed_integral", 10.0);
  EXPECT_NEAR(slow.body_ratio, 0.028, 0.003);
  EXPECT_NEAR(slow.worst_wheel_ratio, 0.042, 0.003);
  EXPECT_NEAR(fast.body_ratio, 0.013, 0.003);
  EXPECT_NEAR(fast.worst_wheel_ratio, 0.025, 0.003);
}

// An integral of one second has a gain that ends (Kp + Ki 1 s = 85.5), so friction leaves an error.
TEST(UlavalLaw, WithAnIntegralOverAllOfThePastTheErrorGoes) {
  const double windowed = turning("windowed_integral", 3.0).body_ratio;
  EXPECT_LT(turning("whole_integral", 3.0).body_ratio, windowed / 2.0);
}

TEST(UlavalLaw, ItsStopIsDutyZeroAndRollsOnAsDutyZeroDoesUnderAnotherFirmware) {
  const double law_m_s = speed_after_stop_m_s("windowed_integral", "v_forward_m_s = 0.0"),
               other_m_s = speed_after_stop_m_s("", "duty_ratio = 0.0"),
               controlled_m_s = speed_after_stop_m_s("", "v_forward_m_s = 0.0");
  EXPECT_NEAR(law_m_s, 0.33, 0.01);
  EXPECT_NEAR(other_m_s, law_m_s, 0.01);
  EXPECT_LT(controlled_m_s, 0.02) << "the plant can stop";
}

}  // namespace
}  // namespace omnihil
