// omnihil experiment DATASET: the run that best tells rival effects apart, or says most about a number.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hil/dataset/dataset_reader.h"
#include "hil/serve/serve_signals.h"
#include "hil/text/dataset_files.h"
#include "identify/estimate/fit_note.h"
#include "identify/record/rig.h"
#include "identify/select/angle_resolution.h"
#include "identify/select/refit.h"
#include "sim/law/effect_registry.h"
#include "sim/model/params.h"
#include "tools/benches/virtual_bench.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/experiment_files.h"
#include "tools/guarded.h"
#include "tools/options/dataset_options.h"
#include "tools/progress_line.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

constexpr std::string_view kBase = "base";

struct Arguments {
  std::string dataset, model, out, radio, write;
  OtherFirmware firmware;
  bool usual = false;
  BodyDriveOptions body;
  std::vector<std::string> separate;
  ExperimentQuestion question;
  ExperimentOptions options;
  CommandTo robot;
  std::string team = "blue";
  double packets_Hz = 100.0;
  std::string axis_drive;  // of --usual; empty: a robot
  double level = 0.0;

  Arguments() { options.jobs = 2; }
};

// A bench of one's own where there is no measurement: the model, recorded with the usual steps.
std::string simulated_dataset(const Arguments& a, const std::filesystem::path& folder,
                              std::vector<std::string>& faults) {
  BenchOptions bench;
  bench.model = a.model;
  bench.excitations = {"steps"};
  bench.duration_s = 5.0;
  bench.rate_Hz = a.options.rate_Hz;
  bench.seed = a.options.seed;
  NewFolder out(folder);
  std::optional<VirtualBench> made = make_axis_bench(bench, faults);
  if (std::vector<std::string> own; !made) {
    made = make_robot_bench(bench, own);
    if (!made) return "";
    faults.clear();
  }
  for (const DatasetFile& file : made->files) out.write(file.name, file.text);
  out.finish();
  return folder.string();
}

std::vector<std::string> words_of(const std::vector<std::string>& lists) {
  std::vector<std::string> words;
  for (const std::string& list : lists) {
    std::size_t from = 0;
    while (from <= list.size()) {
      const std::size_t comma = std::min(list.find(',', from), list.size());
      if (comma > from) words.push_back(list.substr(from, comma - from));
      from = comma + 1;
    }
  }
  return words;
}

std::vector<std::string> check_names(const std::vector<std::string>& names, const Predictor& predictor,
                                     const Dataset& dataset) {
  std::vector<std::string> faults;
  for (const std::string& name : names) {
    if (name == kBase) continue;
    const EffectEntry* entry = find_effect(name);
    const std::string_view near = entry == nullptr ? nearest_effect(name) : "";
    if (entry == nullptr || is_formula(*entry->info)) {
      faults.push_back(fmt::format("--separate {}: there is no such effect; {}", name,
                                   near.empty() ? "allowed: effects of `omnihil effects`, or \"base\""
                                                : fmt::format("did you mean \"{}\"?", near)));
    } else if (const std::string why = why_not(*entry, predictor, dataset); !why.empty()) {
      faults.push_back(fmt::format("--separate {}: {}", name, why));
    }
  }
  return faults;
}

// The model with an effect, fitted from its typical size and from nothing; without data at its typical size.
Rival rival_of(const std::string& name, const Candidate& nominal, const Predictor* predictor, int jobs) {
  Candidate plain = nominal;
  const bool has = std::any_of(nominal.effects.begin(), nominal.effects.end(),
                               [&](const EffectUse& u) { return effect_name(u) == name; });
  if (name != kBase && !has) plain = with_effect(nominal, *find_effect(name));
  Candidate typical = plain;
  const DriveParams<double> drive = drive_of(nominal);
  if (name != kBase && !has)
    typical.effects.back() = typical_use(*find_effect(name), &drive, wheels_of(nominal));
  if (predictor == nullptr) return {name, typical};
  std::optional<FitResult> best;
  for (const Candidate& start : {plain, typical}) {
    FitResult r =
        fit(*predictor, start, unknowns_with_priors(start, nominal), {.jobs = jobs, .coarse = true});
    if (!best || r.cost < best->cost) best = std::move(r);
    if (name == kBase) break;
  }
  return {name, with_fit_noted(*best, {})};  // the priors stay the nominal model's
}

