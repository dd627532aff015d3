#include "hil/acquire/acquire_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hil/text/toml_keys.h"

namespace omnihil {
namespace {

constexpr std::string_view kFormat = "omnihil-plan/1";
constexpr std::array<std::string_view, 6> kDrives{"body_velocity", "wheel_speed",  "wheel_duty",
                                                  "motor_voltage", "motor_torque", "duty"};
constexpr std::array<std::string_view, kSplits> kUses{"fit", "holdout", "extrapolation"};
constexpr double kLongest_s = 3600.0;

class Reader {
 public:
  Reader(const ModelDocument& document, std::vector<ModelProblem>& problems)
      : document_(document), problems_(problems), keys_(document, problems) {}

  AcquirePlan read() {
    const toml::table& top = document_.table;
    static constexpr std::string_view kTop[] = {"format", "title",  "drive", "packets_Hz",
                                                "rest_s", "limits", "run"};
    keys_.only(top, "", kTop);
    const std::optional<std::string> format = keys_.text(top, "", "format");
    if (!format || *format != kFormat) keys_.missing(top, "", "format", fmt::format("\"{}\"", kFormat));
    plan_.title = keys_.text(top, "", "title").value_or("");
    if (const auto drive = keys_.word(top, "", "drive", kDrives, std::nullopt))
      plan_.drive = static_cast<PlanDrive>(*drive);
    take(top, "", "packets_Hz", 1.0, 1000.0, plan_.packets_Hz);
    take(top, "", "rest_s", 0.1, 60.0, plan_.rest_s);
    if (const toml::table* limits = top["limits"].as_table()) read_limits(*limits);
    const toml::array* runs = top["run"].as_array();
    if (runs == nullptr || runs->empty()) keys_.missing(top, "", "run", "one [[run]] or more");
    for (std::size_t k = 0; runs != nullptr && k < runs->size(); ++k) {
      if (const toml::table* one = runs->get(k)->as_table()) read_run(*one, fmt::format("run[{}]", k));
    }
    return std::move(plan_);
  }

 private:
  void take(const toml::table& table, const std::string& path, std::string_view key, double low, double high,
            double& into) {
    const std::string allowed = fmt::format("a number from {:g} to {:g}", low, high);
    if (const auto number = keys_.number(table, path, key, low, high, false, allowed)) into = *number;
  }

  void read_limits(const toml::table& t) {
    static constexpr std::string_view kOfRobot[] = {"area_m",    "travel_m",  "speed_m_s",
                                                    "battery_V", "current_A", "silence_s"};
    static constexpr std::string_view kOfAxis[] = {"speed_rad_s", "travel_rad", "battery_V", "current_A",
                                                   "silence_s"};
    if (of_axis(plan_.drive)) {
      keys_.only(t, "limits", kOfAxis);
    } else {
      keys_.only(t, "limits", kOfRobot);
    }
    PlanLimits& l = plan_.limits;
    take(t, "limits", "travel_m", 0.0, 100.0, l.travel_m);
    take(t, "limits", "speed_m_s", 0.0, 20.0, l.speed_m_s);
    take(t, "limits", "speed_rad_s", 0.0, 1e5, l.speed_rad_s);
    take(t, "limits", "travel_rad", 0.0, 1e6, l.travel_rad);
    take(t, "limits", "battery_V", 0.0, 100.0, l.battery_V);
    take(t, "limits", "current_A", 0.0, 1000.0, l.current_A);
    take(t, "limits", "silence_s", 0.02, 10.0, l.silence_s);
    const toml::node* area = t.get("area_m");
    if (area == nullptr) return;
    const std::optional<std::vector<double>> four = numbers(*area, 4);
    if (!four || (*four)[0] >= (*four)[2] || (*four)[1] >= (*four)[3]) {
      keys_.wrong(*area, "limits.area_m", "is no area", "[x from, y from, x to, y to] in m");
      return;
    }
    l.area_m.emplace();
    std::copy(four->begin(), four->end(), l.area_m->begin());
  }

  static std::optional<std::vector<double>> numbers(const toml::node& node, std::size_t count) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != count) return std::nullopt;
    std::vector<double> out;
    for (const toml::node& one : *array) {
      const std::optional<double> number = one.value<double>();
      if (!number || !std::isfinite(*number)) return std::nullopt;
      out.push_back(*number);
    }
    return out;
  }

  void read_run(const toml::table& t, const std::string& path) {
    static constexpr std::string_view kKeys[] = {"name", "use", "excitation", "duration_s", "steps"};
    keys_.only(t, path, kKeys);
    PlanRun run;
    run.name = keys_.text(t, path, "name").value_or("");
    const bool plain = !run.name.empty() && std::all_of(run.name.begin(), run.name.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    });
    if (!plain || !names_.insert(run.name).second)
      keys_.missing(t, path, "name", "letters, digits, _ and -, of each run another");
    if (const auto use = keys_.word(t, path, "use", kUses, std::nullopt)) run.use = static_cast<Split>(*use);
    run.excitation = keys_.text(t, path, "excitation").value_or("");
    take(t, path, "duration_s", 0.1, kLongest_s, run.duration_s);
    if (run.duration_s <= 0.0) keys_.missing(t, path, "duration_s", "seconds, from 0.1 on");
    read_steps(t, path, run);
    plan_.runs.push_back(std::move(run));
  }

  void read_steps(const toml::table& t, const std::string& path, PlanRun& run) {
    const toml::node* node = t.get("steps");
    const toml::array* steps = node != nullptr ? node->as_array() : nullptr;
    const auto size = static_cast<std::size_t>(plan_drive_size(plan_.drive));
    const std::string allowed =
        fmt::format("rows of a time in s, from 0 on and rising, and {} numbers", size);
    if (steps == nullptr || steps->empty()) return keys_.missing(t, path, "steps", allowed);
    for (const toml::node& row : *steps) {
      const std::optional<std::vector<double>> all = numbers(row, size + 1);
      const double before_s = run.steps.empty() ? -1.0 : run.steps.back().at_s;
      const bool first_at_0 = !run.steps.empty() || (all && (*all)[0] == 0.0);
      if (!all || !first_at_0 || (*all)[0] <= before_s)
        return keys_.wrong(row, path + ".steps", "is no step", allowed);
      PlanStep step{.at_s = (*all)[0], .value = {}};
      std::copy(all->begin() + 1, all->end(), step.value.begin());
      run.steps.push_back(step);
    }
  }

  const ModelDocument& document_;
  std::vector<ModelProblem>& problems_;
  TomlKeys keys_;
  AcquirePlan plan_;
  std::set<std::string> names_;
};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

}  // namespace

