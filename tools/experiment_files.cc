#include "tools/experiment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/recording/stream_file.h"

namespace omnihil {

std::string planned_csv(const PlannedRun& run) {
  std::string text = "time_s";
  for (std::size_t i = 0; i < run.duty.size(); ++i) {
    text += run.duty.size() == 1 ? "," + run.input : fmt::format(",{}_{}", run.input, i + 1);
  }
  text += '\n';
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    text += fmt::format("{:.6f}", run.time_s[k]);
    for (const auto& drive : run.duty) text += fmt::format(",{:.6g}", drive[k]);
    text += '\n';
  }
  return text;
}

std::string planned_stream(const PlannedRun& run, const RadioFormat& format, CommandTo robot, double rate_Hz,
                           std::string& fault) {
  HostStream stream;
  const auto frames = [&](double time_s, const std::array<double, 4>& duty) {
    StreamChunk chunk{.at_ns = std::llround(time_s * 1e9), .bytes = {}};
    RobotCommand command{};
    command.mode = OMNIHIL_MODE_WHEEL_DUTY;
    std::copy(duty.begin(), duty.end(), command.duty_ratio);
    robot.set_up = stream.chunks.empty();
    if (!format.encode_command(command, robot, chunk.bytes)) {
      fault = fmt::format("{} refuses the duties at {:.3f} s", format.id, time_s);
    }
    stream.chunks.push_back(std::move(chunk));
  };
  double next_s = 0.0;
  for (std::size_t k = 0; k < run.time_s.size() && fault.empty(); ++k) {
    if (run.time_s[k] < next_s - 1e-9) continue;
    frames(run.time_s[k], {run.duty[0][k], run.duty[1][k], run.duty[2][k], run.duty[3][k]});
    next_s += 1.0 / rate_Hz;
  }
  if (!fault.empty()) return "";
  frames(run.time_s.back() + 1.0 / rate_Hz, {0.0, 0.0, 0.0, 0.0});
  return to_text(stream, fmt::format("{}: {}; {} packets a second to robot {}", format.id, run.words, rate_Hz,
                                     robot.robot_id));
}

std::string plan_text(const ExperimentPlan& plan) {
  if (!plan.run) return plan.problem + "\n";
  std::string text = plan.next.what + "\n";
  const bool has_current = plan.largest_current_A > 0.0;  // not of a bench that is asked for a motion
  text += fmt::format("Simulated: at most {}{:.4g} at the rotor, {:.3g} from the start.\n",
                      has_current ? fmt::format("{:.3g} A, ", plan.largest_current_A) : "",
                      plan.largest_speed_rad_s, plan.largest_travel);
  constexpr std::size_t kShown = 8;
  text += "Tried, best first (in one direction, refitted to first order):\n";
  std::size_t shown = 0, refused = 0;
  for (const TriedRun& t : plan.tried) {
    if (!t.refused.empty()) {
      ++refused;
    } else if (shown++ < kShown) {
      text += fmt::format("  {:>9.3g}  {} ({})\n", t.sigmas, t.excitation, t.words);
    }
  }
  if (refused > 0) {
    text += fmt::format("Refused by the limits: {} of {}\n", refused, plan.tried.size());
    for (const TriedRun& t : plan.tried) {
      if (!t.refused.empty()) text += fmt::format("  {} ({}): {}\n", t.excitation, t.words, t.refused);
    }
  }
  return text;
}

}  // namespace omnihil
