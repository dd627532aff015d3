#include "sim/model/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <tuple>

#include "sim/model/model_checks.h"
#include "sim/model/model_effects.h"
#include "sim/model/model_reader.h"
#include "sim/model/model_rows.h"

namespace omnihil {
namespace {

// One file and what was found in it. The document must not move once the reader looks at it.
struct Source {
  ModelDocument document;
  ModelReader reader;

  Source(ModelDocument&& d, std::vector<ModelProblem>& problems)
      : document(std::move(d)), reader(document, problems) {}
};

std::string text_of(const ModelReader& reader, std::string_view section, std::string_view key) {
  const auto at = reader.values().find(find_model_row(section, key));
  return at == reader.values().end() ? "" : at->second.text;
}

std::unique_ptr<Source> open_motor(const ModelDocument& robot, const MotorFileLoader& load_motor,
                                   const Parameter& file, std::vector<ModelProblem>& problems) {
  const toml::node& node = *robot.table.at_path("motor.file").node();
  const auto refuse = [&](std::string what) {
    problems.push_back(
        problem_at(robot, node.source(), "motor.file", robot.written(node), std::move(what), ""));
    return nullptr;
  };
  if (!load_motor) return refuse("this model may not refer to other files");
  const MotorFileText motor = load_motor(file.text);
  if (!motor.error.empty()) return refuse(motor.error);
  auto document = parse_document(motor.text, motor.shown_name, problems);
  if (!document) return nullptr;
  auto source = std::make_unique<Source>(std::move(*document), problems);
  source->reader.read(Origin::kMotorFile);
  if (source->reader.rig() != 0 && source->reader.rig() != kRigMotor) {
    const toml::node& rig = *source->document.table.get("rig");
    problems.push_back(problem_at(source->document, rig.source(), "rig", source->document.written(rig),
                                  fmt::format("{} refers to this as a motor file", robot.file),
                                  "allowed: \"motor\""));
  }
  return source;
}

// Everything read, the robot's file before the motor's.
struct Merged {
  const Source& main;
  const Source* motor = nullptr;
  std::uint32_t rig = 0;

