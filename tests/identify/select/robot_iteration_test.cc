// One iteration of the selection on a robot's record.
#include "identify/select/selection_iteration.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

// Nothing in a record parts a payload from a heavier robot; the file, which knows the mass to 2 %, does.
Iteration iteration_with_payload(double payload_kg) {
  const Dataset data = robot_record({{"payload.mass_kg", payload_kg}}, 6.0);
  const Candidate nominal = robot_candidate();
  const PreparedSelection bench(data, nominal, {.seed = 1, .jobs = 2});
  return selection_iteration(bench.task, bench.context.base());
}

TEST(RobotIteration, APayloadIsAcceptedByThePriorOfTheMass) {
  const Iteration iteration = iteration_with_payload(0.14);  // 6 %, 2.9 tolerances
  ASSERT_EQ(iteration.chosen, 0) << iteration.ranking.front().effect << ": " << iteration.ranking.front().why;
  const CandidateEffect& best = iteration.candidates.front();
  EXPECT_EQ(best.screened.name, "payload") << best.acceptance.why;
  EXPECT_NEAR(*value_at(best.fitted.fit.model, "payload.mass_kg"), 0.14, 0.015);
  EXPECT_EQ(best.acceptance.accepted_by, AcceptedBy::kPrior);
}

TEST(RobotIteration, AMassWithinItsToleranceIsNoPayload) {
  const Iteration iteration = iteration_with_payload(0.07);  // 3 %
  EXPECT_EQ(iteration.chosen, -1) << iteration.candidates.front().screened.name << ": "
                                  << iteration.candidates.front().acceptance.why;
}

TEST(RobotIteration, WithoutEncodersNoLawOfTheAngleIsTried) {
  Dataset data = robot_record({}, 1.0);
  std::erase_if(data.channels, [](const Channel& c) { return c.signal.starts_with("encoder"); });
  const Candidate nominal = robot_candidate();
  PreparedSelection bench(data, nominal, {.seed = 1, .jobs = 2});
  bench.task.applicable = {find_effect("cogging"), find_effect("roller_ripple")};
  const Iteration iteration = selection_iteration(bench.task, bench.context.base());
  ASSERT_EQ(iteration.ranking.size(), 2u);
  for (const RankedEffect& r : iteration.ranking) {
    EXPECT_EQ(r.visibility, Visibility::kUnresolved) << r.effect;
    EXPECT_EQ(r.why, "needs encoders: its phase is that of an angle") << r.effect;
    EXPECT_EQ(r.score, 0.0) << r.effect;
  }
}

// Ten per cent, five tolerances: after the other effect is found nothing remains but a prior-implausible mass.
TEST(SlowRobotDiagnosis, APayloadIsFoundBesideAnotherEffect) {
  const Dataset data =
      robot_record({{"payload.mass_kg", 0.25}, {"rolling_resistance.coefficient", 0.03}}, 6.0);
  const Diagnosis d = diagnose(data, robot_candidate(), {.seed = 1, .jobs = 2, .progress = {}, .stop = {}});
  std::vector<std::string> names = d.effects;
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"payload", "rolling_resistance"}));
  EXPECT_EQ(d.verdict, Verdict::kEffect);
}

}  // namespace
}  // namespace omnihil::test
