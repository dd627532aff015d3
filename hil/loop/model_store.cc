#include "hil/loop/model_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

bool is_path(const std::string& path_or_name) {
  return path_or_name.find('/') != std::string::npos || path_or_name.ends_with(".toml");
}

// Path of a model by name, or empty.
fs::path find_named(const std::string& name, const std::vector<std::string>& folders) {
  for (const fs::path folder : model_folders(folders)) {
    for (const char* sub : {"robots", "motors", "."}) {
      const fs::path path = (folder / sub / (name + ".toml")).lexically_normal();
      std::error_code code;
      if (fs::is_regular_file(path, code)) return path;
    }
  }
  return {};
}

ModelProblem unknown_name(const std::string& name, const std::vector<std::string>& folders) {
  const std::vector<ModelListing> known = list_models(folders);
  std::vector<std::string_view> names;
  for (const ModelListing& model : known) names.push_back(model.name);
  const std::string_view near = nearest_spelling(name, names);
  ModelProblem problem;
  problem.file = name;
  problem.what = "there is no model of this name";
  problem.allowed = near.empty() ? "`omnihil models` lists them; a path must have a / or end in .toml"
                                 : fmt::format("did you mean \"{}\"?", near);
  return problem;
}

MotorFileLoader motor_of(const ModelBundle& bundle) {
  return [&bundle](const std::string& file) {
    MotorFileText motor{.shown_name = file, .text = bundle.motor_text, .error = ""};
    if (file != bundle.motor_file) motor.error = fmt::format("{}: not in the bundle", file);
    return motor;
  };
}

}  // namespace

std::vector<std::string> model_folders(const std::vector<std::string>& folders) {
  std::vector<std::string> all;
  if (const char* named = std::getenv("OMNIHIL_MODELS")) {
    std::istringstream parts(named);
    for (std::string part; std::getline(parts, part, ':');) {
      if (!part.empty()) all.push_back(part);
    }
  }
  all.insert(all.end(), folders.begin(), folders.end());
  return all;
}

StoredModel load_model(const std::string& path_or_name, const std::vector<std::string>& folders) {
  StoredModel out;
  const fs::path path = is_path(path_or_name) ? fs::path(path_or_name) : find_named(path_or_name, folders);
  if (path.empty()) {
    out.problems.push_back(unknown_name(path_or_name, folders));
    return out;
  }
  out.bundle.name = path.stem().string();
  out.bundle.robot_file = path.string();
  std::string error;
  out.bundle.robot_text = read_text_file(path, error);
  if (!error.empty()) {
    ModelProblem problem;
    problem.file = path.string();
    problem.what = error;
    out.problems.push_back(problem);
    return out;
  }
  const auto load_motor = [&](const std::string& file) {
    const fs::path motor_path = (path.parent_path() / file).lexically_normal();
    MotorFileText motor{.shown_name = motor_path.string(), .text = "", .error = ""};
    motor.text = read_text_file(motor_path, motor.error);
    if (!motor.error.empty()) motor.error = fmt::format("{}: {}", motor_path.string(), motor.error);
    out.bundle.motor_file = file;
    out.bundle.motor_text = motor.text;
    return motor;
  };
  ModelReading reading = read_model(out.bundle.robot_text, path.string(), load_motor);
  out.model = std::move(reading.model);
  out.problems = std::move(reading.problems);
  out.notes = std::move(reading.notes);
  return out;
}

StoredModel load_robot_model(const std::string& path_or_name, const std::vector<std::string>& folders) {
  StoredModel out = load_model(path_or_name, folders);
  if (out.model && !out.model->robot) {
    ModelProblem problem;
    problem.file = out.bundle.robot_file;
    problem.key = "rig";
    problem.value = fmt::format("\"{}\"", out.model->rig);
    problem.what = "a robot is needed here";
    problem.allowed = "`omnihil models` lists the robots";
    out.problems.push_back(problem);
    out.model.reset();
  }
  return out;
}

ModelReading read_bundle(const ModelBundle& bundle) {
  return read_model(bundle.robot_text, bundle.robot_file, motor_of(bundle));
}

AxisReading read_axis_bundle(const ModelBundle& bundle) {
  return read_axis_model(bundle.robot_text, bundle.robot_file, motor_of(bundle));
}

std::vector<ModelListing> list_models(const std::vector<std::string>& folders) {
  std::vector<ModelListing> all;
  for (const char* sub : {"robots", "motors"}) {
    std::vector<ModelListing> found;
    for (const fs::path folder : model_folders(folders)) {
      std::error_code code;
      for (const auto& entry : fs::directory_iterator(folder / sub, code)) {
        if (entry.path().extension() != ".toml") continue;
        const ModelListing model{entry.path().stem().string(), entry.path().lexically_normal().string()};
        const auto same = [&](const ModelListing& m) { return m.name == model.name; };
        if (std::none_of(found.begin(), found.end(), same)) found.push_back(model);
      }
    }
    std::sort(found.begin(), found.end(),
              [](const ModelListing& a, const ModelListing& b) { return a.name < b.name; });
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace omnihil