std::string_view plan_drive_word(PlanDrive drive) { return kDrives[static_cast<std::size_t>(drive)]; }
int plan_drive_size(PlanDrive drive) {
  return drive == PlanDrive::kBodyVelocity ? 3 : of_axis(drive) ? 1 : kWheels;
}
std::uint32_t plan_drive_mode(PlanDrive drive) {
  return drive == PlanDrive::kBodyVelocity ? OMNIHIL_MODE_BODY_VELOCITY
         : drive == PlanDrive::kWheelSpeed ? OMNIHIL_MODE_WHEEL_SPEED
                                           : OMNIHIL_MODE_WHEEL_DUTY;
}

PlanReading read_acquire_plan(std::string_view text, const std::string& shown_name) {
  PlanReading reading;
  const std::optional<ModelDocument> document = parse_document(text, shown_name, reading.problems);
  if (!document) return reading;
  AcquirePlan plan = Reader(*document, reading.problems).read();
  if (reading.problems.empty()) reading.plan = std::move(plan);
  return reading;
}

std::string plan_text(const AcquirePlan& plan) {
  constexpr const char* kSteps[] = {"m/s forward, m/s left, rad/s",
                                    "rad/s of wheels 1 to 4",
                                    "duty of wheels 1 to 4",
                                    "V",
                                    "N m",
                                    "-1 to 1"};
  std::string out = fmt::format(
      "format = \"{}\"\ntitle = {}\ndrive = \"{}\"   # steps: [s, {}]\npackets_Hz = {:g}\nrest_s = {:g}\n",
      kFormat, quoted(plan.title), plan_drive_word(plan.drive), kSteps[static_cast<std::size_t>(plan.drive)],
      plan.packets_Hz, plan.rest_s);
  const PlanLimits& l = plan.limits;
  out += fmt::format("\n[limits]   # the {} is stopped where one is passed\n",
                     of_axis(plan.drive) ? "axis" : "robot");
  if (l.area_m)
    out += fmt::format("area_m = [{:g}, {:g}, {:g}, {:g}]\n", (*l.area_m)[0], (*l.area_m)[1], (*l.area_m)[2],
                       (*l.area_m)[3]);
  const std::pair<const char*, double> watched[] = {
      {"travel_m", l.travel_m},     {"speed_m_s", l.speed_m_s}, {"speed_rad_s", l.speed_rad_s},
      {"travel_rad", l.travel_rad}, {"battery_V", l.battery_V}, {"current_A", l.current_A}};
  for (const auto& [key, value] : watched) {
    if (value > 0.0) out += fmt::format("{} = {:g}\n", key, value);
  }
  out += fmt::format("silence_s = {:g}\n", l.silence_s);
  for (const PlanRun& run : plan.runs) {
    out += fmt::format("\n[[run]]\nname = {}\nuse = \"{}\"\n", quoted(run.name), split_name(run.use));
    if (!run.excitation.empty()) out += fmt::format("excitation = {}\n", quoted(run.excitation));
    out += fmt::format("duration_s = {:g}\nsteps = [\n", run.duration_s);
    for (const PlanStep& step : run.steps) {
      out += fmt::format("  [{:.6g}", step.at_s);
      for (int a = 0; a < plan_drive_size(plan.drive); ++a)
        out += fmt::format(", {:.5g}", step.value[static_cast<std::size_t>(a)]);
      out += "],\n";
    }
    out += "]\n";
  }
  return out;
}

std::array<double, kWheels> plan_value(const PlanRun& run, double time_s) {
  if (time_s < 0.0 || time_s >= run.duration_s) return {};
  const auto after = std::upper_bound(run.steps.begin(), run.steps.end(), time_s + 1e-9,
                                      [](double t, const PlanStep& step) { return t < step.at_s; });
  return after == run.steps.begin() ? std::array<double, kWheels>{} : std::prev(after)->value;
}

RobotCommand plan_command(PlanDrive drive, const std::array<double, kWheels>& value) {
  RobotCommand command{};
  command.mode = plan_drive_mode(drive);
  if (drive == PlanDrive::kBodyVelocity) {
    command.v_forward_m_s = value[0], command.v_left_m_s = value[1], command.omega_body_rad_s = value[2];
  } else {
    auto& into = drive == PlanDrive::kWheelSpeed ? command.omega_wheel_rad_s : command.duty_ratio;
    std::copy(value.begin(), value.end(), std::begin(into));
  }
  return command;
}

}  // namespace omnihil
