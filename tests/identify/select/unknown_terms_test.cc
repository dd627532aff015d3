// The terms that a formula may be put together from say what they are of.
#include "identify/select/unknown_terms.h"

#include <gtest/gtest.h>

#include "tests/identify/linear_predictor.h"

namespace omnihil {
namespace {

// Where the motion is imposed the motor's torque is what the formula itself makes needed: these are left out there.
TEST(UnknownTerms, ATermOfTheMotorsTorqueSaysSo) {
  std::size_t of_torque = 0;
  for (const UnknownTerm& term : torque_terms(axis_with_unknown_friction(), {}, 0.01)) {
    EXPECT_EQ(term.of_motor_torque, term.text.find("tau_motor") != std::string::npos) << term.text;
    of_torque += term.of_motor_torque ? 1 : 0;
  }
  EXPECT_EQ(of_torque, 3u);
}

}  // namespace
}  // namespace omnihil
