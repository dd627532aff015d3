// read_candidate: a model file as the thing a comparison, fit or diagnosis works on.
#include <filesystem>

#include "hil/dataset/dataset_reader.h"
#include "hil/text/text_file.h"
#include "sim/model/axis_model.h"
#include "sim/model/model_document.h"

namespace omnihil {
namespace {

// Motor files stand relative to the model that names them.
MotorFileLoader motor_loader(const std::string& model_path) {
  return [folder = std::filesystem::path(model_path).parent_path()](const std::string& file) {
    const std::string path = (folder / file).lexically_normal().string();
    MotorFileText motor{.shown_name = path, .text = "", .error = ""};
    motor.text = read_text_file(path, motor.error);
    if (!motor.error.empty()) motor.error = path + ": " + motor.error;
    return motor;
  };
}

bool says_robot(const std::string& text, const std::string& path) {
  std::vector<ModelProblem> ignored;  // the model's reader says them
  const auto document = parse_document(text, path, ignored);
  return document && document->table["rig"].value_or(std::string()) == "robot";
}

}  // namespace

CandidateReading read_candidate(const std::string& model_path) {
  CandidateReading out;
  std::string error;
  out.text = read_text_file(model_path, error);
  if (!error.empty()) {
    ModelProblem problem;
    problem.file = model_path;
    problem.what = error;
    out.problems.push_back(std::move(problem));
    return out;
  }
  if (says_robot(out.text, model_path)) {
    ModelReading reading = read_model(out.text, model_path, motor_loader(model_path));
    out.problems = std::move(reading.problems);
    if (reading.model) out.candidate = candidate_of(*reading.model);
    return out;
  }
  AxisReading reading = read_axis_model(out.text, model_path, motor_loader(model_path));
  out.problems = std::move(reading.problems);
  if (reading.model)
    out.candidate = candidate_of(std::move(reading.model->file), std::move(reading.model->effects));
  return out;
}

}  // namespace omnihil