void write_plan(const Arguments& a, const ExperimentPlan& plan, const RadioFormat* format,
                std::string& text) {
  NewFolder folder(a.out);
  folder.write("run.csv", planned_csv(*plan.run));
  if (format != nullptr) {
    std::string fault;
    const std::string stream = planned_stream(*plan.run, *format, a.robot, a.packets_Hz, fault);
    if (!fault.empty()) throw std::invalid_argument("--radio: " + fault);
    folder.write("stream.txt", stream);
    text += fmt::format(
        "Packets: {}/stream.txt, for `omnihil play`; {:g} a second hold what run.csv asks {:g} times a "
        "second.\n",
        a.out, a.packets_Hz, a.options.rate_Hz);
  }
  folder.write("plan.txt", text);
  folder.finish();
}

// The plan for `omnihil acquire`, whole or not at all.
void write_acquire_plan(const std::string& path, const AcquirePlan& plan) {
  write_new_file(path, plan_text(plan));
  fmt::print("{}: {} runs for `omnihil acquire`; --dry-run says what they take\n", path, plan.runs.size());
}

int run_usual(const Arguments& a) {
  if (a.write.empty()) throw std::invalid_argument("--usual: needs --write PLAN");
  if (!a.axis_drive.empty() && !(a.level > 0.0))
    throw std::invalid_argument("--drive: needs --level, the most that is asked for (V, N m, duty)");
  for (const PlanDrive drive : {PlanDrive::kMotorVoltage, PlanDrive::kMotorTorque, PlanDrive::kDuty}) {
    if (a.axis_drive != plan_drive_word(drive)) continue;
    write_acquire_plan(a.write,
                       usual_axis_plan(drive, a.level, a.options.limits, a.packets_Hz, a.options.seed));
    return kExitOk;
  }
  write_acquire_plan(a.write, usual_plan(a.body, a.packets_Hz));
  return kExitOk;
}

int run(Arguments a) {
  // Half a metre of the travel is for stopping and drift.
  if (a.options.limits.travel > 0.0) a.body.room_m = std::max(0.2, a.options.limits.travel - 0.5);
  a.body.duration_s = a.options.limits.duration_s;
  a.body.seed = a.options.seed;
  if (a.usual) return run_usual(a);
  std::vector<std::string> faults;
  const std::vector<std::string> names = words_of(a.separate);
  if (a.dataset.empty() && a.model.empty())
    faults.push_back("give a DATASET, or --model for a bench of its own");
  if (names.size() < 2 && a.question.shrink.empty())
    faults.push_back("--separate A,B: two effects (or \"base\") to tell apart, or --shrink PATH");
  const RadioFormat* format = a.radio.empty() ? nullptr : find_radio_format(a.radio);
  if (!a.radio.empty() && (format == nullptr || format->command_drives == 0)) {
    faults.push_back(fmt::format("--radio {}: {}", a.radio,
                                 format == nullptr ? "there is no such format; `omnihil formats` lists them"
                                                   : "has no packet that drives a robot so"));
  }
  std::string where = a.dataset;
  const std::filesystem::path own =
      std::filesystem::temp_directory_path() / fmt::format("omnihil-experiment-{}", ::getpid());
  if (faults.empty() && where.empty()) where = simulated_dataset(a, own, faults);
  DatasetReading reading;
  if (faults.empty()) reading = read_dataset(where, a.dataset.empty() ? "" : a.model, a.firmware);
  std::filesystem::remove_all(own);
  for (const ModelProblem& p : reading.problems) faults.push_back(p.text());
  std::unique_ptr<Predictor> predictor;
  if (reading.dataset) {
    predictor = make_predictor(*reading.dataset, *reading.nominal, {});
    for (std::string& fault : check_names(names, *predictor, *reading.dataset))
      faults.push_back(std::move(fault));
    if (format != nullptr && !reading.dataset->rig->whole_robot) {
      faults.push_back("--radio: this is a single axis; only a robot has a radio to send packets to");
    }
  }
  for (const std::string& fault : faults) std::fprintf(stderr, "omnihil experiment: %s\n", fault.c_str());
  if (!faults.empty() || !reading.dataset) return kExitBadInput;
  StopSignals stop;
  ExperimentPlan plan;
  {
    ProgressLine line;
    const Predictor* data = a.dataset.empty() ? nullptr : predictor.get();
    std::vector<Rival> rivals;
    for (const std::string& name : names.empty() ? std::vector<std::string>{std::string(kBase)} : names) {
      line.show("fitting " + name, 0.0);
      rivals.push_back(rival_of(name, *reading.nominal, data, a.options.jobs));
    }
    a.options.progress = [&](const Progress& p) {
      line.show(p.doing, p.share);
      return !StopSignals::requested();
    };
    plan = plan_experiment(*reading.dataset, rivals, a.question, a.options);
  }
  std::string text = plan_text(plan);
  if (plan.run && !a.out.empty()) write_plan(a, plan, format, text);
  std::fputs(text.c_str(), plan.run ? stdout : stderr);
  if (plan.run && !a.write.empty()) {
    const auto acquire =
        acquire_plan_of(plan, a.options.limits, a.packets_Hz, a.body, drive_of(*reading.nominal).gear_ratio);
    if (!acquire || reading.dataset->linear)
      throw std::invalid_argument(
          "--write: a plan for `acquire` is of a robot, or of an axis by duty, voltage or torque; --out has "
          "this "
          "run");
    write_acquire_plan(a.write, *acquire);
  }
  if (StopSignals::requested()) return kExitInterrupted;
  return plan.run ? kExitOk : kExitBadInput;
}

}  // namespace

