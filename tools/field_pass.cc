// `omnihil field pass`: pass and shoot of two robots, wheels by PID or by emotional learning, over many seeds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "hil/field_play/pass_and_shoot.h"
#include "hil/field_view/field_page.h"
#include "hil/loop/model_store.h"
#include "hil/text/program_files.h"
#include "tools/exit_codes.h"
#include "tools/field_verbs.h"
#include "tools/guarded.h"

namespace omnihil {
namespace {

struct PassArguments {
  std::string robot = "omni_default", controller = "both", picture;
  int seeds = 100;
  std::uint64_t first = 1;
};

struct Tally {
  std::vector<PassResult> results;
  int received = 0, scored = 0;
  double goal_s = 0.0, rms = 0.0;
  void add(const PassResult& r) {
    results.push_back(r);
    received += r.received;
    scored += r.scored;
    goal_s += r.goal_s;
    rms += r.wheel_rms_rad_s;
  }
  std::string text(const char* name) const {
    const int n = static_cast<int>(results.size());
    const Share pass = wilson_share(received, n), goal = wilson_share(scored, n);
    return fmt::format(
        "{:<7} passes received {:>3} of {} ({:.0f} to {:.0f} %), goals {:>3} ({:.0f} to {:.0f} %), mean time "
        "to a goal "
        "{:.2f} s, wheels off by {:.2f} rad/s rms\n",
        name, received, n, 100.0 * pass.from, 100.0 * pass.to, scored, 100.0 * goal.from, 100.0 * goal.to,
        scored > 0 ? goal_s / scored : 0.0, rms / n);
  }
};

int run_pass(const PassArguments& a) {
  const StoredModel stored = load_robot_model(a.robot, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) fmt::print(stderr, "{}\n", problem.text());
  if (!stored.model || !stored.model->robot) return kExitBadInput;
  const RobotModel& model = *stored.model->robot;
  Tally pid, belbic;
  for (int n = 0; n < a.seeds; ++n) {
    const std::uint64_t seed = a.first + static_cast<std::uint64_t>(n);
    if (a.controller != "belbic") pid.add(play_pass_and_shoot(model, MotorLoop::kDuty, {.seed = seed}));
    if (a.controller != "pid") belbic.add(play_pass_and_shoot(model, MotorLoop::kEmotional, {.seed = seed}));
  }
  if (!pid.results.empty()) fmt::print("{}", pid.text("PID"));
  if (!belbic.results.empty()) fmt::print("{}", belbic.text("BELBIC"));
  if (a.controller == "both") {
    int only_pid = 0, only_belbic = 0;
    double sum = 0.0, sum2 = 0.0;
    for (std::size_t i = 0; i < pid.results.size(); ++i) {
      only_pid += pid.results[i].scored && !belbic.results[i].scored;
      only_belbic += belbic.results[i].scored && !pid.results[i].scored;
      const double d = belbic.results[i].wheel_rms_rad_s - pid.results[i].wheel_rms_rad_s;
      sum += d;
      sum2 += d * d;
    }
    const double n = a.seeds, mean = sum / n;
    const double error = n > 1 ? std::sqrt(std::max(0.0, sum2 / n - mean * mean) / (n - 1.0)) : 0.0;
    fmt::print(
        "same seeds: goals by PID alone {}, by BELBIC alone {} (McNemar, exact: p = {:.2g}); wheels of "
        "BELBIC minus PID "
        "{:+.3f} +- {:.3f} rad/s\n",
        only_pid, only_belbic, mcnemar_p(only_pid, only_belbic), mean, 1.96 * error);
  }
  if (!a.picture.empty()) {
    FieldTrace* trace = nullptr;
    const MotorLoop loop = a.controller == "pid" ? MotorLoop::kDuty : MotorLoop::kEmotional;
    play_pass_and_shoot(model, loop, {.seed = a.first, .trace = &trace});
    const std::unique_ptr<FieldTrace> owned(trace);
    write_field_picture(a.picture, *owned, "pass and shoot");
  }
  return kExitOk;
}

}  // namespace

void add_field_pass(Verb& field, VerbResult& result) {
  auto a = std::make_shared<PassArguments>();
  Verb verb =
      field.add_subcommand("pass", "pass and shoot of two robots over a lossy radio and a late camera");
  verb.add_option("--robot", a->robot, "robot model: a name or a .toml file").capture_default_str();
  verb.add_option("--controller", a->controller, "of the wheels: pid, belbic (emotional learning) or both")
      .one_of({"pid", "belbic", "both"})
      .capture_default_str();
  verb.add_option("--seeds", a->seeds, "so many plays").range(1, 100'000).capture_default_str();
  verb.add_option("--seed", a->first, "the first one").capture_default_str();
  verb.add_option("--picture", a->picture, "the first play from above: .svg, .png or .html");
  verb.callback([a, &result] { result.exit_code = guarded("field pass", [&] { return run_pass(*a); }); });
}

}  // namespace omnihil
