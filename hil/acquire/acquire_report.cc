#include "hil/acquire/acquire_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "hil/acquire/floor_need.h"

namespace omnihil {
namespace {

std::string limit_words(const AcquirePlan& plan, bool vision) {
  const PlanLimits& l = plan.limits;
  std::string out = "Stopped where\n";
  const auto add = [&](const std::string& words, bool seen_by_vision) {
    out += fmt::format("  {}{}\n", words, seen_by_vision && !vision ? "   (not watched: no --vision)" : "");
  };
  if (l.area_m)
    add(fmt::format("it would leave x {:g} to {:g} m, y {:g} to {:g} m of the field", (*l.area_m)[0],
                    (*l.area_m)[2], (*l.area_m)[1], (*l.area_m)[3]),
        true);
  if (l.travel_m > 0.0) add(fmt::format("it would come {:g} m away from its start", l.travel_m), true);
  if (l.speed_m_s > 0.0) add(fmt::format("it is faster than {:g} m/s", l.speed_m_s), true);
  if (l.battery_V > 0.0) add(fmt::format("its battery stays under {:g} V", l.battery_V), false);
  if (l.current_A > 0.0) add(fmt::format("a motor takes more than {:g} A", l.current_A), false);
  add(fmt::format("it, or vision, is silent for {:g} s; on Ctrl-C, SIGTERM, and any fault", l.silence_s),
      false);
  return out;
}

}  // namespace

std::string plan_words(const AcquirePlan& plan, const RollingParams<double>& robot, const RadioFormat& format,
                       bool vision) {
  std::string out =
      fmt::format("{}: {}, {:g} packets a second by {}\n", plan.title.empty() ? "plan" : plan.title,
                  plan_drive_word(plan.drive), plan.packets_Hz, format.id);
  out += "run             use              s   packets   fastest m/s   floor, from its start (x ahead)\n";
  double total_s = 0.0, most_m = 0.0;
  FloorNeed all;
  for (const PlanRun& run : plan.runs) {
    const FloorNeed n = floor_need(plan, run, robot);
    out += fmt::format(
        "{:<15} {:<14} {:>5.1f} {:>8}  {:>10.2f}      x {:.2f} to {:.2f}, y {:.2f} to {:.2f} m; ends at "
        "({:.2f}, {:.2f})\n",
        run.name, split_name(run.use), run.duration_s,
        static_cast<long>(std::ceil(run.duration_s * plan.packets_Hz)), n.fastest_m_s, n.x_from_m, n.x_to_m,
        n.y_from_m, n.y_to_m, n.x_end_m, n.y_end_m);
    total_s += run.duration_s + plan.rest_s;
    most_m = std::max(most_m, n.stopping_m);
    all.x_from_m = std::min(all.x_from_m, n.x_from_m), all.x_to_m = std::max(all.x_to_m, n.x_to_m);
    all.y_from_m = std::min(all.y_from_m, n.y_from_m), all.y_to_m = std::max(all.y_to_m, n.y_to_m);
  }
  out += fmt::format(
      "Floor: {:.2f} by {:.2f} m for the runs, each from where it is put, and {:.2f} m all round to stop "
      "from the fastest ({:g} m/s2)."
      "\nDriving: {:.0f} s.\n",
      all.x_to_m - all.x_from_m, all.y_to_m - all.y_from_m, most_m, kBrake_m_s2, total_s);
  out += limit_words(plan, vision);
  std::string measured = tells_wheel_speeds(format) ? "wheel speeds" : "";
  const auto also = [&](const char* what) { measured += (measured.empty() ? "" : ", ") + std::string(what); };
  if (tells_anything(format)) also("what else its telemetry tells (battery, gyro)");
  if (vision) also("pose by vision");
  out += measured.empty()
             ? "Measured: nothing; this format's robots tell nothing, and there is no --vision.\n"
             : "Measured: " + measured + ".\n";
  return out;
}

std::string run_note(const PlanRun& run, const RunEnd& end, const RunRows& rows, const std::string& started) {
  const double s = rows.time_s.empty() ? 0.0 : rows.time_s.back();
  return fmt::format("| {} | {} | {} | {:.2f} s | {} | {} | {} | {} | {:.1f} ms |\n", run.name,
                     split_name(run.use), started, s, end.log.sent.size(), end.log.told.size(),
                     end.log.seen.size(), end.left_out, 1e3 * end.latest_s);
}

std::string readme_text(const AcquireAbout& about, const AcquirePlan& plan,
                        const std::vector<std::string>& notes) {
  std::string out = fmt::format(
      "# {}\n\nDriven and recorded by omnihil {}.\n\n- Source: robot {} ({}), radio {}, through {}\n- "
      "Licence: not "
      "stated\n- plan.toml: sha256 {}\n- model.toml: sha256 {}\n- packets/NAME.txt: all bytes of a run, `>` "
      "to the robot, `<` "
      "from it, times of the whole session\n\n",
      plan.title.empty() ? "Acquired" : plan.title, about.commit, about.robot, about.team, about.format->id,
      about.device, about.plan_sha256, about.model_sha256);
  out +=
      "| run | use | begun (UTC) | long | packets | answers | frames | left out | latest "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& note : notes) out += note;
  out +=
      "\nTimes are when a packet was written and when an answer came; a frame stands at its capture, brought "
      "to this computer's clock by the "
      "quickest frames. Columns: cmd as asked of the robot in its own frame (m/s, rad/s), wheel speeds in "
      "rad/s at the wheel, battery in V, "
      "vision in m and rad.\n";
  return out;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace omnihil