  const Parameter* given(const ParameterRow& row) const {
    const auto at = main.reader.values().find(&row);
    if (at != main.reader.values().end()) return &at->second;
    if (motor == nullptr || row.section.empty()) return nullptr;
    const auto from_motor = motor->reader.values().find(&row);
    return from_motor == motor->reader.values().end() ? nullptr : &from_motor->second;
  }
  bool spoilt(const ParameterRow& row) const {
    return main.reader.spoilt(row) || (motor != nullptr && motor->reader.spoilt(row));
  }
};

void report_missing(const Merged& all, std::vector<ModelProblem>& problems) {
  for (const ParameterRow& row : model_rows()) {
    const bool needed = all.rig == 0 ? row.section.empty() && row.needed != 0 : (row.needed & all.rig) != 0;
    if (!needed || all.given(row) != nullptr || all.spoilt(row)) continue;
    std::string allowed = row.what.empty() ? "" : fmt::format("needed: {}", row.what);
    if (row.kind == ParameterKind::kNumber) allowed += fmt::format(" ({})", allowed_range(row));
    problems.push_back(problem_at(all.main.document, all.main.reader.section_place(row.section),
                                  parameter_path(row), "", "is missing", allowed));
  }
}

ParameterTable table_of(const Merged& all) {
  ParameterTable table;
  for (const ParameterRow& row : model_rows()) {
    const Parameter* given = all.given(row);
    const bool applies = (row.rigs & all.rig) != 0;
    if (given != nullptr) {
      table.parameters.push_back(*given);
    } else if (applies && row.otherwise) {
      table.parameters.push_back({.row = &row, .values = {*row.otherwise}, .origin = Origin::kDefault});
      if (row.kind == ParameterKind::kChoice) {
        table.parameters.back().text = row.choices[static_cast<std::size_t>(*row.otherwise)];
      }
    }
  }
  return table;
}

void report_conflicts(const Merged& all, const ParameterTable& table, std::vector<ModelProblem>& problems) {
  for (ModelConflict& conflict : model_conflicts(table, all.rig)) {
    const Parameter& p = *conflict.at;
    const bool in_motor = p.origin == Origin::kMotorFile && all.motor != nullptr;
    const ModelDocument& document = in_motor ? all.motor->document : all.main.document;
    std::string value = p.values.size() == 1 ? fmt::format("{:g}", p.value()) : "";
    if (p.origin == Origin::kDefault) value += " (default)";
    ModelProblem problem =
        problem_at(document, all.main.reader.section_place(p.row->section), parameter_path(*p.row), value,
                   std::move(conflict.what), std::move(conflict.allowed));
    if (p.line > 0) problem.line = p.line, problem.column = p.column;
    problems.push_back(std::move(problem));
  }
}

// "robots/ours.toml" -> "ours"
std::string stem_of(const std::string& file) {
  const std::string name = file.substr(file.find_last_of('/') + 1);
  return name.substr(0, name.rfind(".toml"));
}

ModelFile model_of(const Merged& all, ParameterTable table) {
  const ModelReader& reader = all.main.reader;
  ModelFile model;
  model.name = text_of(reader, "", "name");
  model.source = text_of(reader, "", "source");
  model.rig = text_of(reader, "", "rig");
  model.linear = all.rig == kRigLinearAxis;
  model.radio = text_of(reader, "firmware", "radio");
  model.motor_file = text_of(reader, "motor", "file");
  const ModelReader& motor = all.motor != nullptr ? all.motor->reader : reader;
  if (all.motor != nullptr || all.rig == kRigMotor) {
    model.motor_name = text_of(motor, "", "name");
    model.motor_source = text_of(motor, "", "source");
  }
  for (const Source* source : {all.motor, &all.main}) {
    if (source == nullptr) continue;
    for (const ModelEffect& effect : source->reader.effects()) {
      const auto same = [&](const ModelEffect& e) { return e.id == effect.id; };
      if (std::none_of(model.effects.begin(), model.effects.end(), same)) model.effects.push_back(effect);
    }
  }
  model.parameters = std::move(table);
  RobotModel robot = robot_model_of(model.parameters);
  robot.name = model.name.empty() ? stem_of(all.main.document.file) : model.name;
  robot.motor.name = model.motor_name;
  model.motor = robot.motor;
  if (all.rig == kRigRobot) model.robot = std::move(robot);
  return model;
}

}  // namespace

ModelFile::ModelFile() = default;
ModelFile::ModelFile(const ModelFile&) = default;
ModelFile::ModelFile(ModelFile&&) noexcept = default;
ModelFile& ModelFile::operator=(const ModelFile&) = default;
ModelFile& ModelFile::operator=(ModelFile&&) noexcept = default;
ModelFile::~ModelFile() = default;

ModelReading read_model(std::string_view text, const std::string& shown_name,
                        const MotorFileLoader& load_motor) {
  ModelReading reading;
  auto document = parse_document(text, shown_name, reading.problems);
  if (!document) return reading;
  Source main(std::move(*document), reading.problems);
  main.reader.read(Origin::kRobotFile);

  std::unique_ptr<Source> motor;
  const auto file = main.reader.values().find(find_model_row("motor", "file"));
  bool motor_readable = true;
  if (file != main.reader.values().end()) {
    motor = open_motor(main.document, load_motor, file->second, reading.problems);
    motor_readable = motor != nullptr;
  }
  const Merged all{.main = main, .motor = motor.get(), .rig = main.reader.rig()};
  if (motor_readable) report_missing(all, reading.problems);

  ParameterTable table = table_of(all);
  if (reading.problems.empty()) report_conflicts(all, table, reading.problems);
  const ModelDocument* motor_document = motor != nullptr ? &motor->document : nullptr;
  if (all.rig == kRigRobot) read_robot_effects(main.document, motor_document, nullptr, reading.problems);
  const auto place = [&](const ModelProblem& a) {
    return std::tuple(a.file != shown_name, a.line, a.column);
  };
  std::stable_sort(reading.problems.begin(), reading.problems.end(),
                   [&](const ModelProblem& a, const ModelProblem& b) { return place(a) < place(b); });
  if (!reading.problems.empty()) return reading;

  reading.model = model_of(all, std::move(table));
  if (reading.model->robot) {
    RobotModel& robot = *reading.model->robot;
    auto uses = read_robot_effects(main.document, motor_document, &robot, reading.problems);
    if (!uses.empty()) robot.effects = std::make_shared<const std::vector<EffectUse>>(std::move(uses));
  }
  for (ModelEffect& effect : reading.model->effects) {
    effect.simulated = effect.simulated || (all.rig == kRigRobot && acts_on_robot(effect.id));
    if (effect.simulated) continue;
    reading.notes.push_back(
        fmt::format("{}: effects.{} is kept but has no influence on the simulation", shown_name, effect.id));
  }
  return reading;
}

}  // namespace omnihil
