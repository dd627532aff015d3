#include "hil/acquire/axis_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/bench/axis_sim.h"
#include "sim/bench/dataset_text.h"

namespace omnihil {
namespace {

const char* unit_of(PlanDrive drive) {
  return drive == PlanDrive::kMotorVoltage ? "V" : drive == PlanDrive::kMotorTorque ? "N m" : "";
}

std::vector<AxisSample<double>> simulated(const AcquirePlan& plan, const PlanRun& run,
                                          const AxisModel& model) {
  constexpr double kStep_s = 1e-3;
  AxisInput in;
  in.kind = plan.drive == PlanDrive::kMotorVoltage  ? CommandKind::kMotorVoltage
            : plan.drive == PlanDrive::kMotorTorque ? CommandKind::kMotorTorque
                                                    : CommandKind::kDuty;
  for (double t = 0.0; t < run.duration_s; t = kStep_s * static_cast<double>(in.time_s.size())) {
    in.time_s.push_back(t);
    in.command.push_back(plan_value(run, t)[0]);
  }
  return run_axis<double>(model.drive, EffectSet<double>(model.effects), in);
}

}  // namespace

std::string axis_dataset_text(const AcquirePlan& plan, const std::vector<AcquiredRun>& runs,
                              double counts_per_turn) {
  std::string text = dataset_head(plan.title.empty() ? "acquired" : plan.title, "axis");
  const auto add = [&](std::string_view signal, const std::string& column, const std::string& more) {
    const bool there = std::any_of(
        runs.begin(), runs.end(), [&](const AcquiredRun& one) { return one.rows.column(column) != nullptr; });
    if (there) text += channel_line(signal, column, 0.0, more);
  };
  const std::string word(plan_drive_word(plan.drive));
  add(word, word, "");
  add("encoder", "encoder", fmt::format(", counts_per_rev = {:.10g}, shaft = \"rotor\"", counts_per_turn));
  add("position", "position", "");
  // A torque is compared with the acceleration. An error of a sample's instant makes a position wrong by the speed times it, a
  // reported speed by the acceleration times it, and is differenced once less.
  if (plan.drive == PlanDrive::kMotorTorque) add("velocity", "velocity", "");
  // The bus acts through the duty alone. A current is a signal as the mean over its period, which a board with the shim tells;
  // what a motor controller tells is of an instant, of another current where a demand has just been changed.
  if (plan.drive == PlanDrive::kDuty) {
    add("motor_current", "current", "");
    add("bus_voltage", "bus", "");
  }
  for (const AcquiredRun& one : runs)
    text += run_lines(one.run->name + ".csv", split_name(one.run->use), one.run->excitation);
  return text;
}

std::string axis_plan_words(const AcquirePlan& plan, const AxisModel& model) {
  std::string out = fmt::format("{}: {}, {:g} demands a second\n", plan.title.empty() ? "plan" : plan.title,
                                plan_drive_word(plan.drive), plan.packets_Hz);
  out +=
      "run             use              s   largest        by the model: rad/s   rad from the start        "
      "A\n";
  double total_s = 0.0;
  for (const PlanRun& run : plan.runs) {
    double largest = 0.0, speed = 0.0, from = 0.0, to = 0.0, current = 0.0;
    for (const PlanStep& step : run.steps) largest = std::max(largest, std::abs(step.value[0]));
    for (const AxisSample<double>& s : simulated(plan, run, model)) {
      speed = std::max(speed, std::abs(s.velocity_rad_s));
      current = std::max(current, std::abs(s.motor_current_A));
      from = std::min(from, s.position_rad), to = std::max(to, s.position_rad);
    }
    out +=
        fmt::format("{:<15} {:<14} {:>5.1f}   {:<20} {:>14.4g}   {:>18} {:>8.3g}\n", run.name,
                    split_name(run.use), run.duration_s, fmt::format("{:g} {}", largest, unit_of(plan.drive)),
                    speed, fmt::format("{:.4g} to {:.4g}", from, to), current);
    total_s += run.duration_s + plan.rest_s;
  }
  const PlanLimits& l = plan.limits;
  out += fmt::format("Driving: {:.0f} s.\nStopped where\n", total_s);
  if (l.speed_rad_s > 0.0) out += fmt::format("  it is faster than {:g} rad/s\n", l.speed_rad_s);
  if (l.travel_rad > 0.0)
    out += fmt::format("  it is more than {:g} rad from where the run began\n", l.travel_rad);
  if (l.current_A > 0.0) out += fmt::format("  it takes more than {:g} A\n", l.current_A);
  if (l.battery_V > 0.0) out += fmt::format("  its supply stays under {:g} V\n", l.battery_V);
  out += fmt::format(
      "  it is silent for {:g} s, or reports a fault; on Ctrl-C, SIGTERM, and any fault here\n", l.silence_s);
  return out + "To stop is to let the bridge go: the axis runs out against its friction.\n";
}

std::string axis_run_note(const PlanRun& run, const AxisRunEnd& done, const RunRows& rows,
                          const std::string& started) {
  const double s = rows.time_s.empty() ? 0.0 : rows.time_s.back();
  return fmt::format("| {} | {} | {} | {:.2f} s | {} | {} | {} | {:.1f} ms |\n", run.name,
                     split_name(run.use), started, s, done.asked, rows.time_s.size(), done.left_out,
                     1e3 * done.latest_s);
}

std::string axis_readme_text(const AxisAbout& about, const AcquirePlan& plan,
                             const std::vector<std::string>& notes) {
  std::string out = fmt::format(
      "# {}\n\nDriven and recorded by omnihil {}.\n\n- Source: one axis, {} {}, through {}\n- Licence: not "
      "stated\n"
      "- plan.toml: sha256 {}\n- model.toml: sha256 {}\n- packets/NAME.txt: all that passed on the wire in a "
      "run\n\n",
      plan.title.empty() ? "Acquired" : plan.title, about.commit, about.bus, about.id, about.device,
      about.plan_sha256, about.model_sha256);
  out +=
      "| run | use | begun (UTC) | long | demands | samples | left out | latest "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const std::string& note : notes) out += note;
  out += about.device_clock
             ? "\nTimes are of the board's own clock; the duty is the one that the board said was in force.\n"
             : "\nA sample stands in the middle between question and answer; what was asked with the "
               "question holds from it "
               "on.\n";
  return out +
         "Columns: what was asked (V, N m at the rotor, duty), position and velocity of the output in rad "
         "and rad/s, or "
         "the rotor's encoder in counts, current of the motor in A, bus in V. Duty and voltage hold from "
         "their row on; a torque is of its "
         "row's instant, where it was changed the mean of before and after.\n";
}

}  // namespace omnihil
