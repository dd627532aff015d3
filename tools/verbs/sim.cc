// omnihil sim MODEL --excite NAME|FILE … --out DATASET: a virtual bench for one drive or a whole robot.
#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "hil/loop/model_store.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "sim/model/model_document.h"
#include "tools/benches/virtual_bench.h"
#include "tools/command_line.h"
#include "tools/exit_codes.h"
#include "tools/guarded.h"
#include "tools/verbs/verbs.h"

namespace omnihil {
namespace {

struct Arguments {
  BenchOptions bench;
  std::string rig;  // empty: what the model is
  std::string out;
};

// A robot's model file is the whole robot unless a part of it is asked for.
std::string rig_of(const Arguments& arguments) {
  if (!arguments.rig.empty()) return arguments.rig;
  const StoredModel stored = load_model(arguments.bench.model, {data_folder("models")});
  std::vector<ModelProblem> said_later;
  const auto document = parse_document(stored.bundle.robot_text, stored.bundle.robot_file, said_later);
  if (!document || document->table["rig"].value_or(std::string()) != "robot") return "axis";
  std::printf("%s is a robot: all of it is driven, on the floor (--rig axis: one of its wheels, lifted)\n",
              arguments.bench.model.c_str());
  return "robot";
}

using MakeBench = std::function<std::optional<VirtualBench>(const BenchOptions&, std::vector<std::string>&)>;

// Axis and robot have virtual benches of their own, on the simulators that they have. Empty: there is none.
MakeBench bench_of(const Rig& rig) {
  if (rig.bench != nullptr)
    return [&rig](const BenchOptions& o, std::vector<std::string>& faults) {
      return make_rig_bench(rig, o, faults);
    };
  if (&rig == &rig_axis()) return make_axis_bench;
  if (&rig == &rig_robot()) return make_robot_bench;
  return {};
}

int run(const Arguments& arguments) {
  const std::string rig = rig_of(arguments);
  std::vector<std::string> faults;
  const std::optional<VirtualBench> bench = bench_of(*find_rig(rig))(arguments.bench, faults);
  for (const std::string& fault : faults) std::fprintf(stderr, "omnihil sim: %s\n", fault.c_str());
  if (!bench) return kExitBadInput;
  if (!bench->diverged.empty()) {
    std::fprintf(stderr, "omnihil sim: %s\n", bench->diverged.c_str());
    return kExitDiverged;
  }
  NewFolder folder(arguments.out);
  for (const DatasetFile& file : bench->files) folder.write(file.name, file.text);
  folder.finish();
  std::printf("%s: %zu runs, %zu rows\n", arguments.out.c_str(), bench->runs, bench->rows);
  return kExitOk;
}

}  // namespace

void add_verb_sim(Verb& program, VerbResult& result) {
  auto a = std::make_shared<Arguments>();
  Verb verb = program.add_subcommand("sim", "a virtual bench: drive a model, write a dataset");
  verb.add_option("MODEL", a->bench.model, "model of an axis, a motor or a robot, by name or path")
      .required();
  verb.add_option(
          "--excite", a->bench.excitations,
          "steps, ramp, chirp, prbs, creep, or a CSV file of time and command; several give several runs")
      .required();
  std::vector<std::string> rigs;
  std::string said;
  for (const Rig* rig : all_rigs()) {
    if (!bench_of(*rig)) continue;
    rigs.emplace_back(rig->name);
    said += fmt::format("{}: {}; ", rig->name, rig->what);
  }
  verb.add_option("--rig", a->rig, said + "without it: what the model is").one_of(rigs);
  verb.add_option("--out", a->out, "new folder of the dataset").required();
  verb.add_option("--with", a->bench.with,
                  "add an effect: ID.parameter=value, or ID for its typical size; several allowed");
  verb.add_option("--drive", a->bench.drive,
                  "what is asked: duty, motor_voltage, motor_current, motor_torque, position_target");
  verb.add_option("--amplitude", a->bench.amplitude, "of what is asked, in its unit").capture_default_str();
  verb.add_option("--duration", a->bench.duration_s, "of a run, s").capture_default_str();
  verb.add_option("--rate", a->bench.rate_Hz, "samples per second").capture_default_str();
  verb.add_option("--step", a->bench.step_s, "electrical sub-step, s").capture_default_str();
  verb.add_option("--seed", a->bench.seed, "of noise and of the excitations' pattern").capture_default_str();
  verb.add_option("--noise", a->bench.noise_scale, "of the sensors, times the usual; 0: none")
      .capture_default_str();
  verb.callback([a, &result] { result.exit_code = guarded("sim", [&] { return run(*a); }); });
}

}  // namespace omnihil