void add_verb_experiment(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("experiment",
                                     "the run to record next: tells effects apart, or shrinks a number");
  verb.add_option("DATASET", a->dataset, "folder of a measurement, or its dataset.toml");
  verb.add_option("--model", a->model,
                  "model in place of the dataset's own; without a DATASET: a simulated bench");
  add_dataset_firmware_options(verb, a->firmware);
  verb.add_option("--separate", a->separate, "effects to tell apart, or \"base\" for none: A,B");
  verb.add_option("--shrink", a->question.shrink, "number to know better: its path in the model")
      .type_name("PATH");
  ExperimentLimits& limits = a->options.limits;
  verb.add_option("--max-voltage", limits.voltage_V, "at the motor, V").positive();
  verb.add_option("--max-current", limits.current_A, "of a motor, A").positive();
  verb.add_option("--max-speed", limits.speed_rad_s, "of the rotor, rad/s (linear axis: m/s)").positive();
  verb.add_option("--max-travel", limits.travel, "from the start, rad at the output (linear axis, robot: m)")
      .positive();
  verb.add_option("--duration", limits.duration_s, "of the run, s").range(1.0, 600.0).capture_default_str();
  verb.add_option("--rate", a->options.rate_Hz, "samples per second")
      .range(10.0, 10000.0)
      .capture_default_str();
  verb.add_option("--out", a->out, "new folder: run.csv, plan.txt, stream.txt");
  verb.add_option("--radio", a->radio, "write the run as packets of this format too (robots)");
  verb.add_option("--robot", a->robot.robot_id, "that the packets are for")
      .range(0, 15)
      .capture_default_str();
  verb.add_option("--team", a->team, "of the robot").one_of({"blue", "yellow"}).capture_default_str();
  verb.add_option("--packets", a->packets_Hz, "radio packets per second")
      .range(1.0, 1000.0)
      .capture_default_str();
  verb.add_option("--write", a->write, "new plan file for `omnihil acquire`");
  verb.add_flag("--usual", a->usual,
                "no question: random drives by commanded velocity for a first measurement; needs --write");
  verb.add_option("--velocity", a->body.speed_m_s, "of --usual, m/s").positive().capture_default_str();
  verb.add_option("--drive", a->axis_drive,
                  "of --usual: one axis, asked for this; --max-speed is then at its output")
      .one_of({"motor_voltage", "motor_torque", "duty"});
  verb.add_option("--level", a->level, "of --drive: the most that is asked, V, N m or duty").positive();
  verb.add_option("--turn", a->body.turn_rad_s, "of --usual, rad/s").positive().capture_default_str();
  verb.add_option("--seed", a->options.seed, "of the random excitations").capture_default_str();
  verb.add_option("--jobs", a->options.jobs, "threads; the result does not depend on it")
      .range(1, 256)
      .capture_default_str();
  verb.footer(
      "Every excitation is simulated; one that would break a limit is refused and listed. The expected "
      "separation\n"
      "is in sigmas of the noise, with one model refitted to the other.");
  verb.callback([a, &result] {
    a->robot.team = a->team == "blue" ? Team::kBlue : Team::kYellow;
    result.exit_code = guarded("experiment", [&] { return run(*a); });
  });
}

}  // namespace omnihil
